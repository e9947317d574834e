//! What a gateway is set to.

use xt28_machine::Machine;
use xt28_safety::Limits;
use xt28_ubx::Geodetic;

use crate::frames;
use crate::{Fix, Quality};

/// Settings of one gateway.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GatewayConfig {
    /// Origin of the local frame.
    pub origin: Geodetic,
    /// What the safety kernel holds everything to.
    pub limits: Limits,
    /// The worst kind of fix that the machine is driven by.
    pub fix_least: Fix,
    /// The worst horizontal accuracy that it is driven by, m.
    pub accuracy_max_m: f64,
    /// Arm by itself, once, as soon as all streams are alive. Otherwise [`crate::Gateway::order`].
    pub arm_at_start: bool,
}

impl GatewayConfig {
    /// The defaults for a machine: the bench's origin, the kernel's limits with the machine's own
    /// ranges as far as the wire can say them, armed at the start; driven by carrier phase to half a
    /// metre (assumed: what `goto` steers by and ends with is 0.3 m).
    #[must_use]
    pub fn new(machine: &Machine) -> Self {
        let (hydraulics, joint) = (&machine.hydraulics, &machine.articulation);
        let limits = Limits {
            stroke_max_m: hydraulics.manual_stroke_max_m.min(frames::STROKE_MAX_M),
            opening_max: hydraulics.manual_opening_max.min(1.0),
            angle_max_rad: joint.angle_max_deg.min(frames::ANGLE_MAX_DEG).to_radians(),
            ..Limits::XT28
        };
        Self {
            origin: Geodetic::BENCH_ORIGIN,
            limits,
            fix_least: Fix::RtkFloat,
            accuracy_max_m: 0.5,
            arm_at_start: true,
        }
    }

    /// Whether a fix of this quality is one to drive by.
    pub(crate) fn may_drive_by(&self, quality: &Quality) -> bool {
        quality.fix > Fix::None
            && quality.fix >= self.fix_least
            && quality.accuracy_horizontal_m <= self.accuracy_max_m
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_machine_that_can_more_than_the_wire_says_is_held_to_the_wire() {
        let mut machine = Machine::xt28();
        machine.hydraulics.manual_stroke_max_m = 0.6;
        machine.articulation.angle_max_deg = 40.0;
        let limits = GatewayConfig::new(&machine).limits;
        assert_eq!(limits.stroke_max_m, frames::STROKE_MAX_M);
        assert_eq!(limits.angle_max_rad, frames::ANGLE_MAX_DEG.to_radians());
    }

    #[test]
    fn nothing_is_driven_by_without_a_fix_however_little_is_asked() {
        let config = GatewayConfig { fix_least: Fix::None, ..GatewayConfig::new(&Machine::xt28()) };
        assert!(!config.may_drive_by(&Quality::default()));
        assert!(config.may_drive_by(&Quality { fix: Fix::Single, ..Quality::default() }));
    }
}
