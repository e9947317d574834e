//! A few seconds-by-seconds pictures of where the gap is largest, before and after.

use super::{Pair, STEP_S, rms};
use crate::diagnosis::floor::Signal;
use crate::diagnosis::generator::{Generator, SAMPLES_PER_RESIDUAL};
use crate::diagnosis::inquiry::Inquiry;
use crate::diagnosis::signals::{Samples, Signals};

/// Pictures at most.
const TRACES: usize = 4;

/// One signal over one run.
#[derive(Clone, Debug, PartialEq)]
pub struct Trace {
    /// Run and generator.
    pub title: String,
    /// Unit of all values.
    pub unit: &'static str,
    /// What was measured; `None` where the signal is no reading of its own.
    pub measured: Option<Samples>,
    /// Simulated less measured, without the causes; `NaN` where nothing can be said.
    pub before: Samples,
    /// The same with them.
    pub after: Samples,
    /// Whether the run was fitted.
    pub fit: bool,
}

impl Trace {
    /// Instant of sample `k`, s.
    #[must_use]
    #[allow(clippy::cast_precision_loss)]
    pub fn at_s(k: usize) -> f64 {
        (k as f64 + 0.5) * STEP_S
    }
}

/// The generators with the largest gaps, each on the run where it is largest.
pub(super) fn traces(inquiry: &Inquiry, pairs: &[Pair]) -> Vec<Trace> {
    let any_held = inquiry.runs.iter().any(|run| !run.fit);
    let mut seen: Vec<(f64, &Pair, usize)> = Vec::new();
    for pair in pairs.iter().filter(|pair| !any_held || !inquiry.runs[pair.run].fit) {
        for (i, residual) in pair.before.iter().enumerate() {
            if let Some(gap) = rms(residual.values.iter().copied()) {
                seen.push((gap, pair, i));
            }
        }
    }
    seen.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut shown: Vec<(Generator, Signal)> = Vec::new();
    let mut traces = Vec::new();
    for (_, pair, i) in seen {
        let what = (pair.generator, pair.before[i].signal);
        if traces.len() < TRACES && !shown.contains(&what) {
            shown.push(what);
            traces.push(trace(inquiry, pair, i));
        }
    }
    traces
}

fn trace(inquiry: &Inquiry, pair: &Pair, i: usize) -> Trace {
    let run = &inquiry.runs[pair.run];
    let (before, after) = (&pair.before[i], &pair.after[i]);
    let (unit, per_si, measured) = reading(pair.generator, before.signal, &run.signals);
    let per_floor = if unit == FLOORS {
        1.0
    } else {
        run.signals.floors.sigma(pair.generator.key(), before.signal) * per_si
    };
    let error = |values: &Samples| values.iter().map(|value| value * per_floor).collect();
    Trace {
        title: format!("{}: {}, {}", run.file(), pair.generator, before.signal.with_wheel()),
        unit,
        measured: measured.map(|samples| thin(&samples, per_si)),
        before: error(&before.values),
        after: error(&after.values),
        fit: run.fit,
    }
}

/// Unit of a signal that is no reading of its own.
const FLOORS: &str = "noise floors";

/// Unit of a signal, how many of it make one SI unit, and the reading.
fn reading(
    generator: Generator,
    signal: Signal,
    s: &Signals,
) -> (&'static str, f64, Option<Samples>) {
    let deg = 1.0_f64.to_degrees();
    match (generator, signal) {
        (Generator::ArmStroke(w), Signal::Stroke) => {
            ("stroke, mm", 1e3, Some(s.stroke_m[w].clone()))
        }
        (Generator::ArmEcu(w), Signal::ArmOpening) => {
            ("opening, %", 1e2, Some(s.opening[w].clone()))
        }
        (Generator::Joint(j), Signal::JointAngle) => {
            ("joint angle, deg", deg, Some(s.joint_rad[j].clone()))
        }
        (Generator::SteerEcu(j), Signal::SteerOpening) => {
            ("opening, %", 1e2, Some(s.steer_opening[j].clone()))
        }
        (_, Signal::Roll) => ("roll, deg", deg, Some(s.roll_rad.clone())),
        (_, Signal::Pitch) => ("pitch, deg", deg, Some(s.pitch_rad.clone())),
        (_, Signal::RollSway) => ("roll, deg", deg, None),
        (_, Signal::PitchSway) => ("pitch, deg", deg, None),
        (_, Signal::WheelSpeed(w)) => {
            ("wheel speed, rad/s", 1.0, Some(s.wheel_speed_rad_s[w].clone()))
        }
        (_, Signal::Weight) => ("weight, kN", 1e-3, None),
        (_, Signal::DrivePressure | Signal::DriveDifference) => ("pressure, bar", 1e-5, None),
        (Generator::Joint(_), Signal::JointFast) => ("joint angle, deg", deg, None),
        (Generator::Joint(_), Signal::JointRelief) => ("joint rate, deg/s", deg, None),
        (_, Signal::DriveForce) => ("torque on a wheel, kNm", 1e-3, None),
        _ => (FLOORS, 1.0, None),
    }
}

/// A sample in the middle of every residual's.
fn thin(samples: &Samples, per_si: f64) -> Samples {
    samples
        .iter()
        .skip(SAMPLES_PER_RESIDUAL / 2)
        .step_by(SAMPLES_PER_RESIDUAL)
        .map(|value| value * per_si)
        .collect()
}
