//! The diesel engine: a flywheel on a governor that gives way under load.

use xt28_machine::Machine;

use crate::truth::DriveTruth;

/// Time in which the governor brings the flywheel to the speed that the load leaves, s (assumed).
const GOVERNOR_S: f64 = 0.3;
/// Power at which the droop is stated, W.
const STATED_AT_W: f64 = 2.0e4;
/// The least speed, share: it would stall below.
const LEAST_SHARE: f64 = 0.5;

/// Speed of the engine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Engine {
    speed_rpm: f64,
}

impl Engine {
    /// At its governed speed.
    pub(crate) fn idle(machine: &Machine) -> Self {
        Self { speed_rpm: machine.drive.engine_speed_rpm }
    }

    /// Goes on by `dt_s` s under `power_w`.
    pub(crate) fn step(&mut self, truth: &DriveTruth, machine: &Machine, power_w: f64, dt_s: f64) {
        let lost = truth.droop * power_w.max(0.0) / STATED_AT_W;
        let goal = machine.drive.engine_speed_rpm * (1.0 - lost).max(LEAST_SHARE);
        self.speed_rpm = goal + (self.speed_rpm - goal) * (-dt_s / GOVERNOR_S).exp();
    }

    /// Speed, rpm.
    pub(crate) fn speed_rpm(&self) -> f64 {
        self.speed_rpm
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::truth::Truth;

    #[test]
    fn speed_falls_by_the_droop_and_no_further_than_half() {
        let mut truth = Truth::nominal();
        truth.drive.droop = 0.2;
        let mut engine = Engine::idle(&truth.machine);
        let mut settle = |power_w| {
            for _ in 0..2000 {
                engine.step(&truth.drive, &truth.machine, power_w, 0.002);
            }
            engine.speed_rpm()
        };
        assert!((settle(1e4) - 1080.0).abs() < 0.1);
        assert!((settle(1e6) - 600.0).abs() < 0.1);
        assert!((settle(0.0) - 1200.0).abs() < 0.1);
    }
}
