//! Keeping the front frame level with the arms, gently.

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
        let wanted = self.strokes(mean);
        if wanted.0.iter().any(|s| !(0.0..=self.stroke_max_m).contains(s)) {
            // An arm is at its end: more integral would only have to be unwound later.
            self.correction = before;
        }
        let previous = self.targets_m.unwrap_or(observation.stroke_m);
        let targets = PerWheel::from_fn(|wheel| {
            let wanted = wanted[wheel].clamp(0.0, self.stroke_max_m);
            let kept = previous[wheel].clamp(0.0, self.stroke_max_m);
            if (wanted - kept).abs() < STEP_M { kept } else { wanted }
        });
        self.targets_m = Some(targets);
        targets
    }

    /// Right side high: the right arms come in, the left ones out. Nose high: the front arms in.
    fn strokes(&self, mean_m: f64) -> PerWheel<f64> {
        let Attitude { roll_rad, pitch_rad } = self.correction;
        self.place_m.map(|[ahead_m, left_m]| {
            mean_m + (left_m * roll_rad - ahead_m * pitch_rad) / self.height_per_stroke
        })
    }
}

fn integrate(correction_rad: f64, error_rad: f64, dt_s: f64) -> f64 {
    let error = if error_rad.abs() < DEAD_BAND_RAD { 0.0 } else { error_rad };
    (correction_rad + RATE_S * error * dt_s).clamp(-CORRECTION_MAX_RAD, CORRECTION_MAX_RAD)
}
