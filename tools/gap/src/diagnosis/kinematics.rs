//! How wheels move with their arms and frames at one instant: what of rolling no effect and no knob changes.

use xt28_machine::{ArmPose, PerWheel};

/// One instant of a run. It needs of a machine only where its axles and joints are and how its arms are built.
#[derive(Clone, Debug)]
pub(super) struct Kinematics {
    /// Where each arm is.
    pub(super) pose: PerWheel<ArmPose>,
    /// Rate at which each wheel turns forward with its arm, rad/s.
    pub(super) turns_rad_s: PerWheel<f64>,
    /// Speed at which each arm carries its wheel ahead of its frame, m/s.
    pub(super) carried_m_s: PerWheel<f64>,
    /// Speed at which each wheel's frame goes ahead there while the front axle stands, m/s.
    pub(super) standing_m_s: PerWheel<f64>,
    /// What that gains for each metre a second of the front axle.
    pub(super) by_ahead: PerWheel<f64>,
}

/// How far a wheel has rolled beside its arm, m, by where the arm has swung it while its frame stood: the arm carries
/// it over the ground and turns the sensor along. An arm `extends` forward (1) or backward (-1).
pub(super) fn swung_m(extends: f64, radius_m: f64, pose: &ArmPose) -> f64 {
    extends * (pose.reach_m - radius_m * pose.angle_rad)
}

#[cfg(test)]
mod tests {
    use xt28_machine::Machine;

    use super::*;

    #[test]
    fn a_wheel_rolls_beside_an_arm_that_lifts_its_frame() {
        let machine = Machine::xt28();
        let (linkage, radius_m) = (machine.linkage(), machine.wheels.radius_m);
        let [here, after] = [0.2, 0.21].map(|stroke_m| linkage.at_stroke(stroke_m));
        let carried_m = after.reach_m - here.reach_m;
        let turned_m = radius_m * (after.angle_rad - here.angle_rad);
        assert!(turned_m.abs() > 0.5 * carried_m.abs(), "{turned_m} {carried_m}: not a small part");
        for extends in [1.0, -1.0] {
            let rolled_m = swung_m(extends, radius_m, &after) - swung_m(extends, radius_m, &here);
            assert!((rolled_m - extends * (carried_m - turned_m)).abs() < 1e-12);
        }
    }
}
