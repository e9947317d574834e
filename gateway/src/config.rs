//! What a gateway is set to.

use xt28_machine::Machine;
use xt28_safety::Limits;
use xt28_ubx::Geodetic;

/// Settings of one gateway.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GatewayConfig {
    /// Origin of the local frame.
    pub origin: Geodetic,
    /// What the safety kernel holds everything to.
    pub limits: Limits,
    /// Arm by itself, once, as soon as all streams are alive. Otherwise [`crate::Gateway::order`].
    pub arm_at_start: bool,
}

impl GatewayConfig {
    /// The defaults for a machine: the bench's origin, the kernel's limits with the machine's own
    /// ranges, armed at the start.
    #[must_use]
    pub const fn new(machine: &Machine) -> Self {
        let limits = Limits {
            stroke_max_m: machine.hydraulics.manual_stroke_max_m,
            opening_max: machine.hydraulics.manual_opening_max,
            angle_max_rad: machine.articulation.angle_max_deg.to_radians(),
            ..Limits::XT28
        };
        Self { origin: Geodetic::BENCH_ORIGIN, limits, arm_at_start: true }
    }
}
