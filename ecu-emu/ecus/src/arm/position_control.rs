//! Manual position: one PI per arm, from stroke error to valve opening.

use xt28_machine::Hydraulics;

use crate::life::PERIOD_S;

/// Gains of the manual position controller (paper; facts 6.1).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PositionGains {
    /// Valve opening per stroke error, 1/mm.
    pub kp_per_mm: f64,
    /// Valve opening per stroke error and second, 1/(mm s).
    pub ki_per_mm_s: f64,
    /// Limit of the error integral, mm s; at least 0.
    pub windup_mm_s: f64,
    /// Most that the manual modes open a valve, 0 to 1.
    pub opening_max: f64,
}

impl PositionGains {
    /// The machine's own.
    #[must_use]
    pub const fn new(hydraulics: &Hydraulics) -> Self {
        Self {
            kp_per_mm: hydraulics.manual_kp_per_mm,
            ki_per_mm_s: hydraulics.manual_ki_per_mm_s,
            windup_mm_s: hydraulics.manual_windup.abs(),
            opening_max: hydraulics.manual_opening_max.abs(),
        }
    }

    /// `opening` within what manual modes may open, -0.30 to 0.30 (paper).
    pub(crate) fn bounded(&self, opening: f64) -> f64 {
        opening.max(-self.opening_max).min(self.opening_max)
    }
}

/// The controller of one arm.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct PositionControl {
    integral_mm_s: f64,
}

impl PositionControl {
    /// Valve opening, + extends, for an arm at `stroke_mm` that should be at `target_mm`: the gains
    /// are parallel, and the limit is on the integral itself.
    pub(crate) fn step(&mut self, gains: &PositionGains, target_mm: f64, stroke_mm: f64) -> f64 {
        let error_mm = target_mm - stroke_mm;
        let integral_mm_s = self.integral_mm_s + error_mm * PERIOD_S;
        self.integral_mm_s = integral_mm_s.max(-gains.windup_mm_s).min(gains.windup_mm_s);
        gains.bounded(gains.kp_per_mm * error_mm + gains.ki_per_mm_s * self.integral_mm_s)
    }

    /// Forgets the integral, for an arm that is held or not controlled.
    pub(crate) const fn reset(&mut self) {
        self.integral_mm_s = 0.0;
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use xt28_machine::Machine;

    use super::*;

    fn gains() -> PositionGains {
        PositionGains::new(&Machine::xt28().hydraulics)
    }

    #[test]
    fn the_paper_s_figures_are_met() {
        let gains = gains();
        // 75 mm of error open the valve to its cap.
        assert_eq!(PositionControl::default().step(&gains, 250.0, 175.0), 0.30);
        assert_eq!(PositionControl::default().step(&gains, 0.0, 100.0), -0.30);
        let opening = PositionControl::default().step(&gains, 210.0, 200.0);
        assert!((opening - (0.04 + 0.0001 * 0.1)).abs() < 1e-15, "{opening}");
    }

    #[test]
    fn the_integral_winds_up_to_one_percent_of_opening() {
        let (gains, mut control) = (gains(), PositionControl::default());
        for _ in 0..10_000 {
            control.step(&gains, 200.0, 100.0);
        }
        assert!((control.step(&gains, 200.0, 200.0) - 0.01).abs() < 1e-12);
        control.reset();
        assert_eq!(control.step(&gains, 200.0, 200.0), 0.0);
    }

    proptest! {
        #[test]
        fn opening_and_integral_stay_within_their_bounds(
            steps in prop::collection::vec((0.0..500.0_f64, 0.0..521.0_f64), 1..400)
        ) {
            let (gains, mut control) = (gains(), PositionControl::default());
            for (target_mm, stroke_mm) in steps {
                let opening = control.step(&gains, target_mm, stroke_mm);
                prop_assert!(opening.abs() <= gains.opening_max);
                prop_assert!(control.integral_mm_s.abs() <= gains.windup_mm_s);
            }
        }

        /// The windup limit is worth 2.5 mm of error: so far beyond its target an arm turns back, no
        /// matter for how long it was held away from it.
        #[test]
        fn an_arm_that_was_held_turns_back_2_5_mm_beyond(
            error_mm in 10.0..250.0_f64,
            ticks in 1..20_000_usize,
        ) {
            let (gains, mut control) = (gains(), PositionControl::default());
            for _ in 0..ticks {
                control.step(&gains, 250.0, 250.0 - error_mm);
            }
            prop_assert!(control.step(&gains, 250.0, 252.6) < 0.0);
        }
    }
}
