//! When an effect sets in: at some instant of every run, or once on the day.

use xt28_sim::effects::{Block, Effect, Parameter};

use super::super::evidence::Evidence;
use super::super::generator::moves_fixes;
use super::super::hypothesis::Fit;
use super::super::onset::{Onset, once_least};
use super::{Candidate, Docket, OPEN};

/// First and last instant of a test drive at which an effect may set in, and how far apart others lie between them, s.
/// Longer runs have them as much later and further apart.
const SETS_IN_S: [f64; 2] = [4.0, 26.0];
const EVERY_RUN_STEP_S: f64 = 2.0;
/// How far apart instants of the day lie at which an effect may set in for good, of a test drive, s.
const ONCE_STEP_S: f64 = 4.0;
/// How far apart instants lie where fixes jump with what sets in, s: they do so over the second between two of which
/// a speed is made, and any further from it nothing is explained of that.
const JUMP_STEP_S: f64 = 0.5;
/// How many of the leading hypotheses are asked when they set in.
pub(super) const ASKED: usize = 6;
/// How many are asked beside them that set in late, whatever they foretell.
const ASKED_BESIDE: usize = 3;
/// What a beginning must gain beyond the freedom to choose it, nats.
const BEGINNING_MIN: f64 = 6.0;
/// How many standard deviations some parameter of an effect that sets in late is from where the effect
/// is not there: an arm's oil begins anew with another law, and that alone may explain a jump.
const BEGUN_SIGMA: f64 = 2.0;
/// Tolerances that are next to nothing, and yet more than rounding.
const BARELY: f64 = 2.0e-3;
/// What it must gain with the values of an effect that was always there, nats; else it is not asked. But for one with
/// which fixes jump: those values are as of one with which they do not.
const BEGINNING_HINT: f64 = 2.0;
/// How far apart beginnings that the runs fitted may leave open are tried, s, first all over a run and then about
/// the best: nothing of it shows until a machine moves.
const OPEN_STEPS_S: [f64; 2] = [0.5, 0.1];
/// Beginnings that explain as much but for this are alike, nats: the one in their middle is told.
const ALIKE: f64 = 0.1;
/// The widest, of a test drive, and the finest step in which a beginning is looked for, s: a reading that jumps is off by several floors
/// for a tenth of a second beside it, in every run.
const BEGINNING_STEPS_S: [f64; 2] = [1.0, 0.005];

