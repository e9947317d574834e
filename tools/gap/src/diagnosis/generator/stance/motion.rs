//! How the machine moves while it stands on its wheels.

use xt28_machine::{Machine, PerWheel, Wheel};
use xt28_sim::effects::Lag;
use xt28_sim::{Effects, Parts};

use crate::diagnosis::generator::axles::Axles;
use crate::diagnosis::generator::press::{axles_n, own_n};
use crate::diagnosis::kinematics::swung_m;
use crate::diagnosis::signals::{DT_S, Samples, Signals, slope_over};

/// Half of the time over which speeds give an acceleration and joints a rate, samples.
const HALF_SPAN: usize = 10;
/// Acceleration from which a machine is said to change its speed, m/s².
const CALM_M_S2: f64 = 0.1;
/// A cylinder that carries less may have its wheel in the air, N.
const CARRYING_N: f64 = 5_000.0;
/// What an axle presses the ground with at the least, N: one alone does not say how the machine turns.
const LEAST_N: f64 = 100.0;
/// Samples until the machine has stopped rocking after that: one second.
const ROCKING: usize = 100;
/// Half of the stroke by which an arm that stands still may seem to move, m: readings flicker.
const FLICKER_M: f64 = 0.0004;

/// Motion over the ground, a hundred samples a second.
pub(super) struct Motion {
    /// Forward acceleration, m/s².
    pub(super) ahead_m_s2: Samples,
    /// Acceleration to the left in a bend, m/s².
    pub(super) left_m_s2: Samples,
    /// Yaw rate of the front frame, left > 0, rad/s.
    pub(super) turn_rad_s: Samples,
    /// Whether the machine neither gains nor loses speed, nor did so just now.
    pub(super) is_calm: Vec<bool>,
}

impl Motion {
    /// Motion that wheel speeds and joints say.
    pub(super) fn new(s: &Signals, machine: &Machine) -> Self {
        let speed = speeds(s, machine);
        let ahead_m_s2 = slope_over(&speed, HALF_SPAN);
        let turn_rad_s = turn_rates(s, machine, &speed);
        let left_m_s2: Samples = speed.iter().zip(&turn_rad_s).map(|(v, r)| v * r).collect();
        let mut rocking = 0;
        let is_calm = ahead_m_s2.iter().map(|a| {
            rocking = if a.abs() > CALM_M_S2 { ROCKING } else { rocking.saturating_sub(1) };
            rocking == 0
        });
        let is_calm = is_calm.collect();
        Self { ahead_m_s2, left_m_s2, turn_rad_s, is_calm }
    }
}

/// Speed of the frames, m/s: what the wheels on the ground roll, less the swing of their arms.
fn speeds(s: &Signals, machine: &Machine) -> Samples {
    let parts = Parts::new(machine, &Effects::default());
    let swings = PerWheel::from_fn(|w| {
        let pose = s.stroke_m[w].iter().map(|stroke| parts.linkage.at_stroke(*stroke));
        let swung = pose.map(|pose| swung_m(parts.arms[w].extends, parts.radius_m, &pose));
        slope_over(&swung.collect(), HALF_SPAN)
    });
    let mut last = 0.0;
    let step = |i: usize| {
        let carries = |w: &Wheel| s.cylinder_load_n[*w][i] > CARRYING_N;
        let (mut sum, mut count) = (0.0, 0.0);
        for w in Wheel::ALL.into_iter().filter(carries) {
            let rolls_m_s = s.wheel_speed_rad_s[w][i] * parts.radius_m;
            sum += rolls_m_s - swings[w][i];
            count += 1.0;
        }
        if count > 0.0 {
            last = sum / count;
        }
        last
    };
    (0..s.len).map(step).collect()
}

/// Yaw rates of the front frame, rad/s: three axles slip sideways as little as they can, each counted by what it
/// presses the ground with. Arms lift wheels, and an axle in the air does not say where its frame goes.
fn turn_rates(s: &Signals, machine: &Machine, speed_m_s: &Samples) -> Samples {
    let axles = Axles::new(machine);
    let parts = Parts::new(machine, &Effects::default());
    let own_n = PerWheel::from_fn(|w| own_n(machine, &parts, w));
    let joint_rates = [0, 1].map(|joint: usize| slope_over(&s.joint_rad[joint], HALF_SPAN));
    let at = |i: usize| {
        let pose = PerWheel::from_fn(|w| parts.linkage.at_stroke(s.smooth_stroke_m[w][i]));
        let load_n = PerWheel::from_fn(|w| s.cylinder_load_n[w][i]);
        let pressed_n = axles_n(&own_n, &load_n, &pose).map(|axle_n| axle_n + LEAST_N);
        let angle = [0, 1].map(|joint: usize| s.joint_rad[joint][i]);
        let rate = [0, 1].map(|joint: usize| joint_rates[joint][i]);
        axles.rolling_under(pressed_n, angle, rate, speed_m_s[i]).turn_rad_s[0]
    };
    (0..s.len).map(at).collect()
}

/// `samples` through a first-order lag that starts settled on the first.
pub(super) fn lagged(samples: impl Iterator<Item = f64>, time_constant_s: f64) -> Samples {
    let mut lag: Option<Lag> = None;
    let step = |value| lag.get_or_insert(Lag::new(value)).step(value, time_constant_s, DT_S);
    samples.map(step).collect()
}

/// Strokes that move only where the readings leave the band about them.
pub(super) fn unflickered(stroke_m: &Samples) -> Samples {
    let mut at_m = stroke_m.first().copied().unwrap_or_default();
    let follow = |reading_m: &f64| {
        at_m = at_m.clamp(reading_m - FLICKER_M, reading_m + FLICKER_M);
        at_m
    };
    stroke_m.iter().map(follow).collect()
}
