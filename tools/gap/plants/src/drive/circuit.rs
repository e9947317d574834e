//! A closed circuit: pump flow in, motor flow out, leakage between its sides, oil that gives.

use xt28_machine::Machine;

use crate::truth::DriveTruth;

/// Pressure of the low side, Pa.
const CHARGE_PA: f64 = 25.0e5;
/// Pressure over it at the largest wheel torque, where the relief valves open, Pa.
const RELIEF_PA: f64 = 350.0e5;

/// Pressure of the forward side over the other one.
///
/// C dp/dt = 3 D (wp - wm) - G p, with D the motors' displacement, wp the speed that the pump would
/// turn the motors at without leakage, wm the mean of theirs. So leakage G is what makes a circuit
/// give way: torque D p settles at (3 D² / G) (wp - wm).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Circuit {
    pressure_pa: f64,
}

impl Circuit {
    /// Goes on by `dt_s` s, exactly for a steady excess `over_rad_s` = wp - wm; torque on each wheel.
    pub(crate) fn step(
        &mut self,
        truth: &DriveTruth,
        machine: &Machine,
        over_rad_s: f64,
        dt_s: f64,
    ) -> f64 {
        let displacement_m3_rad = machine.wheels.torque_max_nm / RELIEF_PA;
        let leakage =
            3.0 * displacement_m3_rad * displacement_m3_rad / truth.slip_nms.max(f64::MIN_POSITIVE);
        let settled_pa = 3.0 * displacement_m3_rad * over_rad_s / leakage;
        let keep = (-dt_s / truth.settle_s).exp();
        self.pressure_pa = settled_pa + keep * (self.pressure_pa - settled_pa);
        self.pressure_pa = self.pressure_pa.clamp(-RELIEF_PA, RELIEF_PA);
        self.pressure_pa * displacement_m3_rad
    }

    /// Lets the pressure down to a share of itself.
    pub(crate) fn ease(&mut self, share: f64) {
        self.pressure_pa *= share;
    }

    /// Whether a relief valve is open.
    pub(crate) fn is_relieved(&self) -> bool {
        self.pressure_pa.abs() >= RELIEF_PA
    }

    /// Pressures of sides A (reverse) and B (forward), Pa.
    pub(crate) fn sides_pa(&self) -> [f64; 2] {
        [CHARGE_PA + (-self.pressure_pa).max(0.0), CHARGE_PA + self.pressure_pa.max(0.0)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::truth::Truth;

    #[test]
    fn pressure_and_torque_go_together_up_to_the_relief() {
        let truth = Truth::nominal();
        let mut circuit = Circuit::default();
        let mut settle =
            |over| (0..500).map(|_| circuit.step(&truth.drive, &truth.machine, over, 0.002)).last();
        assert!((settle(1.0).unwrap() - 1e4).abs() < 1e-3);
        assert!((settle(9.0).unwrap() - 2e4).abs() < 1e-3);
        assert!((settle(-9.0).unwrap() + 2e4).abs() < 1e-3);
        assert_eq!(circuit.sides_pa(), [CHARGE_PA + RELIEF_PA, CHARGE_PA]);
    }
}
