//! Roll and pitch from the inertial unit: the firmware's complementary filter (facts 5).

use core::time::Duration;

use xt28_machine::SimTime;

use crate::life::PERIOD_S;
use crate::pins::ImuReading;

/// Share of the turned angle that a tick keeps: 2 s for roll, 1 s for pitch.
const ROLL_KEEP: f64 = 0.995;
const PITCH_KEEP: f64 = 0.99;
/// As far as the attitude's frame goes, thousandths of a degree: a machine that tumbles, or a unit that
/// says so, ends there.
const ANGLE_MAX_MDEG: f64 = 327_670.0;
/// Without one of the two frames for this long the unit is lost (facts 3.9).
const LOST_AFTER: Duration = Duration::from_millis(50);

/// The filter and the newest sample.
#[derive(Clone, Debug, Default)]
pub(crate) struct AttitudeFilter {
    roll_mdeg: f64,
    pitch_mdeg: f64,
    /// Growth of pitch and roll, deg/s.
    rate_deg_s: [f64; 2],
    acceleration: Option<[f64; 3]>,
    rate_at: Option<SimTime>,
    acceleration_at: Option<SimTime>,
    /// The first acceleration has set the angles: the machine stood before. (The firmware starts
    /// level, and leans over within seconds.)
    started: bool,
}

impl AttitudeFilter {
    /// Takes a frame of the unit.
    pub(crate) const fn on_reading(&mut self, now: SimTime, reading: ImuReading) {
        match reading {
            ImuReading::Rate { pitch_deg_s, roll_deg_s } => {
                self.rate_deg_s = [pitch_deg_s, roll_deg_s];
                self.rate_at = Some(now);
            }
            ImuReading::Acceleration(acceleration) => {
                self.acceleration = Some(acceleration);
                self.acceleration_at = Some(now);
            }
        }
    }

    /// One tick. The angles are kept in whole thousandths of a degree, cut off: a still angle stops
    /// up to 0.2 deg (roll) or 0.1 deg (pitch) short.
    pub(crate) fn step(&mut self) {
        let Some([pitch_mdeg, roll_mdeg]) = self.acceleration.and_then(lean_mdeg) else {
            return;
        };
        if !self.started {
            self.started = true;
            (self.roll_mdeg, self.pitch_mdeg) = (roll_mdeg.trunc(), pitch_mdeg.trunc());
            return;
        }
        let [pitch_step, roll_step] = self.rate_deg_s.map(|rate| rate * 1e3 * PERIOD_S);
        let mix = |angle: f64, step: f64, lean: f64, keep: f64| {
            let mixed = (keep * (angle + step) + (1.0 - keep) * lean).trunc();
            mixed.clamp(-ANGLE_MAX_MDEG, ANGLE_MAX_MDEG)
        };
        self.roll_mdeg = mix(self.roll_mdeg, roll_step, roll_mdeg, ROLL_KEEP);
        self.pitch_mdeg = mix(self.pitch_mdeg, pitch_step, pitch_mdeg, PITCH_KEEP);
    }

    /// Pitch and roll, deg.
    pub(crate) fn angles_deg(&self) -> [f64; 2] {
        [self.pitch_mdeg, self.roll_mdeg].map(|mdeg| mdeg * 1e-3)
    }

    /// Newest rates of pitch and roll, deg/s.
    pub(crate) const fn rates_deg_s(&self) -> [f64; 2] {
        self.rate_deg_s
    }

    /// Newest acceleration along X, Y, Z, counts.
    pub(crate) fn acceleration(&self) -> [f64; 3] {
        self.acceleration.unwrap_or_default()
    }

    /// True when one of the two frames is missing.
    pub(crate) fn is_lost(&self, now: SimTime) -> bool {
        [self.rate_at, self.acceleration_at]
            .into_iter()
            .any(|at| at.is_none_or(|at| now.since(at) > LOST_AFTER))
    }
}

/// Pitch and roll that the direction of gravity shows, thousandths of a degree. `None` where the
/// firmware would divide nothing by nothing.
fn lean_mdeg([x, y, z]: [f64; 3]) -> Option<[f64; 2]> {
    let mdeg = |ratio: f64| ratio.atan().to_degrees() * 1e3;
    (z != 0.0).then(|| [-mdeg(y / z), mdeg(x / z)])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn still(filter: &mut AttitudeFilter, acceleration: [f64; 3]) {
        filter.on_reading(SimTime::ZERO, ImuReading::Acceleration(acceleration));
        filter.step();
    }

    #[test]
    fn the_first_sample_sets_the_angles() {
        let mut filter = AttitudeFilter::default();
        still(&mut filter, [100.0, -50.0, 1000.0]);
        let [pitch_deg, roll_deg] = filter.angles_deg();
        assert!((pitch_deg - 0.05_f64.atan().to_degrees()).abs() < 1e-3);
        assert!((roll_deg - 0.1_f64.atan().to_degrees()).abs() < 1e-3);
    }

    /// Facts 5: truncation leaves roll up to 0.20 deg and pitch up to 0.10 deg short.
    #[test]
    fn a_new_lean_is_reached_but_for_the_truncation() {
        let mut filter = AttitudeFilter::default();
        still(&mut filter, [0.0, 0.0, 1000.0]);
        for _ in 0..5000 {
            still(&mut filter, [100.0, -100.0, 1000.0]);
        }
        let lean_deg = 0.1_f64.atan().to_degrees();
        let [pitch_deg, roll_deg] = filter.angles_deg();
        assert!((0.15..=0.2001).contains(&(lean_deg - roll_deg)), "{roll_deg}");
        assert!((0.05..=0.1001).contains(&(lean_deg - pitch_deg)), "{pitch_deg}");
    }

    #[test]
    fn a_turn_is_followed_at_once() {
        let mut filter = AttitudeFilter::default();
        still(&mut filter, [0.0, 0.0, 1000.0]);
        let rate = ImuReading::Rate { pitch_deg_s: -10.0, roll_deg_s: 10.0 };
        filter.on_reading(SimTime::ZERO, rate);
        filter.step();
        assert_eq!(filter.angles_deg(), [-0.099, 0.099]);
    }

    #[test]
    fn a_tumble_ends_where_the_frame_does() {
        let mut filter = AttitudeFilter::default();
        still(&mut filter, [0.0, 0.0, 1000.0]);
        let rate = ImuReading::Rate { pitch_deg_s: -655.0, roll_deg_s: 655.0 };
        filter.on_reading(SimTime::ZERO, rate);
        (0..1000).for_each(|_| filter.step());
        assert_eq!(filter.angles_deg(), [-327.67, 327.67]);
    }

    #[test]
    fn weightlessness_and_silence_change_nothing() {
        let mut filter = AttitudeFilter::default();
        filter.step();
        still(&mut filter, [0.0; 3]);
        assert_eq!(filter.angles_deg(), [0.0; 2]);
        assert!(filter.is_lost(SimTime::ZERO), "rates never came");
    }
}
