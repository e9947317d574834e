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
        let stood_by: Vec<usize> =
            (0..diagnosis.causes.len()).filter(|&k| diagnosis.causes[k].stands()).collect();
        progress("fitting the causes on the whole machine", 0.2);
        if !stood_by.is_empty() {
            let causes: Vec<Cause> =
                stood_by.iter().map(|&k| diagnosis.causes[k].clone()).collect();
            // From the first beginning on, one that begins later would be fitted to a time without it.
            let shrink = match at_different_times(&causes) {
                Some(note) => {
                    diagnosis.notes.push(note);
                    self.shrink_by(&causes)
                }
                None => {
                    let refit = self.refit(&causes);
                    for (&k, estimates) in stood_by.iter().zip(refit.estimates) {
                        diagnosis.causes[k].parameters = estimates;
                    }
                    refit.shrink
                }
            };
            progress("fitting a free model of the residuals", 0.7);
            diagnosis.together = Some(Together {
                effects: causes.iter().map(|cause| cause.effect.name).collect(),
                shrink,
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

/// What to say of causes that do not set in together; nothing of those that do.
fn at_different_times(causes: &[Cause]) -> Option<String> {
    causes.windows(2).any(|pair| pair[0].onset() != pair[1].onset()).then(|| {
        let told = |cause: &Cause| match &cause.begins {
            Some(begins) => format!("{} begins {begins}", cause.effect.name),
            None => format!("{} is there from the start", cause.effect.name),
        };
        let told: Vec<String> = causes.iter().map(told).collect();
        format!(
            "{}: how far the gap shrinks with both is told with both of them from the first of these on, \
             so that it may shrink less than it would; their sizes are what the blocks alone say",
            told.join(", ")
        )
    })
}

/// Block among whose places a share is dealt out.
const fn carrier(block: Block) -> Block {
    match block {
        Block::Arms | Block::Steering | Block::Drive => block,
        Block::Tyre | Block::Payload | Block::Ground | Block::Sensor | Block::Bus => Block::Payload,
    }
}

#[cfg(test)]
mod tests {
    use xt28_sim::effects::{Scope, find};

    use super::*;
    use crate::diagnosis::{Beginning, Onset};

    fn cause(name: &str, at_s: Option<f64>) -> Cause {
        Cause {
            effect: find(name).unwrap(),
            scope: Scope::All,
            scopes: vec![(Scope::All, 1.0)],
            values: Vec::new(),
            probability: 0.9,
            parameters: Vec::new(),
            class: vec!["arm-delay"],
            begins: at_s.map(Onset::in_every_run).and_then(Beginning::of),
            shrink: None,
        }
    }

    #[test]
    fn causes_that_set_in_one_after_the_other_are_told() {
        let of = |a, b| at_different_times(&[cause("arm-delay", a), cause("payload", b)]);
        assert_eq!(of(None, None), None);
        assert_eq!(of(Some(12.0), Some(12.0)), None);
        let note = of(None, Some(12.0)).unwrap();
        assert!(
            note.starts_with(
                "arm-delay is there from the start, payload begins 12.0 s into every run: "
            ),
            "{note}"
        );
        assert_eq!(at_different_times(&[cause("arm-delay", Some(3.0))]), None);
    }
}
