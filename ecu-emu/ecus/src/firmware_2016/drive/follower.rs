//! The follower: PI that takes one joint to the other's angle, awake above half a degree (facts 4.6).

use super::steering_valve::{REAR_MA, REST_MA, written};
use crate::firmware_2016::Quirks;
use crate::firmware_2016::whole::cut;
use crate::life::PERIOD_S;

/// mA parts per mille for each 0.01 deg, and for each 0.01 deg s.
const KP: f64 = 0.40;
const KI: f64 = 0.05;
/// Below this error nothing is integrated, above the other it wakes, 0.01 deg.
const INTEGRAL_FROM: i32 = 10;
const WAKE_AT: i32 = 50;
/// Greatest I part, and the integral that gives it.
const I_MAX: i32 = 500;
const INTEGRAL_MAX: f64 = 10_000.0;
/// Speed at which the P part comes in, counts.
const GATE_COUNTS: i32 = 50;

/// State and integral.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Follower {
    /// 0.01 deg s.
    integral: f64,
    /// Asleep, or awake towards A (error above zero) or B.
    awake: Option<bool>,
    /// Its own currents `[A, B]` as it last wrote them, mA.
    ma: [i32; 2],
}

impl Follower {
    /// One tick at an error (leader less follower) of so many 0.01 deg: currents `[A, B]`, mA. In its
    /// dead-band the firmware does not rewrite them.
    pub(super) fn step(&mut self, error: i32, mean_count: i32, quirks: Quirks) -> [i32; 2] {
        match self.written(error, mean_count, quirks) {
            Some(ma) => self.ma = ma,
            None if quirks.follower_holds_current_in_dead_band => {}
            None => self.ma = [0; 2],
        }
        self.ma
    }

    /// What it writes in this tick; in its dead-band nothing.
    fn written(&mut self, error: i32, mean_count: i32, quirks: Quirks) -> Option<[i32; 2]> {
        self.integral = if error.abs() > INTEGRAL_FROM {
            self.integral + PERIOD_S * f64::from(error)
        } else {
            0.0
        };
        match self.awake {
            None => {
                self.integral = 0.0;
                self.awake = (error.abs() > WAKE_AT).then_some(error > 0);
                None
            }
            Some(towards_a) if (error > 0) != towards_a => {
                self.awake = None;
                None
            }
            Some(towards_a) => {
                let sum = self.proportional(error, mean_count, quirks) + self.integral_part();
                let toward = if towards_a { sum } else { -sum };
                let above_ma = toward * (REAR_MA - REST_MA) / 1000;
                let most_ma =
                    if quirks.follower_current_unlimited { i32::MAX } else { REAR_MA - REST_MA };
                Some(written(above_ma.min(most_ma), towards_a))
            }
        }
    }

    /// The integral is dropped.
    pub(super) const fn forget(&mut self) {
        self.integral = 0.0;
    }

    fn proportional(&self, error: i32, mean_count: i32, quirks: Quirks) -> i32 {
        let speed = mean_count.abs();
        let gate = if quirks.follower_gate_is_a_step {
            f64::from((speed / GATE_COUNTS).min(1))
        } else {
            (f64::from(speed) / f64::from(GATE_COUNTS)).min(1.0)
        };
        cut(KP * f64::from(error) * gate)
    }

    fn integral_part(&mut self) -> i32 {
        let part = cut(KI * self.integral);
        if part.abs() <= I_MAX {
            return part;
        }
        self.integral = INTEGRAL_MAX.copysign(self.integral);
        cut(KI * self.integral)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FAST: i32 = 100;

    fn awake(error: i32, quirks: Quirks) -> Follower {
        let mut follower = Follower::default();
        follower.step(error, FAST, quirks);
        follower
    }

    #[test]
    fn it_wakes_above_half_a_degree_and_sleeps_when_the_error_turns() {
        let quirks = Quirks::none();
        let mut follower = Follower::default();
        assert_eq!(follower.step(50, FAST, quirks), [0, 0]);
        assert_eq!(follower.step(51, FAST, quirks), [0, 0], "awake from the next tick");
        // P = 400 of 1000 per deg; 0.4 * 500 = 200, 200 * 85 / 1000 = 17 mA.
        assert_eq!(follower.step(500, FAST, quirks), [432, 0]);
        assert_eq!(follower.step(-1, FAST, quirks), [0, 0]);
        assert_eq!(awake(-500, quirks).step(-500, FAST, quirks), [0, 432]);
    }

    /// Facts 4.6: below 50 counts there is no P part at all.
    #[test]
    fn the_gate_is_a_step_where_a_ramp_was_meant() {
        let at = |count, quirks| awake(500, quirks).step(500, count, quirks)[0];
        let firmware = Quirks::firmware();
        assert_eq!([at(49, firmware), at(50, firmware)], [0, 432]);
        assert_eq!([at(25, Quirks::none()), at(50, Quirks::none())], [423, 432]);
    }

    /// A current from the I part stays on when the error turns in one tick.
    #[test]
    fn in_the_dead_band_the_last_current_stays() {
        let mut firmware = awake(500, Quirks::firmware());
        let last = (0..1000).map(|_| firmware.step(500, FAST, Quirks::firmware())).last().unwrap();
        assert!(last[0] > REST_MA, "{last:?}");
        assert_eq!(firmware.step(-5, FAST, Quirks::firmware()), last);
        let mut other = awake(500, Quirks::none());
        assert_eq!(other.step(-5, FAST, Quirks::none()), [0, 0]);
    }

    /// Facts 4.6: up to a tenth of a degree nothing is integrated, and what was is dropped. 100 ticks of 5 degrees
    /// are an I part of 25; with the P part of 4 that is 2 mA, and 4 alone are none.
    #[test]
    fn a_tenth_of_a_degree_drops_the_integral() {
        let quirks = Quirks::none();
        let mut follower = awake(500, quirks);
        (0..100).for_each(|_| _ = follower.step(500, FAST, quirks));
        assert_eq!(follower.step(11, FAST, quirks), [417, 0]);
        assert_eq!(follower.step(10, FAST, quirks), [0, 0]);
        assert_eq!(follower.step(11, FAST, quirks), [0, 0]);
    }

    /// P of 2000 and I of 500 together: 212 mA above rest, or the 85 of the rear valve.
    #[test]
    fn its_current_may_exceed_the_rear_valve_s() {
        let end = |quirks| {
            let mut follower = awake(5000, quirks);
            (0..1000).map(|_| follower.step(5000, FAST, quirks)).last().unwrap()
        };
        assert_eq!(end(Quirks::firmware()), [627, 0]);
        assert_eq!(end(Quirks::none()), [500, 0]);
    }
}
