//! The whole diagnosis of one inquiry, step after step.

use xt28_sim::effects::Effect;

use super::belief::Base;
use super::candidate::Candidate;
use super::candidates::Docket;
use super::excitation::Shown;
use super::how_far::HowFar;
use super::hypothesis::{Fit, Hypothesis};
use super::inquiry::Inquiry;
use super::judgement::{Findings, HeldOut, HeldOutSignal, SignalFindings};
use super::knob::{Knob, SHIFT_MAX};
use super::likely_wheels::at_likely_wheels;
use super::overlap::{Paid, own_share};
use super::signals::Signals;
use super::verdict::Diagnosis;

/// A second cause must be worth this much, nats.
const SECOND_MIN: f64 = 12.0;
/// What a cause must explain that nothing in the runs would make the machine show, nats: twice what makes
/// something as likely as nothing. Some effects bend to whatever else is there where they have nothing to do.
const UNTESTED_MIN: f64 = 36.0;
/// How far tolerances go, each by its own, where nobody knows beside what.
const SHIFT_ALONE: f64 = 1.0;
/// How many of the single candidates may be the first of a pair.
const LIKELY: usize = 12;
/// Second causes that are kept.
const LISTED: usize = 10;

/// How far a diagnosis has come.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// What is being done.
    pub stage: &'static str,
    /// Share of the whole that is done, 0 to 1.
    pub done: f64,
}

impl Inquiry {
    /// The answer. `progress` hears of every step, from any thread.
    #[must_use]
    pub fn diagnose(&self, progress: &(dyn Fn(Progress) + Sync)) -> Diagnosis {
        let mut diagnosis = self.looked(progress).1;
        self.say_how_far(&mut diagnosis, progress);
        diagnosis
    }

    /// The whole machine's word, where it is asked for; logs that cannot be foretold are noted.
    fn say_how_far(&self, diagnosis: &mut Diagnosis, progress: &(dyn Fn(Progress) + Sync)) {
        if !self.how_far {
            return;
        }
        let tell = |stage, done| progress(Progress { stage, done: 0.75 + 0.25 * done });
        match HowFar::new(self) {
            Ok(how_far) => how_far.complete(diagnosis, &tell),
            Err(error) => {
                diagnosis.notes.push(format!("How far the gap shrinks is not known: {error}."));
            }
        }
    }

    /// What `runs`, those fitted and those held out, say of every hypothesis.
    pub(super) fn findings_of(
        &self,
        runs: &[Vec<Signals>; 2],
        progress: &(dyn Fn(Progress) + Sync),
    ) -> Findings {
        let tell = |stage, done| progress(Progress { stage, done });
        let [fit, held] = runs;
        let knobs = Knob::of(&self.catalogue);
        let docket = |base: &_| Docket::new([fit, held], &self.machine, base, &knobs);
        tell("driving every block with what was measured", 0.0);
        let first = docket(&self.believed.clone().into());
        let (unbent, alone) = (first.unbent(), first.apart(&[], SHIFT_ALONE));
        tell("trying every cause", 0.05);
        let shown = Shown::of(self.runs.iter().map(|run| &run.signals), &self.machine);
        let single = tested(first.candidates(&self.catalogue), &shown);
        if single.is_empty() {
            let Paid { left: after, shifts } = first.paid(&[]);
            let signals = SignalFindings::each([&unbent, &alone, &after, &after], &[]);
            let held_out = first.held_out(&first, &[]);
            return Findings { signals, shifts, held_out, ..Findings::default() };
        }
        tell("trying second causes", 0.4);
        let Pairs { pair, firsts, beside } = self.second((&first, &docket), &single, &shown);
        tell("looking at what is left", 0.7);
        // They were sought beside one second, and say nothing beside another.
        let is_beside = |second: &Effect| {
            pair.first().is_some_and(|[_, best]| best.fit.hypothesis.effect == second)
        };
        let firsts = firsts.filter(|(second, _)| is_beside(second)).map_or(Vec::new(), |(_, f)| f);
        let look = |believed: &[&Candidate], court: &Docket| {
            let fits: Vec<&Fit> = believed.iter().map(|candidate| &candidate.fit).collect();
            let last = fits[fits.len() - 1];
            let Paid { left: after, shifts } = court.paid(&[last]);
            let (echoes, unevens) = court.again(&[last], &self.believed);
            let held_out = first.held_out(court, &[last]);
            let apart = first.apart(&fits, SHIFT_MAX);
            let signals = SignalFindings::each([&unbent, &alone, &apart, &after], &echoes);
            Findings { signals, unevens, shifts, held_out, ..Findings::default() }
        };
        match pair.first() {
            Some([one, second]) => {
                let looked = look(&[one, second], &beside);
                Findings { single, pair, firsts, ..looked }
            }
            None => at_likely_wheels(single, &|alone| look(&[alone], &first)),
        }
    }

