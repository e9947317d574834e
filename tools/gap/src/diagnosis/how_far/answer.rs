//! What this says of a diagnosis: sizes fitted anew, shrinks, and the blocks' shares of the gap.

use xt28_sim::effects::Block;

use super::HowFar;
use crate::diagnosis::verdict::{Cause, Diagnosis, Place, ShareOf, Together};

/// Causes without a probability above one half whose shrink is told all the same.
const ALSO_TOLD: usize = 3;

impl HowFar {
    /// Fits the causes that `diagnosis` stands by anew, all together, and fills in how far each and all
    /// of them shrink the gap, and what share of it each place carries. `progress` hears of every step,
    /// from 0 to 1.
    pub fn complete(&self, diagnosis: &mut Diagnosis, progress: &dyn Fn(&'static str, f64)) {
        progress("overriding blocks with what they put out", 0.0);
        self.share_out(&mut diagnosis.places);
        diagnosis.share_of = ShareOf::Machine;
        let stood_by: Vec<usize> = (0..diagnosis.causes.len())
            .filter(|&k| diagnosis.causes[k].probability > 0.5)
            .collect();
        progress("fitting the causes on the whole machine", 0.2);
        if !stood_by.is_empty() {
            let causes: Vec<Cause> =
                stood_by.iter().map(|&k| diagnosis.causes[k].clone()).collect();
            let refit = self.refit(&causes);
            for (&k, estimates) in stood_by.iter().zip(refit.estimates) {
                diagnosis.causes[k].parameters = estimates;
            }
            progress("fitting a free model of the residuals", 0.7);
            diagnosis.together = Some(Together {
                effects: causes.iter().map(|cause| cause.effect.name).collect(),
                shrink: refit.shrink,
                black_box: self.black_box(),
                held_out_runs: self.held_out_runs(),
            });
        }
        progress("foretelling runs", 0.9);
        let alone = diagnosis.together.as_ref().filter(|_| stood_by.len() == 1).map(|t| t.shrink);
        for (k, cause) in diagnosis.causes.iter_mut().enumerate() {
            let stands = stood_by.contains(&k);
            if stands || k < ALSO_TOLD {
                let shrink = || self.shrink_by(core::slice::from_ref(cause));
                cause.shrink = Some(alone.filter(|_| stands).unwrap_or_else(shrink));
            }
        }
        diagnosis.notes.extend(diagnosis.unshrunk());
    }

    /// Shares of the whole machine's gap, a block's dealt out among its places by their own gaps.
    fn share_out(&self, places: &mut [Place]) {
        let shares = self.shares();
        for (block, share) in shares {
            let of_block = |place: &Place| carrier(place.spot.block) == block;
            let total: f64 = places.iter().filter(|p| of_block(p)).map(|p| p.gap_over_noise).sum();
            for place in places.iter_mut().filter(|p| of_block(p)) {
                place.share = if total > 0.0 { share * place.gap_over_noise / total } else { 0.0 };
            }
        }
    }
}

/// Block among whose places a share is dealt out.
const fn carrier(block: Block) -> Block {
    match block {
        Block::Arms | Block::Steering | Block::Drive => block,
        Block::Tyre | Block::Payload | Block::Ground | Block::Sensor | Block::Bus => Block::Payload,
    }
}
