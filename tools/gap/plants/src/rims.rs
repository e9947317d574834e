//! Where the wheels of a foreign machine are and how they move, from the motion of its bodies.

use glam::{DMat3, DQuat, DVec3};
use xt28_machine::{PerWheel, Wheel};
use xt28_sim::{Motion, Parts};

/// One wheel in the world.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rim {
    /// Its centre, m.
    pub(crate) centre_m: DVec3,
    /// Velocity of the centre, m/s.
    pub(crate) velocity_m_s: DVec3,
    /// Direction of the axle, to the left.
    pub(crate) axle: DVec3,
    /// Angular velocity of the wheel, its turning about the axle among it, rad/s.
    pub(crate) rate_rad_s: DVec3,
}

/// A rigid part: how it is turned, and how one point of it moves.
#[derive(Clone, Copy, Debug)]
struct Link {
    turn: DMat3,
    origin_m: DVec3,
    velocity_m_s: DVec3,
    rate_rad_s: DVec3,
}

impl Link {
    /// A point of the link and its velocity.
    fn point(&self, at_m: [f64; 3]) -> [DVec3; 2] {
        let lever = self.turn * DVec3::from(at_m);
        [self.origin_m + lever, self.velocity_m_s + self.rate_rad_s.cross(lever)]
    }

    /// A link hinged to this one at `at_m`, turned by `angle_rad` about `axis`, both in this link's
    /// axes; its origin lies on the hinge.
    fn hinged(&self, at_m: [f64; 3], axis: DVec3, angle_rad: f64, rate_rad_s: f64) -> Self {
        let [origin_m, velocity_m_s] = self.point(at_m);
        Self {
            turn: self.turn * DMat3::from_quat(DQuat::from_axis_angle(axis, angle_rad)),
            origin_m,
            velocity_m_s,
            rate_rad_s: self.rate_rad_s + self.turn * axis * rate_rad_s,
        }
    }
}

/// All wheels of a machine of these parts that moves so.
pub(crate) fn rims(parts: &Parts, motion: &Motion) -> PerWheel<Rim> {
    let [x, y, z] = motion.axes.map(DVec3::from);
    let turn = DMat3::from_cols(x, y, z);
    let rate_rad_s = DVec3::from(motion.rate_rad_s);
    let from_com = turn * -DVec3::from(parts.frames[0].com_m);
    let front = Link {
        turn,
        origin_m: motion.position_m.into(),
        velocity_m_s: DVec3::from(motion.velocity_m_s) + rate_rad_s.cross(from_com),
        rate_rad_s,
    };
    let behind = |frame: &Link, i: usize| {
        // A joint that bends left turns what is behind it to the right.
        let hinge = motion.joint[i];
        let at_m = parts.joint_m[i];
        let hung = frame.hinged(at_m, DVec3::Z, -hinge.angle_rad, -hinge.rate_rad_s);
        // Back from the hinge to the frame's own origin.
        let [origin_m, velocity_m_s] = hung.point(at_m.map(|m| -m));
        Link { origin_m, velocity_m_s, ..hung }
    };
    let middle = behind(&front, 0);
    let frames = [front, middle, behind(&middle, 1)];
    PerWheel::from_fn(|wheel| rim(parts, &frames[wheel.index() / 2], wheel, motion))
}

fn rim(parts: &Parts, frame: &Link, wheel: Wheel, motion: &Motion) -> Rim {
    let (part, hinge) = (&parts.arms[wheel], motion.arm[wheel]);
    let sense = part.extends;
    let arm =
        frame.hinged(part.pivot_m, DVec3::Y, sense * hinge.angle_rad, sense * hinge.rate_rad_s);
    let [centre_m, velocity_m_s] = arm.point(part.to_wheel_m);
    let axle = arm.turn * DVec3::Y;
    let rate_rad_s = arm.rate_rad_s + axle * motion.wheel_rate_rad_s[wheel];
    Rim { centre_m, velocity_m_s, axle, rate_rad_s }
}

#[cfg(test)]
mod tests {
    use xt28_machine::Machine;
    use xt28_sim::{Bodies, Effects, HingeMotion, Placed, ReducedBodies, Terrain};

    use super::*;

    /// Velocities are what places change by, however all hinges move at once.
    #[test]
    fn velocities_are_the_change_of_places() {
        let parts = Parts::new(&Machine::xt28(), &Effects::default());
        let mut bodies = ReducedBodies::new(&parts, &Terrain::Flat, PerWheel::splat(0.2));
        let mut motion = bodies.motion();
        motion.position_m[2] += 5.0;
        motion.velocity_m_s = [0.7, -0.3, 0.2];
        motion.rate_rad_s = [0.1, -0.2, 0.3];
        for (i, hinge) in motion.joint.iter_mut().enumerate() {
            *hinge = HingeMotion { angle_rad: 0.2 - 0.3 * i as f64, rate_rad_s: 0.4 };
        }
        for (i, hinge) in motion.arm.0.iter_mut().enumerate() {
            hinge.rate_rad_s = 0.3 - 0.1 * i as f64;
        }
        motion.wheel_rate_rad_s = PerWheel::splat(1.5);
        bodies.place(&motion);
        let dt_s = 1e-5;
        let before = rims(&parts, &bodies.motion());
        bodies.advance(&Default::default(), dt_s);
        let after = rims(&parts, &bodies.motion());
        for wheel in Wheel::ALL {
            let moved = (after[wheel].centre_m - before[wheel].centre_m) / dt_s;
            let mean = 0.5 * (after[wheel].velocity_m_s + before[wheel].velocity_m_s);
            assert!((moved - mean).length() < 2e-3, "{wheel}: {moved} {mean}");
            let spin = after[wheel].rate_rad_s.dot(after[wheel].axle);
            assert!((spin - 1.5).abs() < 1.0, "{wheel}: {spin}");
        }
    }
}
