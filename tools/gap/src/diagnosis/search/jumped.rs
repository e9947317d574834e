//! What sets in as readings of strokes jump: which sensors came loose, when and by how much is read off the jump.
//!
//! On the grid of the first look an effect that sets in late is weighed as if it had always been there, so that the
//! jump itself, which is all that there is to see of a sensor while nothing else looks at its arm, stays unexplained.

use xt28_machine::{PerWheel, Wheel};
use xt28_sim::effects::Effect;

use super::{LATE_MIN, Start};
use crate::diagnosis::evidence::Evidence;
use crate::diagnosis::hypothesis::Hypothesis;
use crate::diagnosis::onset::Onset;
use crate::diagnosis::signals::StrokeJump;

/// Jumps within this time are one, s: what one cable carries comes within a period or two.
const TOGETHER_S: f64 = 0.05;
/// How many jumps are looked at, the largest first: a sensor that jumps all the time is another matter.
const MOST: usize = 4;

/// A jump of some readings at once.
#[derive(Clone, Debug, PartialEq)]
struct Jump {
    /// When, s of its run.
    at_s: f64,
    /// When that began, s of the day.
    began_s: f64,
    /// Of which wheels, and how.
    of: PerWheel<Option<StrokeJump>>,
}

/// Starts for the sensors of strokes among `effects`.
pub(super) fn starts(evidence: &Evidence<'_>, effects: &[&'static Effect]) -> Vec<Start> {
    let mut starts = Vec::new();
    for jump in jumps(evidence).iter().take(MOST) {
        let bias_m = jump.mean(|of| of.by_m);
        let factor = jump.mean(|of| (of.from_m + of.by_m) / of.from_m);
        for (name, size) in [("stroke-bias", bias_m), ("stroke-scale", factor)] {
            // An arm that is all the way in has no scale.
            let effect = effects.iter().copied().find(|effect| effect.name == name);
            let Some(effect) = effect.filter(|_| size.is_finite()) else { continue };
            let [low, high] = effect.parameters[0].range;
            starts.extend(jump.starts(evidence, effect, size.clamp(low, high)));
        }
    }
    starts
}

impl Jump {
    /// Mean over the readings that jump.
    fn mean(&self, of: fn(&StrokeJump) -> f64) -> f64 {
        let each: Vec<f64> = self.of.iter().filter_map(|(_, jump)| jump.as_ref().map(of)).collect();
        each.iter().sum::<f64>() / each.len() as f64
    }

    /// By how much the reading jumps that does so most, m.
    fn size_m(&self) -> f64 {
        let each = self.of.iter().filter_map(|(_, jump)| jump.as_ref());
        each.fold(0.0, |most, jump| most.max(jump.by_m.abs()))
    }

    /// An `effect` of this size from the jump on: in every run at that instant, and once on the day where that is known.
    fn starts(&self, evidence: &Evidence<'_>, effect: &'static Effect, size: f64) -> Vec<Start> {
        let is_day_known = !evidence.starts_on_the_day_s().is_empty();
        let once = is_day_known.then(|| Onset::once(self.began_s + self.at_s));
        let onsets = [Some(Onset::in_every_run(self.at_s)), once];
        let is_of = |one: &Hypothesis| {
            Wheel::ALL.into_iter().all(|w| one.scope.contains(w) == self.of[w].is_some())
        };
        let mut starts = Vec::new();
        for hypothesis in Hypothesis::of(&[effect]).into_iter().filter(is_of) {
            starts.extend(onsets.into_iter().flatten().map(|onset| {
                let values = vec![size];
                let gain = hypothesis.gain(evidence, onset, &values) - LATE_MIN;
                Start { hypothesis, values, onset, gain }
            }));
        }
        starts
    }
}

/// All jumps of all runs, the largest first.
fn jumps(evidence: &Evidence<'_>) -> Vec<Jump> {
    let mut jumps = Vec::new();
    for run in evidence.runs() {
        let each = run.stroke_jumps.iter().flat_map(|(w, all)| all.iter().map(move |j| (w, *j)));
        let mut each: Vec<(Wheel, StrokeJump)> = each.collect();
        each.sort_by(|a, b| a.1.at_s.total_cmp(&b.1.at_s));
        for together in each.chunk_by(|a, b| b.1.at_s - a.1.at_s < TOGETHER_S) {
            let mut of = PerWheel::splat(None);
            together.iter().for_each(|(w, jump)| of[*w] = Some(*jump));
            jumps.push(Jump { at_s: together[0].1.at_s, began_s: run.began_s, of });
        }
    }
    jumps.sort_by(|a, b| b.size_m().total_cmp(&a.size_m()));
    jumps
}

#[cfg(test)]
mod tests {
    use xt28_machine::{Machine, Side};
    use xt28_sim::Effects;
    use xt28_sim::effects::{Scope, find};

    use super::*;
    use crate::diagnosis::generator::still::still;
    use crate::diagnosis::knob::Knob;
    use crate::diagnosis::signals::Signals;

    fn loose(jumps: &[(Wheel, f64, f64)]) -> Vec<Signals> {
        let mut s = still(10);
        for (wheel, at_s, by_m) in jumps {
            let jump = StrokeJump { at_s: *at_s, by_m: *by_m, from_m: 0.16 };
            s.stroke_jumps[*wheel].push(jump);
        }
        vec![s]
    }

    fn started(runs: &[Signals]) -> Vec<(&'static str, Scope, Onset, f64)> {
        let machine = Machine::xt28();
        let evidence = Evidence::new(runs, &machine, Effects::default(), &Knob::all());
        let effects = ["stroke-bias", "stroke-scale", "valve-gain"].map(|name| find(name).unwrap());
        let starts = starts(&evidence, &effects);
        let told = |s: Start| (s.hypothesis.effect.name, s.hypothesis.scope, s.onset, s.values[0]);
        starts.into_iter().map(told).collect()
    }

    #[test]
    fn a_jump_says_of_which_sensors_and_when_and_by_how_much() {
        let right = [Wheel::Fr, Wheel::Mr, Wheel::Br];
        let runs = loose(&right.map(|w| (w, 3.0, 0.024)));
        let (scope, onset) = (Scope::Side(Side::Right), Onset::in_every_run(3.0));
        let [bias, scale] = started(&runs)[..] else { panic!("one start of each") };
        assert_eq!((bias.0, bias.1, bias.2), ("stroke-bias", scope, onset));
        assert_eq!((scale.0, scale.1, scale.2), ("stroke-scale", scope, onset));
        assert!((bias.3 - 0.024).abs() < 1e-9 && (scale.3 - 1.15).abs() < 1e-9, "{scale:?}");
        // One after the other are two; two that are no group have no cause in common.
        assert_eq!(started(&loose(&[(Wheel::Fr, 3.0, 0.02), (Wheel::Ml, 5.0, 0.02)])).len(), 4);
        assert_eq!(started(&loose(&[(Wheel::Fr, 3.0, 0.02), (Wheel::Ml, 3.0, 0.02)])), []);
        assert_eq!(started(&loose(&[])), []);
    }
}
