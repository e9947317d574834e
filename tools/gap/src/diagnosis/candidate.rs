//! A fitted hypothesis, and what it is worth on the runs fitted and on those held out.

use xt28_machine::Wheel;

use super::hypothesis::Fit;
#[cfg(test)]
use super::{hypothesis::Hypothesis, onset::Onset};

/// How many times as much as it foretells a cause may explain, and what it may explain beside, nats. A
/// right cause explains two to nine times as much on the runs fitted as it foretells of the others; what
/// bends to the first alone explains how two models differ.
const FORETOLD: [f64; 2] = [8.0, 8.0];
/// Share of what it could foretell at most that a second cause must: true ones foretell a third and more, most
/// of them nearly all.
const SECOND_FORETOLD: f64 = 0.5;
/// What a cause is allowed for chance there, nats.
const CHANCE: f64 = 1.0;
/// Runs held out that could tell less of a cause than this say nothing of it, nats.
const TELLING_MIN: f64 = 3.0;

/// A fitted hypothesis with what it is worth on both sets of runs.
#[derive(Clone, Debug)]
pub struct Candidate {
    /// What was fitted, and how well.
    pub fit: Fit,
    /// What the same values gain on the runs held out, nats; below zero they do harm. None where none
    /// was held out, or where none of them shows it: a pump is not short while no arm moves.
    pub held_gain: Option<f64>,
    /// What that could be at most, nats: if the machine were just so.
    pub held_most: f64,
    /// Share of what it gains that another law of the cause beside it could not explain: one where it is
    /// the first.
    pub own_share: f64,
    /// Whether its size or its beginning was chosen by the runs held out too, among those that the runs fitted leave
    /// open.
    pub is_chosen_by_held: bool,
}

impl Candidate {
    /// Name of the effect.
    pub(super) fn name(&self) -> &'static str {
        self.fit.hypothesis.effect.name
    }

    /// Evidence of the runs fitted and foretelling of those held out, nats over the base; a cause that
    /// foretells next to nothing explains no more than that, and pays its full price: of two laws that one
    /// holds in the other, the one with fewer parameters is the likelier.
    #[must_use]
    pub fn score(&self) -> f64 {
        let [times, beside] = FORETOLD;
        let most = self.foretold().map(|[held, _]| times * (held + beside) - self.fit.price);
        self.own_share * most.map_or(self.told(), |most| self.told().min(most))
    }

    /// The same where it is to stand beside a first cause: what that leaves of the runs fitted, another
    /// law bends to, and foretells little of what it would.
    pub(super) fn second_score(&self) -> f64 {
        let share = self.foretold().map_or(1.0, |[held, most]| {
            ((held + CHANCE) / (SECOND_FORETOLD * (most + CHANCE))).clamp(0.0, 1.0)
        });
        share * self.score()
    }

    /// What all runs say of it, nats.
    fn told(&self) -> f64 {
        self.fit.log_evidence + self.held_gain.unwrap_or_default()
    }

    /// What it foretells of the runs held out, and what it could at most; `None` where they could not tell.
    fn foretold(&self) -> Option<[f64; 2]> {
        let held = self.held_gain.filter(|_| self.held_most > TELLING_MIN)?;
        Some([held, self.held_most])
    }

    /// Whether it and a `second` beside it would be one cause that changes as a run goes on, which is in no catalogue:
    /// both set in late, each at another instant, in one block and on some wheel of both.
    pub(super) fn is_one_with(&self, second: &Self) -> bool {
        let (own, other) = (&self.fit, &second.fit);
        let is_on_both = |w| own.hypothesis.scope.contains(w) && other.hypothesis.scope.contains(w);
        own.onset.is_late()
            && other.onset.is_late()
            && other.onset != own.onset
            && own.hypothesis.effect.block == other.hypothesis.effect.block
            && Wheel::ALL.into_iter().any(is_on_both)
    }
}

#[cfg(test)]
impl Candidate {
    /// One that explains `score` nats with every parameter a tolerance off, held out nowhere.
    pub(super) fn made_up(name: &str, scope: xt28_sim::effects::Scope, score: f64) -> Self {
        let effect = xt28_sim::effects::find(name).unwrap();
        let values: Vec<f64> = effect.parameters.iter().map(|p| p.neutral + p.tolerance).collect();
        let (hypothesis, sigma) = (Hypothesis { effect, scope }, vec![0.0; values.len()]);
        let fit = Fit {
            hypothesis,
            values,
            sigma,
            onset: Onset::ALWAYS,
            log_evidence: score,
            price: 0.0,
        };
        let is_chosen_by_held = false;
        Self { fit, held_gain: None, held_most: 0.0, own_share: 1.0, is_chosen_by_held }
    }
}

#[cfg(test)]
mod tests {
    use xt28_machine::{Axle, Side};
    use xt28_sim::effects::Scope;

    use super::*;

    #[test]
    fn what_foretells_little_pays_its_whole_price() {
        let capped = |name: &str, price: f64| {
            let mut found = Candidate::made_up(name, Scope::All, 900.0);
            (found.held_gain, found.held_most, found.fit.price) = (Some(10.0), 20.0, price);
            found.score()
        };
        let [gain, both] = [("valve-gain", 5.0), ("speed-asymmetry", 9.0)];
        assert!((capped(gain.0, gain.1) - capped(both.0, both.1) - 4.0).abs() < 1e-12);
        assert_eq!(capped("valve-gain", 0.0), FORETOLD[0] * (10.0 + FORETOLD[1]));
    }

    #[test]
    fn what_grows_by_steps_is_no_pair() {
        let from = |name: &str, scope: Scope, at_s: f64| {
            let mut late = Candidate::made_up(name, scope, 400.0);
            late.fit.onset = Onset::in_every_run(at_s);
            late
        };
        let gain = from("valve-gain", Scope::All, 16.8);
        for at_s in [8.1, 24.1] {
            assert!(gain.is_one_with(&from("speed-asymmetry", Scope::Axle(Axle::Rear), at_s)));
        }
        let other = [
            from("speed-asymmetry", Scope::All, 0.0),
            from("speed-asymmetry", Scope::All, 16.8),
            from("steer-lag", Scope::All, 24.1),
        ];
        assert!(other.iter().all(|second| !gain.is_one_with(second)));
        let [left, right] = [Side::Left, Side::Right].map(Scope::Side);
        let [left, right] = [from("valve-gain", left, 8.0), from("valve-lag", right, 12.0)];
        assert!(!left.is_one_with(&right));
        let always = from("valve-gain", Scope::All, 0.0);
        assert!(!always.is_one_with(&from("speed-asymmetry", Scope::All, 24.1)));
    }
}
