//! Whether each stroke is on the scale of its target: a wrong unit in a DBC makes arms that hold and move a tenth of
//! what they are told, which no fault does.

use core::fmt;

use xt28_machine::Wheel;

use super::COMPARED_EVERY;
use super::along::Along;
use super::wheel_order::{followed, is_told};
use crate::diagnosis::signals::Signals;

/// Root mean square of a target's motion that is too little to tell a scale by, m.
const MOVES_M: f64 = 0.003;
/// How many times more or less than its target an arm may hold and move: one that is stuck, slow or drained does
/// one of the two, not both alike.
const TIMES_MAX: f64 = 4.0;

/// Strokes that are not on the scale of their targets.
#[derive(Clone, Debug, PartialEq)]
pub struct StrokeScale {
    /// Each by its wheel, with how many times its target it moves.
    pub wheels: Vec<(Wheel, f64)>,
}

/// The strokes of all `runs` that stand at and move by other than their targets do, beyond any fault, where arms
/// are told positions that change.
pub(super) fn stroke_scale(runs: &[Signals]) -> Option<StrokeScale> {
    let off = |wheel: Wheel| {
        let all: Vec<Vec<[f64; 2]>> = runs.iter().map(|s| told(s, wheel)).collect();
        let held = Along::of(all.iter().flatten().copied()).times()?;
        let motion = Along::of(all.iter().flat_map(|run| moved(run)));
        let [told_m, _] = motion.means();
        let times = motion.times().filter(|_| told_m > MOVES_M)?;
        let is_off = [held, times].iter().all(|times| *times > TIMES_MAX)
            || [held, times].iter().all(|times| (0.0..1.0 / TIMES_MAX).contains(times));
        is_off.then_some((wheel, times))
    };
    let wheels: Vec<_> = Wheel::ALL.into_iter().filter_map(off).collect();
    (!wheels.is_empty()).then_some(StrokeScale { wheels })
}

/// What a stroke should be on its way to its target, and what it reads, m, where targets count.
fn told(s: &Signals, wheel: Wheel) -> Vec<[f64; 2]> {
    let followed = followed(s, wheel);
    let used = (0..s.len).step_by(COMPARED_EVERY).filter(|i| is_told(s, *i));
    used.map(|i| [followed[i], s.stroke_m[wheel][i]]).collect()
}

/// The same, each less its mean.
#[allow(clippy::cast_precision_loss)]
fn moved(run: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let mean = |k: usize| run.iter().map(|pair| pair[k]).sum::<f64>() / run.len().max(1) as f64;
    let [told, read] = [mean(0), mean(1)];
    run.iter().map(|pair| [pair[0] - told, pair[1] - read]).collect()
}

impl fmt::Display for StrokeScale {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let each =
            self.wheels.iter().map(|(wheel, times)| format!("stroke.{wheel} {times:.2} times"));
        write!(f, "{}", each.collect::<Vec<_>>().join(", "))
    }
}
