//! `standstill-drag`: the motors hold their wheels while the pumps are idle.

use crate::effects::{Block, Effect, Parameter, Slot};

/// Speed asked of a wheel above which its motor lets go, rad/s (assumed: 1 cm/s at the rim).
const LETS_GO_RAD_S: f64 = 0.014;

/// What holds a wheel at rest.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StandstillDrag {
    /// Largest torque, Nm.
    pub torque_nm: f64,
}

impl StandstillDrag {
    /// Torque that holds a wheel of which `target_rad_s` is asked, Nm.
    #[must_use]
    pub fn holds_nm(&self, target_rad_s: f64) -> f64 {
        self.torque_nm * (1.0 - target_rad_s.abs() / LETS_GO_RAD_S).max(0.0)
    }
}

/// An arm that swings at standstill wants its wheel to roll. A wheel that is held pinches between its
/// neighbours and the ground, and the cylinder shows a vertical force that is none.
pub(in crate::effects) const EFFECT: Effect = Effect {
    name: "standstill-drag",
    block: Block::Drive,
    meaning: "wheel motors hold while idle: wheels pinch, cylinders show false vertical force",
    source: "paper, calibration: oil in idle motors resists rotation; torque assumed",
    parameters: &[Parameter {
        name: "torque_nm",
        neutral: 0.0,
        tolerance: 200.0,
        range: [0.0, 20_000.0],
        acts_alone: true,
        slot: Slot::PerWheel(|effects, wheel| &mut effects.wheels[wheel].standstill_drag.torque_nm),
    }],
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_holds_at_rest_and_lets_go_once_speed_is_asked_for() {
        let drag = StandstillDrag { torque_nm: 3000.0 };
        assert_eq!(drag.holds_nm(0.0), 3000.0);
        assert_eq!(drag.holds_nm(-0.1), 0.0);
        assert_eq!(StandstillDrag::default().holds_nm(0.0), 0.0);
    }
}
