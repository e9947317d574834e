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
