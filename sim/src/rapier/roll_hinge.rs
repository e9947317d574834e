//! The hinge in which two frames roll against one another, and its metal stops.

use crate::RollHinge;
use crate::bodies::HingeSpring;

/// Stiffness of the roll hinge's metal stops, Nm/rad (assumed).
const ROLL_STOP_NM: f64 = 2.0e7;

/// A roll hinge's spring, or its stop once it is past it.
pub(super) fn roll_spring(law: &RollHinge, angle_rad: f64) -> HingeSpring {
    let RollHinge { stiffness_nm, damping_nms, max_rad } = *law;
    if angle_rad.abs() <= max_rad {
        return HingeSpring { stiffness_nm, damping_nms, rest_rad: 0.0 };
    }
    let both_nm = stiffness_nm + ROLL_STOP_NM;
    let rest_rad = max_rad.copysign(angle_rad) * ROLL_STOP_NM / both_nm;
    HingeSpring { stiffness_nm: both_nm, damping_nms: damping_nms + 0.01 * ROLL_STOP_NM, rest_rad }
}
