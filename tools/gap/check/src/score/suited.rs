//! Which scales of the diagnosis suit machines whose truth is known best.
//!
//! Of all scales those under which what came out was likeliest, kept from wandering where few machines say
//! anything: each is believed beforehand to be what was first set by hand, to within a factor of 1.6. What is
//! in use has no say in it, so that fitting again to the same machines gives the same again.

use serde::Serialize;
use xt28_gap::diagnosis::{Grounds, Scales};

use super::rate::{Score, drawn_again};
use crate::truth::Kind;

/// What a diagnosis rested on, and what was so.
pub type Outcome = (Grounds, Kind);

/// The scales that were set by hand, and how far they are believed to be off, as a logarithm.
const BELIEVED: Scales = Scales {
    something_nats: 18.0,
    something_power: 4.0,
    unseen_share: 0.05,
    unknown_times: 1.2,
    unknown_power: 10.0,
};
const WITHIN: f64 = 0.5;
/// The largest share of faults that is looked at.
const UNSEEN_MAX: f64 = 0.5;
/// The first and the last step by which the logarithm of a scale is moved.
const STEPS: [f64; 2] = [0.3, 0.01];
/// What is stated is never taken as surer than this.
const SURE: f64 = 1e-6;
/// Bootstrap draws.
const DRAWS: usize = 200;

/// A scale by its name in a report, and how it is read and set.
type Scale = (&'static str, fn(&mut Scales) -> &mut f64);

/// All scales, in the order printed.
const SCALES: [Scale; 5] = [
    ("evidence of an even chance, nats", |scales| &mut scales.something_nats),
    ("power of the odds of something", |scales| &mut scales.something_power),
    ("share of faults that do not show", |scales| &mut scales.unseen_share),
    ("left over at an even chance", |scales| &mut scales.unknown_times),
    ("power of the odds of unknown", |scales| &mut scales.unknown_power),
];

/// One scale.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Suited {
    /// What it is.
    pub name: &'static str,
    /// What is in use.
    pub in_use: f64,
    /// What suits best, with a bootstrap's 95 % interval over cases.
    pub best: Score,
}

/// The scales that suit `outcomes` best; none of no outcomes.
#[must_use]
pub fn suited(outcomes: &[Outcome]) -> Vec<Suited> {
    if outcomes.is_empty() {
        return Vec::new();
    }
    let mut best = likeliest(outcomes);
    let mut drawn = drawn_again(outcomes, DRAWS, likeliest);
    let each = |(name, of): Scale| {
        let mut values: Vec<f64> = drawn.iter_mut().map(|scales| *of(scales)).collect();
        Suited {
            name,
            in_use: *of(&mut Scales::IN_USE.clone()),
            best: Score::drawn(*of(&mut best), &mut values, outcomes.len()),
        }
    };
    SCALES.map(each).to_vec()
}

/// The scales under which `outcomes` are likeliest: one after the other is moved by a step while that
/// helps, and the step halved when nothing does.
fn likeliest(outcomes: &[Outcome]) -> Scales {
    let mut best = (cost(&BELIEVED, outcomes), BELIEVED);
    let mut step = STEPS[0];
    while step > STEPS[1] {
        let mut helped = false;
        for (_, of) in SCALES {
            for by in [step, -step] {
                let mut moved = best.1;
                *of(&mut moved) *= by.exp();
                moved.unseen_share = moved.unseen_share.min(UNSEEN_MAX);
                let cost = cost(&moved, outcomes);
                if cost < best.0 {
                    (best, helped) = ((cost, moved), true);
                }
            }
        }
        if !helped {
            step *= 0.5;
        }
    }
    best.1
}

/// How unlikely `outcomes` are under `scales`, and `scales` themselves, nats.
fn cost(scales: &Scales, outcomes: &[Outcome]) -> f64 {
    let said = |(grounds, kind): &Outcome| {
        let chances = scales.chances(*grounds);
        let stated = match kind {
            Kind::Null => chances.none,
            Kind::Unknown => chances.unknown,
            Kind::Single | Kind::Pair => chances.known + chances.unseen,
        };
        -stated.clamp(SURE, 1.0).ln()
    };
    let mut pairs = [*scales, BELIEVED];
    let strayed = |(_, of): Scale| {
        let [a, b] = pairs.each_mut().map(|scales| of(scales).ln());
        ((a - b) / WITHIN).powi(2) / 2.0
    };
    SCALES.map(strayed).iter().sum::<f64>() + outcomes.iter().map(said).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use rand::{Rng, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    use super::*;

    /// Machines with evidence and leftovers all over the place, as often what they are said to be as
    /// `scales` have it.
    fn machines(scales: Scales) -> Vec<Outcome> {
        let mut outcomes = Vec::new();
        let mut dice = ChaCha8Rng::seed_from_u64(28);
        for i in 0..30 {
            for k in 0..30 {
                let at = |k: i32, from: f64, to: f64| from * (to / from).powf(f64::from(k) / 29.0);
                let grounds =
                    Grounds { evidence_nats: at(i, 1.0, 300.0), left_over: at(k, 0.3, 5.0) };
                let chances = scales.chances(grounds);
                let thrown: f64 = dice.random();
                let kind = if thrown < chances.none {
                    Kind::Null
                } else if thrown < chances.none + chances.unknown {
                    Kind::Unknown
                } else {
                    Kind::Single
                };
                outcomes.push((grounds, kind));
            }
        }
        outcomes
    }

    #[test]
    fn scales_that_made_the_machines_are_found() {
        let made = Scales {
            something_nats: 9.0,
            something_power: 2.5,
            unseen_share: 0.1,
            unknown_times: 1.7,
            unknown_power: 5.0,
        };
        let mut made_by = made;
        for (found, (name, of)) in suited(&machines(made)).iter().zip(SCALES) {
            let true_one = *of(&mut made_by);
            let off = (found.best.value / true_one).ln().abs();
            assert!(off < 0.25, "{name}: {} for {true_one}", found.best.value);
            let [low, high] = found.best.interval;
            assert!(low < found.best.value * 1.05 && high > found.best.value * 0.95, "{found:?}");
        }
    }

    #[test]
    fn few_machines_move_nothing_far() {
        let grounds = Grounds { evidence_nats: 0.0, left_over: 0.5 };
        for scale in suited(&[(grounds, Kind::Null)]) {
            let mut believed = BELIEVED;
            let of = SCALES.iter().find(|(name, _)| *name == scale.name).unwrap().1;
            assert!((scale.best.value / *of(&mut believed)).ln().abs() < 0.1, "{scale:?}");
        }
        assert!(suited(&[]).is_empty());
    }
}
