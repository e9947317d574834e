//! `engine-droop`: the engine's speed falls under load, or its power is short.

use crate::effects::{Block, Effect, Parameter, Slot};

/// How the engine gives way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EngineDroop {
    /// Share of speed lost per watt of hydraulic power, 1/W.
    pub droop_per_w: f64,
    /// Power there is over nominal power.
    pub power_factor: f64,
}

impl Default for EngineDroop {
    fn default() -> Self {
        Self { droop_per_w: 0.0, power_factor: 1.0 }
    }
}

impl EngineDroop {
    /// Share of the governor's speed that is left under `power_w`, not below a half: it would stall.
    #[must_use]
    pub fn speed_share(&self, power_w: f64) -> f64 {
        (1.0 - self.droop_per_w * power_w.max(0.0)).max(0.5)
    }
}

/// A governor with proportional action only, and an engine that is not what its plate says.
pub(in crate::effects) const EFFECT: Effect = Effect {
    name: "engine-droop",
    block: Block::Drive,
    meaning: "speed falls or power is short under load",
    source: "governor droop of diesel engines is 3 to 10 % from idle to full load (textbook)",
    parameters: &[
        Parameter {
            name: "droop_per_w",
            neutral: 0.0,
            tolerance: 5.0e-7,
            range: [0.0, 1.0e-4],
            acts_alone: true,
            slot: Slot::Whole(|effects| &mut effects.drive.engine_droop.droop_per_w),
        },
        Parameter {
            name: "power_factor",
            neutral: 1.0,
            tolerance: 0.05,
            range: [0.005, 2.0],
            acts_alone: true,
            slot: Slot::Whole(|effects| &mut effects.drive.engine_droop.power_factor),
        },
    ],
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn speed_falls_with_power_and_never_to_a_stall() {
        let droop = EngineDroop { droop_per_w: 5.0e-6, power_factor: 1.0 };
        assert!((droop.speed_share(20.0e3) - 0.9).abs() < 1e-12);
        assert_eq!(droop.speed_share(1.0e9), 0.5);
        assert_eq!(droop.speed_share(-1.0e4), 1.0);
        assert_eq!(EngineDroop::default().speed_share(1.0e5), 1.0);
    }
}
