//! Hinges of the multibody: where the engine keeps each, and the spring in it.

use rapier3d::prelude::*;

use crate::bodies::{HingeMotion, HingeSpring};

/// Index of a hinge's own angle among a joint's six coordinates.
pub(super) const HINGE: usize = 3;

/// Where a hinge's angle is among the multibody's links and velocities.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Hinge {
    pub(super) link: usize,
    pub(super) dof: usize,
}

/// As an angle that counts in this sense.
pub(super) fn signed(motion: HingeMotion, sign: f64) -> HingeMotion {
    HingeMotion { angle_rad: sign * motion.angle_rad, rate_rad_s: sign * motion.rate_rad_s }
}

/// Gives a hinge this spring and damper, in this sense.
#[allow(clippy::cast_possible_truncation)]
pub(super) fn set_spring(multibody: &mut Multibody, hinge: Hinge, spring: &HingeSpring, sign: f64) {
    multibody.damping_mut()[hinge.dof] = spring.damping_nms as Real;
    if let Some(link) = multibody.link_mut(hinge.link) {
        let rest_rad = sign * spring.rest_rad;
        link.joint.set_spring(HINGE, spring.stiffness_nm as Real, rest_rad as Real);
    }
}