impl Docket<'_> {
    /// The same candidate setting in late, where that is worth it; one that does, at a better instant.
    pub(super) fn set_in(&self, found: &Candidate) -> Option<Candidate> {
        let Fit { hypothesis, onset, ref values, .. } = found.fit;
        let best = |onsets: &[Onset]| {
            let gains = hypothesis.onset_gains(&self.fit, onsets, values);
            let each = gains.into_iter().zip(onsets.iter().copied());
            each.max_by(|a, b| a.0.total_cmp(&b.0))
        };
        let whole = hypothesis.gain(&self.fit, onset, values);
        let [every_run, on_the_day] = self.onsets(hypothesis.effect);
        let (each, once) = (best(&every_run)?, best(&on_the_day));
        // Where one of the runs fitted alone shows it, it may as well come in every run: those held out tell.
        let told = |(gain, at): (f64, Onset)| {
            gain + self.held.as_ref().map_or(0.0, |held| hypothesis.gain(held, at, values))
        };
        let once = once.filter(|once| {
            let each = told(each);
            let other = each.max(told((whole, onset)));
            told(*once) > if onset.is_once() { each } else { other + once_least(other) }
        });
        let (gain, at) = once.unwrap_or(each);
        let is_asked = onset.is_late()
            || at.is_once()
            || moves_fixes(hypothesis.effect)
            || gain >= whole + BEGINNING_HINT;
        if !is_asked {
            return None;
        }
        let begun = |fit: Fit| self.weighed(self.begun(fit));
        let mut late = begun(hypothesis.refit(&self.fit, at, values));
        // As if it had always been there, what sums up or remembers may seem to begin anywhere.
        if onset.is_late() {
            let nearby = begun(found.fit.clone());
            late = if nearby.score() > late.score() { nearby } else { late };
        }
        let better = if late.score() > found.score() { &late } else { found };
        if better.fit.onset.is_once() {
            // One that came during a run held out is found with the next run fitted, from where it foretells nothing.
            let begun = self.begun_for_all(better);
            return Some(self.once_or_always(begun.unwrap_or_else(|| better.clone())));
        }
        let least = if onset.is_late() { 0.0 } else { BEGINNING_MIN };
        (late.score() > found.score() + least).then_some(late)
    }

    /// When `effect` may set in: in every run, and on the day.
    fn onsets(&self, effect: &Effect) -> [Vec<Onset>; 2] {
        let stretch = self.fit.stretch();
        let [every_run_s, once_s] = if moves_fixes(effect) {
            [JUMP_STEP_S; 2]
        } else {
            [EVERY_RUN_STEP_S, ONCE_STEP_S].map(|step_s| step_s * stretch)
        };
        let [first_s, last_s] = SETS_IN_S.map(|at_s| at_s * stretch);
        let steps = ((last_s - first_s) / every_run_s).round() as u32;
        let every_run =
            (0..=steps).map(|k| Onset::in_every_run(first_s + f64::from(k) * every_run_s));
        [every_run.collect(), self.fit.onsets_on_the_day(once_s)]
    }

    /// One that sets in late with another beginning, of those that the runs fitted leave open, which suits the runs
    /// held out better: what sets in while the runs fitted stand still is told by one that moves.
    pub(super) fn begun_for_all(&self, found: &Candidate) -> Option<Candidate> {
        let Fit { hypothesis, onset, ref values, .. } = found.fit;
        let held = self.held.as_ref().filter(|_| onset.is_late())?;
        let here = hypothesis.gain(&self.fit, onset, values);
        let least = here * (1.0 - OPEN[1]) - OPEN[0];
        let (last_s, starts) = if onset.is_once() {
            let starts = [&self.fit, held].map(Evidence::starts_on_the_day_s).concat();
            (self.fit.last_of_the_day_s(), starts)
        } else {
            (SETS_IN_S[1] * self.fit.stretch(), Vec::new())
        };
        // The middle of those within `reach_s` of `about_s` that suit all runs best.
        let best = |about_s: f64, reach_s: f64, step_s: f64| -> Option<f64> {
            let count = (2.0 * reach_s / step_s).round() as usize;
            let instants = (0..=count).map(|k| about_s - reach_s + k as f64 * step_s);
            let within = |at_s: &f64| *at_s > 0.0 && *at_s <= last_s;
            let mut instants: Vec<f64> = instants.filter(within).collect();
            instants.extend(&starts);
            instants.sort_by(f64::total_cmp);
            let onsets: Vec<Onset> = instants.iter().map(|at_s| onset.at(*at_s)).collect();
            let gains = |evidence| hypothesis.onset_gains(evidence, &onsets, values);
            let each = instants.iter().zip(gains(&self.fit).into_iter().zip(gains(held)));
            let open = each.filter(|(_, (fitted, _))| *fitted > least);
            let both: Vec<(f64, f64)> =
                open.map(|(at_s, (fitted, held))| (*at_s, fitted + held)).collect();
            let most = both.iter().map(|(_, gain)| *gain).fold(f64::NEG_INFINITY, f64::max);
            let best: Vec<f64> = both
                .iter()
                .filter(|(_, gain)| *gain > most - ALIKE)
                .map(|(at_s, _)| *at_s)
                .collect();
            // What comes between two runs comes with the second: nobody knows when between them.
            let with_run = best.iter().find(|at_s| starts.contains(at_s));
            with_run.or_else(|| best.get(best.len() / 2)).copied()
        };
        let [coarse_s, fine_s] = OPEN_STEPS_S;
        let about_s = best(onset.at_s(), last_s, coarse_s)?;
        let at_s = best(about_s, 3.0, fine_s)?;
        let moved = self.weighed(hypothesis.refit(&self.fit, onset.at(at_s), values));
        let moved = Candidate { is_chosen_by_held: true, ..moved };
        (moved.score() > found.score()).then_some(moved)
    }

    /// One that comes once, or the same as it always was where that is as good: what was found on a grid to come once may
    /// have done so because its values there were too large for the runs before.
    fn once_or_always(&self, once: Candidate) -> Candidate {
        let Fit { hypothesis, ref values, .. } = once.fit;
        let always = self.weighed(hypothesis.refit(&self.fit, Onset::ALWAYS, values));
        if once.score() > always.score() + once_least(always.score()) { once } else { always }
    }

    /// The same with its beginning where it explains most, its values anew after every step there: a leak
    /// that begins later and one that is smaller look alike a second beside it.
    fn begun(&self, mut fit: Fit) -> Fit {
        let mut step_s = BEGINNING_STEPS_S[0] * self.fit.stretch();
        while step_s >= BEGINNING_STEPS_S[1] {
            let hypothesis = fit.hypothesis;
            let gain = |at: Onset| (hypothesis.gain(&self.fit, at, &fit.values), at);
            let here = gain(fit.onset).0;
            let [before, after] = [-step_s, step_s].map(|by_s| gain(fit.onset.moved(by_s)));
            let (there, at) = if before.0 > after.0 { before } else { after };
            let moved = (there > here).then(|| hypothesis.refit(&self.fit, at, &fit.values));
            match moved.filter(|moved| moved.log_evidence > fit.log_evidence) {
                Some(moved) => fit = moved,
                None => step_s *= 0.5,
            }
        }
        fit
    }
}

