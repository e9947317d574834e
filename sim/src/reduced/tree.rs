//! The parts as the fast core takes them: numbers of the tree that do not move.

use glam::{DMat3, DVec3};
use xt28_machine::Wheel;

use super::contact::ContactLaw;
use crate::{HullBall, Part, Parts, RollHinge, TyrePart};

/// Everything about the bodies that does not move. Frames' coordinates are the machine file's.
#[derive(Clone, Debug)]
pub(super) struct Tree {
    pub(super) frames: [Frame; 3],
    /// Where the frames are jointed, in the coordinates of either frame.
    pub(super) joints: [DVec3; 2],
    /// The spring of the middle frame's roll against the front one, where it can.
    pub(super) roll: Option<RollHinge>,
    pub(super) arms: [Arm; 6],
    /// The tyres' normal forces and friction.
    pub(super) laws: [ContactLaw; 6],
    pub(super) tyres: [TyrePart; 6],
    pub(super) radius_m: f64,
    /// Balls of each frame's outside.
    pub(super) hulls: [Vec<HullBall>; 3],
    /// Distance of the furthest of them from their frame's centre of mass, m.
    pub(super) hull_reach_m: [f64; 3],
    pub(super) gravity: DVec3,
    pub(super) mass_kg: f64,
}

/// One frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    pub(super) mass_kg: f64,
    pub(super) com: DVec3,
    /// About the centre of mass, in the frame's axes.
    pub(super) inertia_kg_m2: DMat3,
}

/// One arm with its wheel. The arm turns about the frame's y axis, the wheel about the same.
#[derive(Clone, Copy, Debug)]
pub(super) struct Arm {
    /// 1 where extending turns it about +y, -1 where about -y.
    pub(super) extends: f64,
    /// In the frame.
    pub(super) pivot: DVec3,
    /// From the pivot to the wheel's centre, in the reference pose.
    pub(super) to_wheel: DVec3,
    /// From the pivot to the arm's centre of mass, in the reference pose.
    pub(super) to_com: DVec3,
    pub(super) mass_kg: f64,
    /// About the centre of mass, in the arm's axes.
    pub(super) inertia_kg_m2: DMat3,
    pub(super) wheel_kg: f64,
    pub(super) about_axle_kg_m2: f64,
    /// A wheel is round: the same about every axis across its axle.
    pub(super) across_axle_kg_m2: f64,
}

impl Tree {
    pub(super) fn new(parts: &Parts) -> Self {
        let arms = Wheel::ALL.map(|wheel| Arm::new(parts, wheel));
        let on_frames: f64 = parts.frames.iter().map(|f| f.mass_kg).sum();
        let on_arms: f64 = arms.iter().map(|a| a.mass_kg + a.wheel_kg).sum();
        Self {
            frames: parts.frames.map(|part| Frame {
                mass_kg: part.mass_kg,
                com: part.com_m.into(),
                inertia_kg_m2: tensor(&part),
            }),
            joints: parts.joint_m.map(DVec3::from),
            roll: parts.roll_hinge,
            arms,
            tyres: parts.tyres.0,
            laws: parts.tyres.0.map(|tyre| ContactLaw {
                stiffness_n_m: tyre.stiffness_n_m,
                damping_n_s_m: tyre.damping_n_s_m,
                friction: tyre.friction,
            }),
            radius_m: parts.radius_m,
            hulls: parts.hulls.clone(),
            hull_reach_m: core::array::from_fn(|i| {
                let com = DVec3::from(parts.frames[i].com_m);
                let from_com_m = |ball: &HullBall| DVec3::from(ball.centre_m).distance(com);
                parts.hulls[i].iter().map(from_com_m).fold(0.0, f64::max)
            }),
            gravity: parts.gravity_m_s2.into(),
            mass_kg: on_frames + on_arms,
        }
    }

    /// The frame that carries arm `i`.
    pub(super) const fn frame_of(i: usize) -> usize {
        i / 2
    }
}

impl Arm {
    fn new(parts: &Parts, wheel: Wheel) -> Self {
        let (part, rim) = (&parts.arms[wheel], &parts.wheel);
        Self {
            extends: part.extends,
            pivot: part.pivot_m.into(),
            to_wheel: part.to_wheel_m.into(),
            to_com: part.body.com_m.into(),
            mass_kg: part.body.mass_kg,
            inertia_kg_m2: tensor(&part.body),
            wheel_kg: rim.mass_kg,
            about_axle_kg_m2: rim.inertia_kg_m2[1],
            across_axle_kg_m2: rim.inertia_kg_m2[0],
        }
    }
}

/// The inertia tensor about the centre of mass.
const fn tensor(part: &Part) -> DMat3 {
    let ([xx, yy, zz], [xy, xz, yz]) = (part.inertia_kg_m2, part.products_kg_m2);
    DMat3::from_cols_array(&[xx, xy, xz, xy, yy, yz, xz, yz, zz])
}
