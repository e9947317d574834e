//! Throttle to displacements: pumps first, then motors (facts 4.4).

use xt28_machine::Drive;

use crate::life::PERIOD_S;

/// Demand at which the pumps are full and the motors begin to give way: a third.
const SEQUENCE_POINT: f64 = 1.0 / 3.0;

/// Displacements that a demand asks for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Displacements {
    /// Of both pumps, -1 (reverse) to 1.
    pub(crate) pump: f64,
    /// Of all motors, 1/3 to 1.
    pub(crate) motor: f64,
}

/// Displacements for `demand` -1 to 1: their ratio, and with it the wheel speed, is three times the
/// demand.
pub(crate) fn displacements(demand: f64) -> Displacements {
    let demand = demand.clamp(-1.0, 1.0);
    if demand.abs() > SEQUENCE_POINT {
        Displacements { pump: demand.signum(), motor: SEQUENCE_POINT / demand.abs() }
    } else {
        Displacements { pump: demand / SEQUENCE_POINT, motor: 1.0 }
    }
}

/// The throttle's first-order lag.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ThrottleLag {
    share: f64,
    demand: f64,
}

impl ThrottleLag {
    /// At rest, with the machine's time constant; exact for a target that holds over a period.
    pub(crate) fn new(drive: &Drive) -> Self {
        let share = 1.0 - (-PERIOD_S / drive.speed_time_constant_s).exp();
        Self { share, demand: 0.0 }
    }

    /// Demand one period on, towards `throttle`.
    pub(crate) fn step(&mut self, throttle: f64) -> f64 {
        self.demand += self.share * (throttle - self.demand);
        self.demand
    }

    /// To rest at once.
    pub(crate) const fn reset(&mut self) {
        self.demand = 0.0;
    }
}

#[cfg(test)]
mod tests {
    use xt28_machine::Machine;

    use super::*;

    #[test]
    fn the_ratio_is_three_times_the_demand() {
        for step in -100..=100 {
            let demand = f64::from(step) / 100.0;
            let d = displacements(demand);
            assert!((d.pump / d.motor - 3.0 * demand).abs() < 1e-12, "{demand}: {d:?}");
        }
        assert_eq!(displacements(-1.0), Displacements { pump: -1.0, motor: 1.0 / 3.0 });
        assert_eq!(displacements(0.2).motor, 1.0);
    }

    #[test]
    fn a_step_is_at_63_percent_after_the_time_constant() {
        let mut lag = ThrottleLag::new(&Machine::xt28().drive);
        let demand = (0..15).map(|_| lag.step(1.0)).last().unwrap();
        assert!((demand - (1.0 - (-1.0_f64).exp())).abs() < 1e-12, "{demand}");
        lag.reset();
        assert_eq!(lag.step(0.0), 0.0);
    }
}
