//! From what the logs say to how likely it is that nothing is wrong, something unknown, or a known effect.
//!
//! What the logs say comes down to two figures, [`Grounds`]. Five [`Scales`] make probabilities of them. They
//! are numbers of machines, not of physics: which machines with such figures turned out to be what. An
//! examination says which scales suit its machines best (`docs/gap-check.md`).

use serde::Serialize;

/// What a verdict rests on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Grounds {
    /// Evidence of the best cause, nats, from 0.
    pub evidence_nats: f64,
    /// How loud the strongest objection to the best cause or pair is, beside the loudest that a right
    /// answer meets: about 1, or less, where it is right.
    pub left_over: f64,
}

/// How grounds become probabilities.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Scales {
    /// Evidence at which an effect and nothing are as likely, nats, beside those faults that logs do not show.
    pub something_nats: f64,
    /// By which power of the evidence the odds of that go.
    pub something_power: f64,
    /// Share of faulty machines whose logs show nothing, 0 to 1.
    pub unseen_share: f64,
    /// What is left over where something unknown is an even chance.
    pub unknown_times: f64,
    /// By which power of what is left over the odds of that go.
    pub unknown_power: f64,
}

/// What grounds make likely; the four come to one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chances {
    /// Nothing is wrong beyond ordinary tolerances.
    pub none: f64,
    /// An effect of the catalogue is there, and shows in nothing: which one, nobody can say.
    pub unseen: f64,
    /// Something is wrong, and is not in the catalogue.
    pub unknown: f64,
    /// An effect of the catalogue is there, and shows.
    pub known: f64,
}

impl Scales {
    /// Those of every diagnosis.
    pub const IN_USE: Self = Self {
        something_nats: 18.0,
        something_power: 4.0,
        unseen_share: 0.05,
        unknown_times: 1.33,
        unknown_power: 9.0,
    };

    /// What `grounds` make likely.
    #[must_use]
    pub fn chances(&self, grounds: Grounds) -> Chances {
        let seen = turned(grounds.evidence_nats, [self.something_nats, self.something_power]);
        let unknown = turned(grounds.left_over, [self.unknown_times, self.unknown_power]);
        let [known, nothing] = [seen, 1.0 - seen].map(|share| share * (1.0 - unknown));
        let unseen = nothing * self.unseen_share;
        Chances { none: nothing - unseen, unseen, unknown, known }
    }
}

/// Probability that `value` stands for: a half at the first of `scale`, and as sharp as the second says.
pub(super) fn turned(value: f64, [half, sharp]: [f64; 2]) -> f64 {
    // As a ratio, lest large values to large powers be infinite.
    1.0 / (1.0 + (half / value.max(0.0)).powf(sharp))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chances(evidence_nats: f64, left_over: f64) -> Chances {
        Scales::IN_USE.chances(Grounds { evidence_nats, left_over })
    }

    #[test]
    fn chances_make_one_whatever_the_grounds() {
        for evidence in [0.0, 3.0, 18.0, 4e5] {
            for left_over in [0.0, 0.7, 1.33, 60.0, 1e9] {
                let chances = chances(evidence, left_over);
                let all = [chances.none, chances.unseen, chances.unknown, chances.known];
                assert!((all.iter().sum::<f64>() - 1.0).abs() < 1e-12);
                assert!(all.iter().all(|p| (0.0..=1.0).contains(p)), "{all:?}");
            }
        }
    }

    #[test]
    fn what_shows_nothing_may_still_be_there() {
        let nothing = chances(0.0, 0.5);
        let seldom = Scales::IN_USE.unseen_share;
        assert!((nothing.unseen - seldom).abs() < 1e-3 && nothing.known.abs() < 1e-12);
        assert!((nothing.none - (1.0 - seldom)).abs() < 1e-3);
        assert!(chances(900.0, 0.5).unseen < 1e-6);
    }

    #[test]
    fn what_is_left_over_makes_it_unknown_however_much_is_explained() {
        assert!(chances(1e4, 0.9).known > 0.95);
        assert!((chances(1e4, 1.33).unknown - 0.5).abs() < 1e-9);
        assert!(chances(1e4, 3.0).unknown > 0.99);
    }
}
