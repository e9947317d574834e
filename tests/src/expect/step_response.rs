//! Steps of the stroke targets: rise time, overshoot, steady error.

use serde::Deserialize;
use xt28_machine::Wheel;

use super::Evidence;
use super::arm_speed::WheelName;
use crate::series::{Sample, mean, stretches};
use crate::{Bound, Finding};

/// How the arms named answer every step of their target that is long enough to judge.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StepResponse {
    /// Which arms, by wheel: "FR" to "BL".
    pub wheels: Vec<WheelName>,
    /// Least and greatest time from 10 % to 90 % of a step, s.
    pub rise_s: [f64; 2],
    /// Farthest beyond the target, mm.
    pub overshoot_mm: f64,
    /// Greatest error, as a mean over the last second before the next step, mm.
    pub steady_mm: f64,
}

/// A step counts from this size on, m ...
const STEP_M: f64 = 0.05;
/// ... if its target then stands for this long, s.
const HELD_S: f64 = 8.0;
/// The end of a step over which its error is averaged, s.
const STEADY_S: f64 = 1.0;
const MM_PER_M: f64 = 1e3;

/// What one arm made of one step.
#[derive(Clone, Copy, Debug)]
struct Answer {
    rise_s: f64,
    overshoot_m: f64,
    steady_m: f64,
}

impl StepResponse {
    pub(super) fn judge(&self, evidence: &Evidence<'_>) -> Vec<Finding> {
        let arms = self.wheels.iter().map(|&WheelName(wheel)| (wheel, answers(evidence, wheel)));
        let arms: Vec<(Wheel, Vec<Answer>)> = arms.collect();
        let [low_s, high_s] = self.rise_s;
        let rise = Bound::Between(low_s, high_s);
        let overshoot = Bound::AtMost(self.overshoot_mm);
        let steady = Bound::AtMost(self.steady_mm);
        let whats = ["rise time, slowest step", "rise time, fastest step"];
        let of_worst = ["overshoot, worst step", "steady error, worst step"];
        if let Some((wheel, _)) = arms.iter().find(|(_, answers)| answers.is_empty()) {
            let note = format!("{wheel} has no step of 50 mm that stands for 8 s");
            return vec![
                Finding::missing(whats[0], rise, "s", note.clone()),
                Finding::missing(of_worst[0], overshoot, "mm", note.clone()),
                Finding::missing(of_worst[1], steady, "mm", note),
            ];
        }
        let answers: Vec<Answer> = arms.into_iter().flat_map(|(_, answers)| answers).collect();
        let most = |of: fn(&Answer) -> f64| answers.iter().map(of).fold(0.0, f64::max);
        let fastest_s = answers.iter().map(|a| a.rise_s).fold(f64::INFINITY, f64::min);
        vec![
            Finding::of(whats[0], most(|a| a.rise_s), rise, "s")
                .noting(format!("{} steps", answers.len())),
            Finding::of(whats[1], fastest_s, rise, "s"),
            Finding::of(of_worst[0], most(|a| a.overshoot_m) * MM_PER_M, overshoot, "mm"),
            Finding::of(of_worst[1], most(|a| a.steady_m.abs()) * MM_PER_M, steady, "mm"),
        ]
    }
}

/// Answers of `wheel` to all its steps.
fn answers(evidence: &Evidence<'_>, wheel: Wheel) -> Vec<Answer> {
    let trace = evidence.trace;
    let targets = trace.stroke_target_m.samples();
    let mut answers = Vec::new();
    let mut rest = targets;
    while let Some(target_m) = rest.first().map(|first| first.value[wheel]) {
        let held = stretches(rest, |s| s.value[wheel] == target_m)[0];
        rest = &rest[held.len()..];
        let (from_s, to_s) = (held[0].at_s, held[held.len() - 1].at_s);
        if let Some(target_m) = target_m
            && to_s - from_s >= HELD_S
        {
            let strokes = trace.stroke_m.between(from_s, to_s);
            answers.extend(answer(strokes, |stroke_m| stroke_m[wheel], target_m));
        }
    }
    answers
}

/// What strokes over a constant target show; `None` without a step. One that never
/// gets to 90 % rises for ever.
fn answer<T>(strokes: &[Sample<T>], stroke_m: impl Fn(&T) -> f64, target_m: f64) -> Option<Answer> {
    let start_m = stroke_m(&strokes.first()?.value);
    let step_m = target_m - start_m;
    if step_m.abs() < STEP_M {
        return None;
    }
    let share = |s: &Sample<T>| (stroke_m(&s.value) - start_m) / step_m;
    let reaches = |level: f64| strokes.iter().find(|s| share(s) >= level).map(|s| s.at_s);
    let end_s = strokes.last()?.at_s;
    let last = &strokes[strokes.partition_point(|s| s.at_s < end_s - STEADY_S)..];
    let never_s = f64::INFINITY;
    Some(Answer {
        rise_s: reaches(0.9).map_or(never_s, |at_s| at_s - reaches(0.1).unwrap_or(at_s)),
        overshoot_m: strokes.iter().map(|s| share(s) - 1.0).fold(0.0, f64::max) * step_m.abs(),
        steady_m: mean(last, |s| stroke_m(s) - target_m)?,
    })
}