/// Those that are asked when they set in: the leading ones, and what explains the runs fitted from some instant on
/// whatever it foretells. It may be there from another: a band that opens two seconds early harms where
/// an arm moves just then.
pub(super) fn asked(all: &[Candidate]) -> Vec<&Candidate> {
    let (leading, others) = all.split_at(all.len().min(ASKED));
    let mut late: Vec<&Candidate> =
        others.iter().filter(|other| other.fit.onset.is_late()).collect();
    late.sort_by(|a, b| b.fit.log_evidence.total_cmp(&a.fit.log_evidence));
    leading.iter().chain(late.into_iter().take(ASKED_BESIDE)).collect()
}

/// What it explains that an arm's oil begins anew where an effect of it sets in late, nats: what next to
/// nothing of the effect gains there. A jump of a pressure is gone with it, whatever the effect.
pub(super) fn anew(evidence: &Evidence<'_>, fit: &Fit) -> f64 {
    if !fit.onset.is_late() || fit.hypothesis.effect.block != Block::Arms {
        return 0.0;
    }
    let barely = |p: &Parameter| {
        let by = BARELY * p.tolerance;
        if p.neutral + by <= p.range[1] { p.neutral + by } else { p.neutral - by }
    };
    let values: Vec<f64> = fit.hypothesis.effect.parameters.iter().map(barely).collect();
    fit.hypothesis.gain(evidence, fit.onset, &values).max(0.0)
}

/// Whether an effect that sets in late is there at all from then on.
pub(super) fn is_there(fit: &Fit) -> bool {
    let each = fit.hypothesis.effect.parameters.iter().zip(fit.values.iter().zip(&fit.sigma));
    let is_off = |(p, (value, sigma)): (&Parameter, (&f64, &f64))| {
        (value - p.neutral).abs() > BEGUN_SIGMA * sigma
    };
    !fit.onset.is_late() || each.into_iter().any(is_off)
}

#[cfg(test)]
mod tests {
    use xt28_machine::{Machine, Wheel};
    use xt28_sim::Effects;
    use xt28_sim::effects::Scope;

    use super::*;
    use crate::diagnosis::generator::Generator;
    use crate::diagnosis::generator::still::still;
    use crate::diagnosis::knob::Knob;
    use crate::diagnosis::signals::Signals;

    /// A machine that goes east at 1.5 m/s, and from `at_s` on tells fixes by `ahead_m` and `left_m` further.
    fn mast_is_bent(at_s: f64, [ahead_m, left_m]: [f64; 2]) -> Signals {
        let mut s = still(30);
        (s.fixes, s.headings) = (Vec::new(), Vec::new());
        let radius_m = Machine::xt28().wheels.radius_m;
        for w in Wheel::ALL {
            s.cylinder_load_n[w].fill(60.0e3);
            s.wheel_speed_rad_s[w].fill(1.5 / radius_m);
            s.smooth_wheel_speed_rad_s[w].fill(1.5 / radius_m);
        }
        for k in 0..240 {
            let fix_s = 0.125 * f64::from(k);
            let by = f64::from(u8::from(fix_s >= at_s));
            s.fixes.push([fix_s, 1.5 * fix_s + by * ahead_m, by * left_m]);
            s.headings.push([fix_s, 0.0, 0.0]);
        }
        s
    }

