//! The middle level: a PID from force error to valve opening, one an arm.

use crate::life::PERIOD_S;

/// A shut valve opens at this much, and an open one shuts below that much (assumed). Between them a
/// machine at rest leaves its valves alone: 1 % of opening is worth 0.8 kN, 0.13 degrees of roll or
/// 1 mm of height.
const OPENS: f64 = 0.010;
const SHUTS: f64 = 0.004;

/// Gains and bounds of the PID.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ForceGains {
    kp_n: f64,
    ki_n_s: f64,
    kd_s_n: f64,
    integral_max: f64,
    opening_max: f64,
}

impl ForceGains {
    pub(crate) const fn new(gains: &xt28_machine::Levelling) -> Self {
        Self {
            kp_n: gains.force_kp_n,
            ki_n_s: gains.force_ki_n_s,
            kd_s_n: gains.force_kd_s_n,
            integral_max: gains.integral_max,
            opening_max: gains.opening_max,
        }
    }
}

/// The controller of one arm.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct ForceControl {
    /// Integral part, as opening.
    integral: f64,
    /// Force of the last tick; none at the start, where nothing is known of its rate.
    last_n: Option<f64>,
    /// The valve is open.
    open: bool,
}

impl ForceControl {
    /// Nothing remembered.
    pub(crate) const RESTING: Self = Self { integral: 0.0, last_n: None, open: false };

    /// Valve opening, + extends, for an arm that carries `force_n` and should carry `request_n`.
    /// `free` gives the opening that is left of one at the arm's stroke.
    ///
    /// The derivative is on the measurement, so that a step of the request does not kick; its lead
    /// makes up for the lag of the pressure filter. The integral stands still while the valve does not
    /// follow it (shut, saturated or at a stroke end), unless that brings it back.
    pub(crate) fn step(
        &mut self,
        gains: &ForceGains,
        request_n: f64,
        force_n: f64,
        free: impl Fn(f64) -> f64,
    ) -> f64 {
        let error_n = request_n - force_n;
        let rate_n_s = self.last_n.map_or(0.0, |last_n| (force_n - last_n) / PERIOD_S);
        self.last_n = Some(force_n);
        let unbounded = gains.kp_n * error_n + self.integral - gains.kd_s_n * rate_n_s;
        let bounded = unbounded.clamp(-gains.opening_max, gains.opening_max);
        self.open = bounded.abs() >= if self.open { SHUTS } else { OPENS };
        let opening = if self.open { free(bounded) } else { 0.0 };
        let stuck = if self.open {
            opening != unbounded && error_n * unbounded > 0.0
        } else {
            error_n * self.integral >= 0.0
        };
        if !stuck {
            let integral = self.integral + gains.ki_n_s * error_n * PERIOD_S;
            self.integral = integral.clamp(-gains.integral_max, gains.integral_max);
        }
        opening
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const GAINS: ForceGains =
        ForceGains { kp_n: 1e-5, ki_n_s: 1e-6, kd_s_n: 1e-6, integral_max: 0.05, opening_max: 0.5 };

    fn anywhere(opening: f64) -> f64 {
        opening
    }

    #[test]
    fn each_part_has_its_gain_and_too_little_force_extends() {
        let mut control = ForceControl::default();
        assert_eq!(control.step(&GAINS, 60e3, 50e3, anywhere), 0.1);
        // 0.1 s later with the same error: 1e-6 * 10 kN * 0.1 s more, and no rate.
        let opening = (0..10).map(|_| control.step(&GAINS, 60e3, 50e3, anywhere)).last().unwrap();
        assert!((opening - 0.101).abs() < 1e-12, "{opening}");
        // The force grows by 200 N in a tick: 20 kN/s.
        let mut control = ForceControl::default();
        control.step(&GAINS, 50e3, 50e3, anywhere);
        let opening = control.step(&GAINS, 50.2e3, 50.2e3, anywhere);
        assert!((opening + 0.02).abs() < 1e-12, "{opening}");
    }

    #[test]
    fn a_step_of_the_request_does_not_kick() {
        let mut control = ForceControl::default();
        control.step(&GAINS, 50e3, 50e3, anywhere);
        assert_eq!(control.step(&GAINS, 60e3, 50e3, anywhere), 0.1);
    }

    #[test]
    fn an_arm_at_its_end_does_not_wind_up() {
        let mut control = ForceControl::default();
        let retract_only = |opening: f64| opening.min(0.0);
        for _ in 0..10_000 {
            assert_eq!(control.step(&GAINS, 60e3, 50e3, retract_only), 0.0);
        }
        assert_eq!(control.integral, 0.0);
        // Back at once when the error turns.
        assert_eq!(control.step(&GAINS, 48e3, 50e3, retract_only), -0.02);
    }

    #[test]
    fn small_errors_leave_the_valve_shut_and_the_integral_alone() {
        let mut control = ForceControl::default();
        let opening =
            |control: &mut ForceControl, error_n| control.step(&GAINS, error_n, 0.0, anywhere);
        for _ in 0..10_000 {
            assert_eq!(opening(&mut control, 900.0), 0.0);
        }
        assert!(opening(&mut control, 1_100.0) > 0.0);
        // Once open it goes on with less, and shuts where it would open again and again.
        assert!(opening(&mut control, 500.0) > 0.0);
        assert_eq!(opening(&mut control, 300.0), 0.0);
        assert_eq!(opening(&mut control, 500.0), 0.0);
    }

    #[test]
    fn a_saturated_valve_does_not_wind_up() {
        let mut control = ForceControl::default();
        for _ in 0..10_000 {
            assert_eq!(control.step(&GAINS, 200e3, 0.0, anywhere), 0.5);
        }
        assert_eq!(control.integral, 0.0);
    }

    proptest! {
        #[test]
        fn opening_and_integral_stay_within_their_bounds(
            steps in prop::collection::vec((-200e3..300e3_f64, -50e3..200e3_f64, any::<bool>()), 1..300)
        ) {
            let mut control = ForceControl::default();
            for (request_n, force_n, at_end) in steps {
                let free = |opening: f64| if at_end { opening.min(0.0) } else { opening };
                let opening = control.step(&GAINS, request_n, force_n, free);
                prop_assert!(opening.abs() <= GAINS.opening_max);
                prop_assert!(!at_end || opening <= 0.0);
                prop_assert!(control.integral.abs() <= GAINS.integral_max);
            }
        }

        /// However long the error lasted, the integral has unwound in the time it took to wind up.
        #[test]
        fn what_was_wound_up_unwinds(error_n in 1e3..20e3_f64, ticks in 1..3000_usize) {
            let mut control = ForceControl::default();
            for _ in 0..ticks {
                control.step(&GAINS, error_n, 0.0, anywhere);
            }
            for _ in 0..ticks {
                control.step(&GAINS, -error_n, 0.0, anywhere);
            }
            prop_assert!(control.integral <= 1e-12, "{}", control.integral);
        }
    }
}
