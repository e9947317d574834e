//! Where every part is, and how each freedom moves it, in world axes from the front frame's origin.

use glam::{DMat3, DQuat, DVec3};

use super::spatial::{
    Spatial, Spatial6, add, add_rigid, add_scaled, angular, apply, dot, turn_about, write_rigid,
};
use super::tree::{Arm, Tree};

/// Freedoms: six of the front frame, two joints, six arms, six wheels, and the roll of the middle
/// frame against the front one, which stays zero in a machine that has no such hinge.
pub(super) const FREEDOMS: usize = 21;
pub(super) const JOINTS: usize = 6;
pub(super) const ARMS: usize = 8;
pub(super) const WHEELS: usize = 14;
pub(super) const ROLL: usize = 20;
/// A number for each freedom. The first six are a twist (or wrench) of the front frame.
pub(super) type Generalized = [f64; FREEDOMS];

/// Coordinates and velocities. The wheels' angles are nobody's concern: they are round.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct State {
    /// The front frame's origin in the world, m.
    pub(super) position: DVec3,
    /// World from front frame.
    pub(super) turn: DQuat,
    /// Joint angles, left > 0, rad.
    pub(super) joint_rad: [f64; 2],
    /// Roll of the middle frame against the front one, rad.
    pub(super) roll_rad: f64,
    /// Arm angles from the reference pose, extending > 0, rad.
    pub(super) arm_rad: [f64; 6],
    /// Deflection of each wheel's bristles along its rolling and along its axle, m.
    pub(super) bristle_m: [[f64; 2]; 6],
    /// Velocities; the front frame's twist is about its origin.
    pub(super) rate: Generalized,
}

/// The parts where a [`State`] puts them, from the front frame's origin.
#[derive(Clone, Debug, Default)]
pub(super) struct Pose {
    pub(super) frame: [FramePose; 3],
    pub(super) arm: [ArmPose; 6],
    /// How each joint moves what is behind it.
    pub(super) joint_axis: [Spatial; 2],
    /// How the roll hinge moves what is behind it, where there is one: it lies ahead of the front
    /// joint's.
    pub(super) roll_axis: Option<Spatial>,
}

#[derive(Clone, Copy, Debug, Default)]
pub(super) struct FramePose {
    /// World from frame.
    pub(super) turn: DMat3,
    /// Where the frame's coordinates start.
    pub(super) origin: DVec3,
    pub(super) com: DVec3,
}

#[derive(Clone, Copy, Debug, Default)]
pub(super) struct ArmPose {
    /// World from arm.
    pub(super) turn: DMat3,
    pub(super) com: DVec3,
    pub(super) wheel: DVec3,
    /// Direction of the axle, left.
    pub(super) axle: DVec3,
    /// Twist of the arm against its frame.
    pub(super) arm_axis: Spatial,
    /// Twist of the wheel against its arm.
    pub(super) wheel_axis: Spatial,
}

impl FramePose {
    fn new(turn: DMat3, origin: DVec3, com: DVec3) -> Self {
        Self { turn, origin, com: origin + turn * com }
    }

    /// A point of the frame.
    #[inline]
    pub(super) fn point(&self, p: DVec3) -> DVec3 {
        self.origin + self.turn * p
    }
}

impl Pose {
    pub(super) fn new(tree: &Tree, state: &State) -> Self {
        let mut pose = Self::default();
        let mut turn = DMat3::from_quat(state.turn);
        let mut origin = DVec3::ZERO;
        pose.frame[0] = FramePose::new(turn, origin, tree.frames[0].com);
        for i in 0..2 {
            let at = pose.frame[i].point(tree.joints[i]);
            if i == 0 && tree.roll.is_some() {
                pose.roll_axis = Some(turn_about(turn.x_axis, at));
                turn *= DMat3::from_rotation_x(state.roll_rad);
            }
            // Bending left turns the frame behind to the right.
            turn *= DMat3::from_rotation_z(-state.joint_rad[i]);
            origin = at - turn * tree.joints[i];
            pose.joint_axis[i] = turn_about(-turn.z_axis, at);
            pose.frame[i + 1] = FramePose::new(turn, origin, tree.frames[i + 1].com);
        }
        for i in 0..6 {
            pose.arm[i] =
                ArmPose::new(&tree.arms[i], &pose.frame[Tree::frame_of(i)], state.arm_rad[i]);
        }
        pose
    }

    /// Twists of the frames under generalised velocities.
    #[inline]
    pub(super) fn frame_twists(&self, rate: &Generalized) -> [Spatial; 3] {
        let mut twist = [[0.0; 6]; 3];
        twist[0].copy_from_slice(&rate[..6]);
        for i in 0..2 {
            twist[i + 1] = twist[i];
            if let (0, Some(axis)) = (i, &self.roll_axis) {
                add_scaled(&mut twist[1], axis, rate[ROLL]);
            }
            add_scaled(&mut twist[i + 1], &self.joint_axis[i], rate[JOINTS + i]);
        }
        twist
    }