    #[test]
    fn fixes_that_jump_tell_when() {
        // Midway between two instants of those that are asked otherwise, further from each than fixes are compared over.
        let runs = [mast_is_bent(9.0, [0.4, 0.3])];
        let generators = vec![Generator::Travel];
        let (machine, nothing) = (Machine::xt28(), Effects::default());
        let fit = Evidence::watching(generators, &runs, &machine, nothing, &Knob::all());
        let docket = Docket { fit, held: None };
        let mut always = Candidate::made_up("gnss-lever-arm", Scope::All, 1.0);
        always.fit.values = vec![0.2, 0.1];
        let found = docket.set_in(&always).expect("a jump of half a metre");
        assert!((found.fit.onset.at_s() - 9.0).abs() < 0.13, "{:?}", found.fit.onset);
        let each = found.fit.values.iter().zip([0.4, 0.3]);
        each.for_each(|(is, was)| assert!((is - was).abs() < 0.05, "{:?}", found.fit.values));
    }

    #[test]
    fn runs_held_out_tell_what_comes_in_every_run_from_what_comes_once() {
        // Of the runs fitted one alone has fixes, and in it the mast is bent.
        let mut silent = mast_is_bent(99.0, [0.0; 2]);
        (silent.fixes, silent.headings) = (Vec::new(), Vec::new());
        let bent = |at_s, began_s| {
            let mut run = mast_is_bent(at_s, [0.4, 0.3]);
            run.began_s = began_s;
            run
        };
        let fitted = [silent, bent(9.0, 30.0)];
        let (machine, knobs) = (Machine::xt28(), Knob::all());
        let onset = |bends_s: f64| {
            let held = [bent(bends_s, 60.0)];
            let [fit, held] = [&fitted[..], &held].map(|runs| {
                let generators = vec![Generator::Travel];
                Evidence::watching(generators, runs, &machine, Effects::default(), &knobs)
            });
            let docket = Docket { fit, held: Some(held) };
            let mut always = Candidate::made_up("gnss-lever-arm", Scope::All, 1.0);
            always.fit.values = vec![0.4, 0.3];
            docket.set_in(&always).expect("a jump of half a metre").fit.onset
        };
        let [again, once] = [onset(9.0), onset(99.0)];
        assert!(!again.is_once() && (again.at_s() - 9.0).abs() < 0.13, "{again:?}");
        assert!(once.is_once() && (once.at_s() - 39.0).abs() < 0.13, "{once:?}");
    }

    #[test]
    fn an_effect_that_sets_in_late_has_to_do_something() {
        let is_there_at = |share: f64, sigma: f64, from_s: f64| {
            let mut fit = Candidate::made_up("accumulator-gas", Scope::All, 400.0).fit;
            for (k, p) in fit.hypothesis.effect.parameters.iter().enumerate() {
                // Rounded, and known to be anything.
                (fit.values[k], fit.sigma[k]) = (p.neutral * (1.0 + 1e-8), p.tolerance);
            }
            (fit.values[0], fit.sigma[0]) = (share, sigma);
            fit.onset = Onset::in_every_run(from_s);
            is_there(&fit)
        };
        assert!(!is_there_at(0.0, 0.05, 14.0) && !is_there_at(0.0245, 0.4, 14.0));
        assert!(is_there_at(0.5, 0.05, 14.0) && is_there_at(0.0, 0.05, 0.0));
    }

    #[test]
    fn what_explains_much_from_an_instant_on_is_asked_though_it_foretells_nothing() {
        let mut all: Vec<Candidate> =
            (0..12).map(|_| Candidate::made_up("valve-gain", Scope::All, 5.0)).collect();
        for (k, (from_s, nats)) in [(12.0, 300.0), (0.0, 900.0)].into_iter().enumerate() {
            let beside = &mut all[10 + k];
            (beside.fit.onset, beside.fit.log_evidence) = (Onset::in_every_run(from_s), nats);
            (beside.held_gain, beside.held_most) = (Some(-200.0), 200.0);
        }
        let asked = asked(&all);
        assert_eq!(asked.len(), ASKED + 1);
        assert_eq!(asked[ASKED].fit.log_evidence, 300.0);
    }
}
