//! Manual position of an arm: a PI on whole millimetres.

use xt28_machine::Hydraulics;

use super::TICK_S;

/// The controller of one arm.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Position {
    sum_mm_s: f64,
}

impl Position {
    /// One tick; opening, extending > 0. `kp` and `ki` are over the published gains.
    pub(super) fn step(&mut self, law: &Hydraulics, [kp, ki]: [f64; 2], error_mm: f64) -> f64 {
        let limit = law.manual_windup;
        self.sum_mm_s = (self.sum_mm_s + error_mm * TICK_S).clamp(-limit, limit);
        let opening =
            kp * law.manual_kp_per_mm * error_mm + ki * law.manual_ki_per_mm_s * self.sum_mm_s;
        opening.clamp(-law.manual_opening_max, law.manual_opening_max)
    }
}

#[cfg(test)]
mod tests {
    use xt28_machine::Machine;

    use super::*;

    #[test]
    fn proportional_at_once_and_the_integral_up_to_its_limit() {
        let law = Machine::xt28().hydraulics;
        let mut position = Position::default();
        assert!((position.step(&law, [1.0; 2], 10.0) - 0.04001).abs() < 1e-12);
        let late = (0..5000).map(|_| position.step(&law, [1.0; 2], 10.0)).last().unwrap();
        assert!((late - 0.05).abs() < 1e-12);
        assert_eq!(position.step(&law, [1.0; 2], 500.0), 0.30);
        assert!((Position::default().step(&law, [0.5, 0.0], 10.0) - 0.02).abs() < 1e-12);
    }
}
