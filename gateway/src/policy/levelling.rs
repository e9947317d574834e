//! Keeping the front frame level with the arms, gently, and every wheel on the ground.

use xt28_machine::{Machine, PerWheel, Side};

use crate::{Attitude, Observation};

/// Mean stroke the machine is kept at, m (assumed: two thirds of the policy's range, where the
/// field runs start too).
const MEAN_STROKE_M: f64 = 0.17;
/// Integral action on roll and pitch, 1/s (assumed: some ten times slower than the arms answer).
const RATE_S: f64 = 0.12;
/// Attitude inside of which nothing is corrected, rad (0.25 deg; the ECU's attitude filter
/// stops up to 0.20 deg short, facts 5).
const DEAD_BAND_RAD: f64 = 0.25 * core::f64::consts::PI / 180.0;
/// Most that is corrected in either direction, rad (assumed).
const CORRECTION_MAX_RAD: f64 = 0.12;
/// Speed of the mean stroke towards its set point, m/s (assumed).
const HEIGHT_RATE_M_S: f64 = 0.02;
/// A cylinder with less than this on it has a wheel that hardly touches, N (assumed).
const LOAD_LEAST_N: f64 = 5_000.0;
/// Speed at which a wheel that hardly touches reaches for the ground, m/s (assumed).
const REACH_RATE_M_S: f64 = 0.008;
/// Speed at which a wheel that carries again comes back, m/s (assumed).
const RETURN_RATE_M_S: f64 = 0.001;
/// Furthest reach, m (assumed).
const REACH_MAX_M: f64 = 0.06;
/// Smallest change of a target, m: one bit of the command frame, so that rounding never chatters.
const STEP_M: f64 = 0.002;

/// Integral levelling about a mean stroke.
#[derive(Clone, Copy, Debug)]
pub(super) struct Levelling {
    /// Wheel positions about the middle of the wheels, m: ahead, left.
    place_m: PerWheel<[f64; 2]>,
    /// Wheel height per stroke at the mean stroke.
    height_per_stroke: f64,
    stroke_max_m: f64,
    correction: Attitude,
    /// What each wheel reaches below the plane of the six.
    reach_m: PerWheel<f64>,
    mean_m: Option<f64>,
    targets_m: Option<PerWheel<f64>>,
}

impl Levelling {
    pub(super) fn new(machine: &Machine) -> Self {
        let axles = machine.wheels.axle_x_m;
        let middle = axles.iter().sum::<f64>() / 3.0;
        let half_track_m = machine.wheels.track_m / 2.0;
        Self {
            place_m: PerWheel::from_fn(|wheel| {
                let ahead = axles[wheel.axle() as usize] - middle;
                [ahead, half_track_m * Side::sign(wheel.side())]
            }),
            height_per_stroke: 1.0 / machine.linkage().at_stroke(MEAN_STROKE_M).force_ratio,
            stroke_max_m: machine.hydraulics.manual_stroke_max_m,
            correction: Attitude::default(),
            reach_m: PerWheel::splat(0.0),
            mean_m: None,
            targets_m: None,
        }
    }

    /// Target strokes after `dt_s` at what is observed, m.
    pub(super) fn step(&mut self, observation: &Observation, dt_s: f64) -> PerWheel<f64> {
        // The first answer keeps the arms where they stand on average.
        let mean = self.mean_m.unwrap_or_else(|| observation.stroke_m.mean());
        let reach = HEIGHT_RATE_M_S * dt_s;
        let mean = mean + (MEAN_STROKE_M - mean).clamp(-reach, reach);
        self.mean_m = Some(mean);
        let Attitude { roll_rad, pitch_rad } = observation.attitude;
        let before = self.correction;
        self.correction = Attitude {
            roll_rad: integrate(before.roll_rad, roll_rad, dt_s),
            pitch_rad: integrate(before.pitch_rad, pitch_rad, dt_s),
        };
        let outside = |s: &f64| !(0.0..=self.stroke_max_m).contains(s);
        if self.plane(mean).0.iter().any(outside) {
            // An arm is at its end: what more integral there is must not grow, only unwind.
            self.correction = Attitude {
                roll_rad: smaller(before.roll_rad, self.correction.roll_rad),
                pitch_rad: smaller(before.pitch_rad, self.correction.pitch_rad),
            };
        }
        // A wheel in the air spins away what its circuit should push with.
        self.reach_m = PerWheel::from_fn(|wheel| {
            let light = observation.load_n[wheel] < LOAD_LEAST_N;
            let rate_m_s = if light { REACH_RATE_M_S } else { -RETURN_RATE_M_S };
            (self.reach_m[wheel] + rate_m_s * dt_s).clamp(0.0, REACH_MAX_M)
        });
        let plane = self.plane(mean);
        let wanted = PerWheel::from_fn(|wheel| plane[wheel] + self.reach_m[wheel]);
        let previous = self.targets_m.unwrap_or(observation.stroke_m);
        let within = |strokes: PerWheel<f64>| strokes.map(|s| s.clamp(0.0, self.stroke_max_m));
        let (wanted, kept) = (within(wanted), within(previous));
        // All six move or none: six wheels on a stiff machine share a plane, and one that is left
        // some millimetres behind hangs in the air.
        let moved = wanted.iter().any(|(wheel, s)| (s - kept[wheel]).abs() >= STEP_M);
        let targets = if moved { wanted } else { kept };
        self.targets_m = Some(targets);
        targets
    }

    /// Right side high: the right arms come in, the left ones out. Nose high: the front arms in.
    fn plane(&self, mean_m: f64) -> PerWheel<f64> {
        let Attitude { roll_rad, pitch_rad } = self.correction;
        self.place_m.map(|[ahead_m, left_m]| {
            mean_m + (left_m * roll_rad - ahead_m * pitch_rad) / self.height_per_stroke
        })
    }
}

fn smaller(a: f64, b: f64) -> f64 {
    if a.abs() < b.abs() { a } else { b }
}

fn integrate(correction_rad: f64, error_rad: f64, dt_s: f64) -> f64 {
    let error = if error_rad.abs() < DEAD_BAND_RAD { 0.0 } else { error_rad };
    (correction_rad + RATE_S * error * dt_s).clamp(-CORRECTION_MAX_RAD, CORRECTION_MAX_RAD)
}