    /// Twist of arm `i` on a frame that has `frame`.
    #[inline]
    pub(super) fn arm_twist(&self, i: usize, frame: &Spatial, rate: &Generalized) -> Spatial {
        let mut twist = *frame;
        add_scaled(&mut twist, &self.arm[i].arm_axis, rate[ARMS + i]);
        twist
    }

    /// How fast each wheel turns about its axle against the world, rad/s.
    pub(super) fn rolling_rad_s(&self, rate: &Generalized) -> [f64; 6] {
        let frames = self.frame_twists(rate);
        core::array::from_fn(|i| {
            let arm = self.arm_twist(i, &frames[Tree::frame_of(i)], rate);
            rate[WHEELS + i] + angular(&arm).dot(self.arm[i].axle)
        })
    }

    /// Twist of wheel `i` on an arm that has `arm`.
    #[inline]
    pub(super) fn wheel_twist(&self, i: usize, arm: &Spatial, rate: &Generalized) -> Spatial {
        let mut twist = *arm;
        add_scaled(&mut twist, &self.arm[i].wheel_axis, rate[WHEELS + i]);
        twist
    }
}

/// Carries wrenches on the frames forward to the front one, and writes them as forces on the joints
/// and on the front frame.
#[inline]
pub(super) fn gather(pose: &Pose, on_frame: &mut [Spatial; 3], out: &mut Generalized) {
    for i in (0..2).rev() {
        let behind = on_frame[i + 1];
        out[JOINTS + i] = dot(&pose.joint_axis[i], &behind);
        if let (0, Some(axis)) = (i, &pose.roll_axis) {
            out[ROLL] = dot(axis, &behind);
        }
        add(&mut on_frame[i], &behind);
    }
    out[..6].copy_from_slice(&on_frame[0]);
}

impl ArmPose {
    fn new(part: &Arm, frame: &FramePose, angle_rad: f64) -> Self {
        let (sin, cos) = (part.extends * angle_rad).sin_cos();
        let (x, axle, z) = (frame.turn.x_axis, frame.turn.y_axis, frame.turn.z_axis);
        let turn = DMat3::from_cols(x * cos - z * sin, axle, x * sin + z * cos);
        let pivot = frame.point(part.pivot);
        let wheel = pivot + turn * part.to_wheel;
        Self {
            turn,
            com: pivot + turn * part.to_com,
            wheel,
            axle,
            arm_axis: turn_about(axle * part.extends, pivot),
            wheel_axis: turn_about(axle, wheel),
        }
    }
}

/// Inertias of the parts where they are: about their centres of mass, and spatial.
#[derive(Clone, Debug, Default)]
pub(super) struct Inertias {
    pub(super) about_com: AboutCom,
    pub(super) spatial: BodyInertias,
}

/// One inertia a body about its centre of mass, kg m².
#[derive(Clone, Debug, Default)]
pub(super) struct AboutCom {
    pub(super) frame: [DMat3; 3],
    pub(super) arm: [DMat3; 6],
    pub(super) wheel: [DMat3; 6],
}

/// Spatial inertias.
#[derive(Clone, Debug, Default)]
pub(super) struct BodyInertias {
    pub(super) frame: [Spatial6; 3],
    /// Of each arm with its wheel.
    pub(super) arm: [Spatial6; 6],
    /// The inertia of each arm alone times the twist of its wheel against it.
    pub(super) arm_column: [Spatial; 6],
}

impl Inertias {
    /// Takes those of this pose. Written in place: a matrix is too large to be handed on.
    pub(super) fn renew(&mut self, tree: &Tree, pose: &Pose) {
        let turned = |turn: &DMat3, inertia: DMat3| *turn * inertia * turn.transpose();
        let Self { about_com: about, spatial } = self;
        for (i, (part, at)) in tree.frames.iter().zip(&pose.frame).enumerate() {
            about.frame[i] = turned(&at.turn, part.inertia_kg_m2);
            write_rigid(&mut spatial.frame[i], part.mass_kg, at.com, &about.frame[i]);
        }
        for (i, (part, at)) in tree.arms.iter().zip(&pose.arm).enumerate() {
            about.arm[i] = turned(&at.turn, part.inertia_kg_m2);
            write_rigid(&mut spatial.arm[i], part.mass_kg, at.com, &about.arm[i]);
            spatial.arm_column[i] = apply(&spatial.arm[i], &at.wheel_axis);
            about.wheel[i] = wheel_inertia(part, at.axle);
            add_rigid(&mut spatial.arm[i], part.wheel_kg, at.wheel, &about.wheel[i]);
        }
    }
}

/// Inertia of a wheel about its centre: it is round, so its axle says all.
fn wheel_inertia(part: &Arm, axle: DVec3) -> DMat3 {
    let across = part.across_axle_kg_m2;
    let more = axle * (part.about_axle_kg_m2 - across);
    let outer = DMat3::from_cols(more * axle.x, more * axle.y, more * axle.z);
    outer + DMat3::from_diagonal(DVec3::splat(across))
}
