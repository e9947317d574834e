//! Hypotheses ranked on two sets of runs: fitted on one, held against the other.

mod beginning;

use rayon::prelude::*;
use xt28_machine::{Machine, Wheel};
use xt28_sim::Effects;
use xt28_sim::effects::Effect;

use super::belief::{Base, Belief, Supposed};
use super::candidate::Candidate;
use super::evidence::{Echo, Evidence, Left, Uneven};
use super::hypothesis::{Fit, Hypothesis};
use super::knob::Knob;
use super::onset::Onset;
use super::overlap::Paid;
use super::search::search;
use super::signals::Signals;
use beginning::{ASKED, anew, asked, is_there};

/// Share of the best one's score above which another is sought to the floor of its valley.
const NEAR: f64 = 0.5;
/// What values may lose on the runs fitted that these are said to leave open, nats, and as a share of
/// what they explain: nine in ten of four parameters' posterior, and what laws differ by.
const OPEN: [f64; 2] = [4.0, 0.03];
/// Evidence of the runs fitted from which that is worth a look, nats.
const SUITED_MIN: f64 = 12.0;

/// All runs around one state of belief.
pub(super) struct Docket<'a> {
    fit: Evidence<'a>,
    held: Option<Evidence<'a>>,
}

impl<'a> Docket<'a> {
    /// The runs in `fit` and `held` around `base`, with the tolerances of `knobs`.
    pub(super) fn new(
        [fit, held]: [&'a [Signals]; 2],
        machine: &Machine,
        base: &Base,
        knobs: &[Knob],
    ) -> Self {
        let evidence = |runs| Evidence::new(runs, machine, base.clone(), knobs);
        Self { fit: evidence(fit), held: (!held.is_empty()).then(|| evidence(held)) }
    }

    /// The hypotheses that explain something, best first.
    pub(super) fn candidates(&self, catalogue: &[&'static Effect]) -> Vec<Candidate> {
        let fits = search(&self.fit, catalogue);
        let mut all: Vec<Candidate> = fits.into_par_iter().map(|fit| self.weighed(fit)).collect();
        let open: Vec<Candidate> = all.par_iter().filter_map(|found| self.suiting(found)).collect();
        merge(&mut all, open);
        let near = all.first().map_or(0.0, |best| NEAR * best.score());
        let leading = all.par_iter().take(ASKED).filter(|candidate| candidate.score() > near);
        let settled: Vec<Candidate> = leading.filter_map(|found| self.settled(found)).collect();
        merge(&mut all, settled);
        let asked = self::asked(&all).into_par_iter();
        let late: Vec<Candidate> = asked.filter_map(|candidate| self.set_in(candidate)).collect();
        merge(&mut all, late);
        let elsewhere = all.first().map_or(Vec::new(), |best| self.elsewhere(best));
        merge(&mut all, elsewhere);
        let asked = self::asked(&all).into_par_iter();
        let begun: Vec<Candidate> = asked.filter_map(|found| self.begun_for_all(found)).collect();
        merge(&mut all, begun);
        all
    }

    /// Puts `known` among `all` as it is worth here from its own beginning on, where nothing better was found of it:
    /// instants that are asked lie seconds apart, and what sums up or remembers is another from each.
    pub(super) fn keep(&self, all: &mut Vec<Candidate>, known: &Fit) {
        let Fit { hypothesis, onset, ref values, .. } = *known;
        let kept = self.weighed(hypothesis.refit(&self.fit, onset, values));
        let same = all.iter().find(|other| other.fit.hypothesis == hypothesis);
        if same.is_none_or(|same| same.score() < kept.score()) {
            merge(all, vec![kept]);
        }
    }

    /// What each signal leaves with tolerances where they are believed to be.
    pub(super) fn unbent(&self) -> Vec<Left> {
        self.fit.unbent()
    }

    /// What it costs to believe `fits`, tolerances at their best.
    pub(super) fn paid(&self, fits: &[&Fit]) -> Paid {
        let (believed, onset) = self.believing(fits);
        let (left, shifts) = self.fit.left_and_shifts(believed.from(onset));
        Paid { left, shifts }
    }

    /// What each signal of the runs held out leaves, tolerances at their best there; nothing without any.
    pub(super) fn left_held(&self, fits: &[&Fit]) -> Vec<Left> {
        let (believed, onset) = self.believing(fits);
        self.held.as_ref().map_or(Vec::new(), |held| held.left(believed.from(onset)))
    }

    /// What each signal of the runs held out leaves with tolerances where they are believed to be.
    pub(super) fn unbent_held(&self) -> Vec<Left> {
        self.held.as_ref().map_or(Vec::new(), Evidence::unbent)
    }

    /// Where the tolerances go in the runs held out once `fits` are believed, each by how many of its own.
    pub(super) fn shifts_held(&self, fits: &[&Fit]) -> Vec<(Knob, f64)> {
        let (believed, onset) = self.believing(fits);
        self.held.as_ref().map_or(Vec::new(), |held| held.shifts(believed.from(onset)))
    }

    /// How much of what is left there is what `fits` and the base explain of what `nothing` leaves, moved
    /// in time; and whether, in all runs, that is another share of it in one half than in the other.
    pub(super) fn again(&self, fits: &[&Fit], nothing: &Effects) -> (Vec<Echo>, Vec<Uneven>) {
        let (believed, onset) = self.believing(fits);
        let belief = believed.from(onset);
        let (echoes, mut unevens) = self.fit.again(belief, nothing);
        let held = self.held.as_ref().map_or(Vec::new(), |held| held.again(belief, nothing).1);
        for uneven in held {
            match unevens.iter_mut().find(|other| other.is_like(&uneven)) {
                Some(other) => other.join(&uneven),
                None => unevens.push(uneven),
            }
        }
        (echoes, unevens)
    }

    /// What each signal leaves that is for `fits` to explain, no tolerance further than `most` of its own.
    pub(super) fn apart(&self, fits: &[&Fit], most: f64) -> Vec<Left> {
        let in_turn = self.in_turn(fits);
        let beliefs = in_turn.iter();
        let beliefs = beliefs.map(|(effects, onset)| Belief { onset: *onset, ..effects.into() });
        self.fit.apart(&beliefs.collect::<Vec<_>>(), most)
    }

    /// What is believed once each of `fits` has set in, and from when on, the earliest first: one that
    /// sets in late hides nothing of what was there before.
    fn in_turn(&self, fits: &[&Fit]) -> Vec<(Effects, Onset)> {
        let mut fits = fits.to_vec();
        fits.sort_by(|a, b| a.onset.order(&b.onset));
        let mut effects = self.fit.base().clone();
        let mut onset = Onset::ALWAYS;
        let together = fits.chunk_by(|a, b| a.onset == b.onset);
        let beliefs = together.map(|together| {
            for fit in together {
                effects = fit.hypothesis.applied(&effects, &fit.values);
            }
            onset = onset.later(together[0].onset);
            (effects.clone(), onset)
        });
        beliefs.collect()
    }

    fn believing(&self, fits: &[&Fit]) -> (Supposed, Onset) {
        let with_all = |base: &Effects| {
            let with = |effects, fit: &&Fit| fit.hypothesis.applied(&effects, &fit.values);
            fits.iter().fold(base.clone(), with)
        };
        let onset = fits.iter().map(|fit| fit.onset).fold(Onset::ALWAYS, Onset::later);
        (self.fit.with(with_all), onset)
    }

    /// The effect of the best one at other scopes, from its own values: on more wheels, as of six that were looked
    /// at from a grid's values one alone may have come into its valley; and where it sets in late on all
    /// others too, as only one scope's beginning may have been close to one that was looked at.
    fn elsewhere(&self, best: &Candidate) -> Vec<Candidate> {
        let Fit { hypothesis, onset, ref values, .. } = best.fit;
        let is_late = onset.is_late();
        let is_on = |other: &Hypothesis, w| other.scope.contains(w);
        let has_more = |other: &Hypothesis| {
            Wheel::ALL.into_iter().all(|w| !is_on(&hypothesis, w) || is_on(other, w))
        };
        let others = Hypothesis::of(&[hypothesis.effect]).into_par_iter();
        let asked = |other: &Hypothesis| *other != hypothesis && (is_late || has_more(other));
        let others = others.filter(asked).map(|other| {
            let found = self.weighed(other.refit(&self.fit, onset, values));
            let later = if is_late { self.set_in(&found) } else { None };
            later.unwrap_or(found)
        });
        others.filter(|other| other.score() > best.score()).collect()
    }

    /// The same candidate at the floor of its valley, where it is worth more there.
    fn settled(&self, found: &Candidate) -> Option<Candidate> {
        let settled = found.fit.hypothesis.settled(&self.fit, found.fit.clone());
        let settled =
            Candidate { is_chosen_by_held: found.is_chosen_by_held, ..self.weighed(settled) };
        Some(settled).filter(|settled| settled.score() > found.score())
    }

    /// A candidate that explains much and foretells little, with other values among those that the runs
    /// fitted leave open: what an accumulator is charged with and its size make up for one another until
    /// an arm is lighter than any was.
    fn suiting(&self, found: &Candidate) -> Option<Candidate> {
        let Candidate { fit, .. } = found;
        let held = self.held.as_ref().filter(|_| fit.values.len() > 1)?;
        if found.score() >= fit.log_evidence || fit.log_evidence < SUITED_MIN {
            return None;
        }
        let suited = fit.hypothesis.suiting(&self.fit, held, fit);
        let least = fit.log_evidence * (1.0 - OPEN[1]) - OPEN[0];
        let open = Some(suited).filter(|suited| suited.log_evidence > least)?;
        let suited = Candidate { is_chosen_by_held: true, ..self.weighed(open) };
        Some(suited).filter(|suited| suited.score() > found.score())
    }

    /// What a fit is worth on both sets of runs. One that sets in late and then does nothing is looked at
    /// as if it had always been there.
    fn weighed(&self, fit: Fit) -> Candidate {
        let mut fit = if is_there(&fit) {
            fit
        } else {
            fit.hypothesis.refit(&self.fit, Onset::ALWAYS, &fit.values)
        };
        let gain = |held: &Evidence<'_>| fit.hypothesis.gain(held, fit.onset, &fit.values);
        // Exactly nothing: not one residual is another with it.
        let held_gain = self.held.as_ref().map(|held| (gain(held), anew(held, &fit)));
        let held_gain = held_gain.filter(|(gain, _)| *gain != 0.0).map(|(gain, anew)| gain - anew);
        fit.log_evidence -= anew(&self.fit, &fit);
        let most = |held: &Evidence<'_>| fit.hypothesis.most(held, fit.onset, &fit.values);
        let held_most = self.held.as_ref().filter(|_| held_gain.is_some()).map_or(0.0, most);
        Candidate { fit, held_gain, held_most, own_share: 1.0, is_chosen_by_held: false }
    }
}

/// Puts each of `found` in the place of what was known of its hypothesis, and ranks anew.
fn merge(all: &mut Vec<Candidate>, found: Vec<Candidate>) {
    for candidate in found {
        match all.iter().position(|known| known.fit.hypothesis == candidate.fit.hypothesis) {
            Some(place) => all[place] = candidate,
            None => all.push(candidate),
        }
    }
    rank(all);
}

fn rank(all: &mut [Candidate]) {
    all.sort_by(|a, b| b.score().total_cmp(&a.score()));
}

#[cfg(test)]
mod tests {
    use xt28_machine::Wheel;
    use xt28_sim::effects::Scope;

    use super::*;
    use crate::diagnosis::generator::Generator;
    use crate::{Channel, Series, Terrain};

    /// A machine that drives for 20 s, is told to bend to and fro, and does not.
    fn bends() -> Signals {
        let reads = |channel: Channel| -> Series {
            let at = |k: i32| (0.1 * f64::from(k), 0.02 * f64::from(k));
            let told = |turn: f64| match channel {
                Channel::TargetJoint => 0.2 * turn.sin(),
                Channel::WheelSpeed(_) => 2.0,
                _ => 0.0,
            };
            (0..200).map(at).map(|(at_s, turn)| (at_s, told(turn))).collect()
        };
        let all = Channel::all().into_iter().map(|channel| (channel, reads(channel)));
        Signals::of_series("made up", &all.collect(), 20.0, Terrain::Flat).unwrap()
    }

    #[test]
    fn one_that_is_known_is_kept_where_nothing_better_was_found_of_it() {
        let (runs, knobs) = ([bends()], Knob::all());
        let machine = Machine::xt28();
        let generators = vec![Generator::SteerEcu(0)];
        let fit = Evidence::watching(generators, &runs, &machine, Effects::default(), &knobs);
        let docket = Docket { fit, held: None };
        let known = Candidate::made_up("steer-gain", Scope::All, 90.0).fit;
        let known =
            Fit { onset: Onset::in_every_run(6.0), values: vec![0.3; known.values.len()], ..known };
        let mut all = vec![Candidate::made_up("arm-delay", Scope::All, 90.0)];
        docket.keep(&mut all, &known);
        assert_eq!(all.len(), 2);
        let kept = all.iter().find(|one| one.fit.hypothesis == known.hypothesis).unwrap();
        assert_eq!(kept.fit.onset, known.onset);
        let better = Candidate::made_up("steer-gain", Scope::All, kept.score().max(0.0) + 1.0);
        let mut all = vec![better];
        docket.keep(&mut all, &known);
        assert_eq!((all.len(), all[0].fit.onset), (1, Onset::ALWAYS));
    }

    #[test]
    fn what_was_before_a_base_tells_of_what_is_beside_it() {
        let (runs, knobs, machine) = ([bends()], Knob::all(), Machine::xt28());
        let gain = |base: Base| {
            let generators = vec![Generator::SteerEcu(0)];
            let evidence = Evidence::watching(generators, &runs, &machine, base, &knobs);
            let weak = Candidate::made_up("steer-gain", Scope::All, 90.0).fit;
            weak.hypothesis.gain(&evidence, Onset::in_every_run(4.0), &[0.3])
        };
        let mut base = Base::from(Effects::default());
        let alone = gain(base.clone());
        assert!(alone > 10.0, "{alone}");
        base.effects.arms[Wheel::Fl].delay.delay_s = 0.2;
        // Late in the run, after its end, and as if it always had been there: it is of an arm.
        for since_s in [18.0, 30.0, 0.0] {
            base.since = Onset::in_every_run(since_s);
            let beside = gain(base.clone());
            assert!((beside - alone).abs() < 1e-9 * alone, "{since_s}: {beside} {alone}");
        }
        // A base that is the same from the middle of the run on leaves what was before it to be explained.
        base = Base::from(Effects::default());
        let gain_of = Candidate::made_up("steer-gain", Scope::All, 90.0).fit.hypothesis;
        base.effects = gain_of.applied(&base.effects, &[0.3]);
        base.since = Onset::in_every_run(12.0);
        let rest = gain(base);
        assert!((12.0..0.9 * alone).contains(&rest), "{rest} {alone}");
    }

    #[test]
    fn a_cause_is_told_from_its_own_beginning_beside_one_that_begins_later() {
        let (runs, knobs) = ([bends()], Knob::all());
        let (generators, nothing) = (vec![Generator::SteerEcu(0)], Effects::default());
        let machine = Machine::xt28();
        let fit = Evidence::watching(generators, &runs, &machine, nothing, &knobs);
        let docket = Docket { fit, held: None };
        let weak = |at_s| {
            let weak = Candidate::made_up("steer-gain", Scope::All, 90.0).fit;
            Fit { onset: Onset::in_every_run(at_s), values: vec![0.3; weak.values.len()], ..weak }
        };
        let mut beside = Candidate::made_up("arm-delay", Scope::All, 90.0).fit;
        let neutral = beside.hypothesis.effect.parameters.iter().map(|p| p.neutral);
        (beside.values, beside.onset) = (neutral.collect(), Onset::in_every_run(12.0));
        let told = |fits: &[&Fit]| -> f64 {
            docket.apart(fits, f64::INFINITY).iter().map(|left| left.square).sum()
        };
        let alone = told(&[&weak(0.0)]);
        assert!((told(&[&weak(0.0), &beside]) - alone).abs() < 1e-9 * alone, "{alone}");
        assert!((told(&[&beside, &weak(0.0)]) - alone).abs() < 1e-9 * alone, "in any order");
        let late = told(&[&weak(12.0)]);
        assert!((late - alone).abs() > 1e-3 * alone, "when it sets in tells: {alone} {late}");
    }
}