    /// Two causes at once, the best first, none where one is enough; and what was found on the way.
    ///
    /// With the first believed, a second is sought; with that believed, the first is sought anew among
    /// the likely ones, for it was found while the second still disturbed.
    fn second<'a>(
        &self,
        (alone, docket): (&Docket<'a>, &dyn Fn(&Base) -> Docket<'a>),
        single: &[Candidate],
        shown: &Shown,
    ) -> Pairs<'a> {
        let beside = |one: &Candidate| {
            let effects = one.fit.hypothesis.applied(&self.believed, &one.fit.values);
            docket(&Base { effects, since: one.fit.onset, before: self.believed.clone() })
        };
        let others = |one: &Candidate, among: &[&'static Effect]| -> Vec<&'static Effect> {
            among.iter().copied().filter(|effect| *effect != one.fit.hypothesis.effect).collect()
        };
        let seconds_of = |court: &Docket, first: &Candidate, among: &[&'static Effect]| {
            let mut seconds = tested(court.candidates(among), shown);
            seconds.retain(|second| !first.is_one_with(second));
            owned(seconds, &first.fit, [alone, court])
        };
        let mut first = single[0].clone();
        let mut court = beside(&first);
        let mut seconds = seconds_of(&court, &first, &others(&first, &self.catalogue));
        let Some(second) = seconds.first().cloned() else {
            return Pairs { pair: Vec::new(), firsts: None, beside: court };
        };
        let mut likely: Vec<&'static Effect> = Vec::new();
        for candidate in single.iter().take(LIKELY) {
            if !likely.contains(&candidate.fit.hypothesis.effect) {
                likely.push(candidate.fit.hypothesis.effect);
            }
        }
        let other_court = beside(&second);
        let mut again = other_court.candidates(&others(&second, &likely));
        if first.fit.onset.is_late() {
            other_court.keep(&mut again, &first.fit);
        }
        let again = tested(again, shown);
        if let Some(better) = again.first().filter(|better| better.score() > SECOND_MIN) {
            // Its second was found, and is judged, beside the one that is told: one that stays within what
            // is known of it is left as it was.
            if better.fit.parts_from(&first.fit) {
                first = better.clone();
                court = beside(&first);
                seconds = seconds_of(&court, &first, &[second.fit.hypothesis.effect]);
            }
        }
        let pairs = seconds.into_iter().map(|second| [first.clone(), second]);
        let firsts = Some((second.fit.hypothesis.effect, again));
        Pairs { pair: pairs.collect(), firsts, beside: court }
    }
}

/// What a search for two causes found.
struct Pairs<'a> {
    /// The pairs, all with one first.
    pair: Vec<[Candidate; 2]>,
    /// What may be the first, and the second beside which it was sought.
    firsts: Option<(&'static Effect, Vec<Candidate>)>,
    /// The evidence beside the first.
    beside: Docket<'a>,
}

impl Docket<'_> {
    /// What the runs held out say of `fits`, which were found in `court`.
    fn held_out(&self, court: &Docket<'_>, fits: &[&Fit]) -> HeldOut {
        let signals = self.unbent_held().into_iter().zip(court.left_held(fits));
        HeldOut {
            signals: signals.map(|(unbent, after)| HeldOutSignal { unbent, after }).collect(),
            shifts: court.shifts_held(fits),
        }
    }
}

/// Those of `candidates` that the runs can show, and what is there beyond doubt all the same.
fn tested(mut candidates: Vec<Candidate>, shown: &Shown) -> Vec<Candidate> {
    candidates.retain(|candidate| {
        let Hypothesis { effect, scope, .. } = candidate.fit.hypothesis;
        candidate.score() > UNTESTED_MIN || shown.has(effect, scope)
    });
    candidates
}

/// Those of `seconds` that are worth telling, by what they explain of their own. Their `first` was found `alone`, and
/// they were found `beside` it.
fn owned(
    mut seconds: Vec<Candidate>,
    first: &Fit,
    [alone, beside]: [&Docket; 2],
) -> Vec<Candidate> {
    seconds.retain(|second| second.score() > SECOND_MIN);
    seconds.truncate(LISTED);
    if seconds.is_empty() {
        return seconds;
    }
    let by_first = [&alone.paid(&[]), &alone.paid(&[first])];
    let nothing = beside.paid(&[]);
    for second in &mut seconds {
        second.own_share = own_share(by_first, [&nothing, &beside.paid(&[&second.fit])]);
    }
    seconds.retain(|second| second.score() > SECOND_MIN);
    seconds.sort_by(|a, b| b.score().total_cmp(&a.score()));
    seconds
}

#[cfg(test)]
mod tests {
    use xt28_sim::effects::Scope;

    use super::*;

    #[test]
    fn what_nothing_shows_is_no_candidate_unless_it_is_beyond_doubt() {
        let nothing = Shown::of(std::iter::empty(), &xt28_machine::Machine::xt28());
        let all = [("steer-gain", 20.0), ("arm-delay", 80.0), ("stroke-bias", 20.0)];
        let all = all.map(|(name, nats)| Candidate::made_up(name, Scope::All, nats));
        let kept = tested(all.to_vec(), &nothing);
        let names: Vec<&str> = kept.iter().map(Candidate::name).collect();
        assert_eq!(names, ["arm-delay", "stroke-bias"]);
    }
}
