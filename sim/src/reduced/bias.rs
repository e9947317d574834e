//! What the bodies' own motion and weight ask of each freedom: recursive Newton-Euler.

use glam::DVec3;

use super::pose::{ARMS, AboutCom, FREEDOMS, Generalized, JOINTS, Pose, ROLL, WHEELS, gather};
use super::spatial::{
    Spatial, add, add_scaled, angular, cross_motion, dot, linear, velocity_at, wrench_at,
};
use super::tree::Tree;

/// Generalised forces that would hold every acceleration at zero: M q'' + bias = applied forces.
///
/// Accelerations are spatial (of the point fixed in the world), and start from gravity turned over.
pub(super) fn bias(
    tree: &Tree,
    pose: &Pose,
    about_com: &AboutCom,
    rate: &Generalized,
    gravity: DVec3,
) -> Generalized {
    let twists = pose.frame_twists(rate);
    let mut acceleration = [[0.0; 6]; 3];
    acceleration[0][3..].copy_from_slice(&(-gravity).to_array());
    for i in 0..2 {
        acceleration[i + 1] = acceleration[i];
        let mut ahead = twists[i];
        if let (0, Some(axis)) = (i, &pose.roll_axis) {
            let turning = cross_motion(&ahead, axis);
            add_scaled(&mut acceleration[1], &turning, rate[ROLL]);
            add_scaled(&mut ahead, axis, rate[ROLL]);
        }
        let turning = cross_motion(&ahead, &pose.joint_axis[i]);
        add_scaled(&mut acceleration[i + 1], &turning, rate[JOINTS + i]);
    }
    let mut out = [0.0; FREEDOMS];
    let mut on_frame: [Spatial; 3] = core::array::from_fn(|i| {
        let (part, at) = (&tree.frames[i], &pose.frame[i]);
        let spin = angular(&twists[i]);
        let about = about_com.frame[i];
        let torque = about * angular(&acceleration[i]) + spin.cross(about * spin);
        newton(part.mass_kg, at.com, &twists[i], &acceleration[i], torque)
    });
    for i in 0..6 {
        let frame = Tree::frame_of(i);
        let (part, at) = (&tree.arms[i], &pose.arm[i]);
        let arm_twist = pose.arm_twist(i, &twists[frame], rate);
        let mut arm_acceleration = acceleration[frame];
        let turning = cross_motion(&twists[frame], &at.arm_axis);
        add_scaled(&mut arm_acceleration, &turning, rate[ARMS + i]);

        let twist = pose.wheel_twist(i, &arm_twist, rate);
        let mut wheel_acceleration = arm_acceleration;
        let turning = cross_motion(&arm_twist, &at.wheel_axis);
        add_scaled(&mut wheel_acceleration, &turning, rate[WHEELS + i]);

        let about = about_com.wheel[i];
        let spin = angular(&twist);
        let torque = about * angular(&wheel_acceleration) + spin.cross(about * spin);
        let wheel = newton(part.wheel_kg, at.wheel, &twist, &wheel_acceleration, torque);
        let about = about_com.arm[i];
        let spin = angular(&arm_twist);
        let torque = about * angular(&arm_acceleration) + spin.cross(about * spin);
        let mut arm = newton(part.mass_kg, at.com, &arm_twist, &arm_acceleration, torque);
        out[WHEELS + i] = dot(&at.wheel_axis, &wheel);
        add(&mut arm, &wheel);
        out[ARMS + i] = dot(&at.arm_axis, &arm);
        add(&mut on_frame[frame], &arm);
    }
    gather(pose, &mut on_frame, &mut out);
    out
}

/// The wrench that gives a body this spatial acceleration.
fn newton(
    mass_kg: f64,
    com: DVec3,
    twist: &Spatial,
    acceleration: &Spatial,
    torque_about_com: DVec3,
) -> Spatial {
    // The centre of mass passes the fixed point, so its own acceleration has the turning as well.
    let of_com = linear(acceleration)
        + angular(acceleration).cross(com)
        + angular(twist).cross(velocity_at(twist, com));
    let mut wrench = wrench_at(of_com * mass_kg, com);
    wrench[0] += torque_about_com.x;
    wrench[1] += torque_about_com.y;
    wrench[2] += torque_about_com.z;
    wrench
}
