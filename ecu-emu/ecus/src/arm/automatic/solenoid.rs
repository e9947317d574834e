//! The lowest level: solenoid currents under the output stage's own controller.
//!
//! The setpoint has the valve's dead-band and saturation in it (`pins::valve_ma`); the stage answers
//! as a lag of first order, its dither averaged out. The manual modes do not pass here: the paper's
//! nominal actuator is immediate, and recorded runs of them show the setpoint itself.

use crate::life::PERIOD_S;

/// A current this far below its setpoint, mA, counts as there.
const SETTLED_MA: f64 = 0.5;

/// Both solenoids of one valve.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Solenoids {
    current_ma: [f64; 2],
}

/// Share of the way to its setpoint that a current goes in a tick, for `time_constant_s` (0: all).
pub(crate) fn share(time_constant_s: f64) -> f64 {
    1.0 - (-PERIOD_S / time_constant_s.max(f64::MIN_POSITIVE)).exp()
}

impl Solenoids {
    /// No current.
    pub(crate) const RESTING: Self = Self { current_ma: [0.0; 2] };

    /// Currents one tick on.
    pub(crate) fn step(&mut self, wanted_ma: [f64; 2], share: f64) -> [f64; 2] {
        for (current_ma, wanted_ma) in self.current_ma.iter_mut().zip(wanted_ma) {
            let off_ma = wanted_ma - *current_ma;
            *current_ma += if off_ma.abs() < SETTLED_MA { off_ma } else { share * off_ma };
        }
        self.current_ma
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::pins;

    #[test]
    fn a_step_is_at_63_percent_after_the_time_constant_and_arrives() {
        let (mut solenoids, share) = (Solenoids::default(), share(0.05));
        let after: Vec<f64> = (0..60).map(|_| solenoids.step([0.0, 500.0], share)[1]).collect();
        assert!((after[4] - 500.0 * (1.0 - (-1.0_f64).exp())).abs() < 1e-9, "{}", after[4]);
        assert_eq!(after[59], 500.0);
    }

    #[test]
    fn without_a_time_constant_the_current_is_there_at_once() {
        assert_eq!(share(0.0), 1.0);
    }

    /// 8 ms leave less than a third after a tick: the valve is shut below 400 mA at once.
    #[test]
    fn a_current_switched_off_shuts_the_valve_within_a_tick() {
        let (mut solenoids, share) = (Solenoids::default(), share(0.008));
        for _ in 0..20 {
            solenoids.step(pins::valve_ma(1.0), share);
        }
        let [a, b] = solenoids.step([0.0; 2], share);
        assert_eq!(pins::valve_opening(a, b), 0.0);
    }

    proptest! {
        #[test]
        fn currents_stay_between_none_and_full(
            openings in prop::collection::vec(-3.0..3.0_f64, 1..200),
            time_constant_s in 0.0..0.2_f64,
        ) {
            let (mut solenoids, share) = (Solenoids::default(), share(time_constant_s));
            for opening in openings {
                for current_ma in solenoids.step(pins::valve_ma(opening), share) {
                    prop_assert!((0.0..=800.0).contains(&current_ma), "{current_ma}");
                }
            }
        }
    }
}
