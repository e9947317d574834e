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

/// Jumps within this time are one, s: what one cable carries comes within a period or two.
const TOGETHER_S: f64 = 0.05;
/// How many jumps are looked at, the largest first: a sensor that jumps all the time is another matter.
const MOST: usize = 4;

/// A jump of some readings at once.
#[derive(Clone, Debug, PartialEq)]
struct Jump {
    /// When, s of its run, and when that began, s of the day.
    at_s: [f64; 2],
    /// By how much each reading jumps, m, and from what stroke.
    by_m: PerWheel<Option<[f64; 2]>>,
}

/// Starts for the sensors of strokes among `effects`.
pub(super) fn starts(evidence: &Evidence<'_>, effects: &[&'static Effect]) -> Vec<Start> {
    let jumps = jumps(evidence);
    let of = |name: &str| effects.iter().copied().find(|effect| effect.name == name);
    let (bias, scale) = (of("stroke-bias"), of("stroke-scale"));
    let mut starts = Vec::new();
    for jump in jumps.into_iter().take(MOST) {
        let mean = |of: fn([f64; 2]) -> f64| {
            let each: Vec<f64> = jump.by_m.iter().filter_map(|(_, by)| by.map(of)).collect();
            each.iter().sum::<f64>() / each.len() as f64
        };
        let sizes = [(bias, mean(|[by_m, _]| by_m)), (scale, mean(|[by_m, m]| (m + by_m) / m))];
        for (effect, size) in sizes {
            let Some(effect) = effect.filter(|_| size.is_finite()) else { continue };
            let [low, high] = effect.parameters[0].range;
            let values = vec![size.clamp(low, high)];
            for hypothesis in Hypothesis::of(&[effect]) {
                let onsets = jump.onsets(evidence).filter(|_| jump.is_of(&hypothesis));
                starts.extend(onsets.map(|onset| {
                    let gain = hypothesis.gain(evidence, onset, &values) - LATE_MIN;
                    Start { hypothesis, values: values.clone(), onset, gain }
                }));
            }
        }
    }
    starts
}

impl Jump {
    /// Whether just the readings of its wheels jump.
    fn is_of(&self, hypothesis: &Hypothesis) -> bool {
        Wheel::ALL.into_iter().all(|w| hypothesis.scope.contains(w) == self.by_m[w].is_some())
    }

    /// In every run at that instant, and once on the day where that is known.
    fn onsets(&self, evidence: &Evidence<'_>) -> impl Iterator<Item = Onset> + use<> {
        let [at_s, began_s] = self.at_s;
        let is_day_known = !evidence.starts_on_the_day_s().is_empty();
        let once = is_day_known.then(|| Onset::once(began_s + at_s));
        [Some(Onset::in_every_run(at_s)), once].into_iter().flatten()
    }
}

/// All jumps of all runs, the largest first.
fn jumps(evidence: &Evidence<'_>) -> Vec<Jump> {
    let mut jumps = Vec::new();
    for run in evidence.runs() {
        let each = run.stroke_jumps.iter().flat_map(|(w, all)| all.iter().map(move |j| (w, *j)));
        let mut each: Vec<(Wheel, [f64; 3])> = each.collect();
        each.sort_by(|a, b| a.1[0].total_cmp(&b.1[0]));
        for together in each.chunk_by(|a, b| b.1[0] - a.1[0] < TOGETHER_S) {
            let mut by_m = PerWheel::splat(None);
            for (w, [_, by, from_m]) in together {
                by_m[*w] = Some([*by, *from_m]);
            }
            jumps.push(Jump { at_s: [together[0].1[0], run.began_s], by_m });
        }
    }
    let size_m = |jump: &Jump| {
        jump.by_m.iter().filter_map(|(_, by)| *by).fold(0.0_f64, |most, [m, _]| most.max(m.abs()))
    };
    jumps.sort_by(|a, b| size_m(b).total_cmp(&size_m(a)));
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
            s.stroke_jumps[*wheel].push([*at_s, *by_m, 0.16]);
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
