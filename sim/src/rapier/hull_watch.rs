//! Keeps the frames' outsides out of the engine while the ground is out of their reach.
//!
//! An underside that is 0.3 m clear cannot touch before it has moved 0.3 m, whatever the ground looks
//! like. So the engine has to know the hulls only near the ground, and a machine on its wheels costs
//! what it costs without them.

use rapier3d::prelude::*;

use super::insert::{insert_hull, origin_m};
use crate::Terrain;
use crate::parts::{HullBall, Parts};

/// Clearance below which the engine watches a hull, m: more than a step's motion and its prediction.
const NEAR_M: f64 = 0.05;
/// How far a look goes, m.
const LOOK_M: f64 = 0.3;
/// What velocities after a step may miss of the motion within it.
const MARGIN: f64 = 1.5;

/// One frame's outside.
#[derive(Clone, Debug)]
pub(super) struct HullWatch {
    frame: RigidBodyHandle,
    collider: ColliderHandle,
    /// In the axes of the frame's body.
    balls: Vec<HullBall>,
    /// Longest way from the frame's centre of mass to the skin of a ball, m.
    arm_m: f64,
    /// Motion until the next look, m.
    free_m: f64,
}

impl HullWatch {
    /// The outside of frame `index`, inserted asleep.
    pub(super) fn new(
        world: &mut PhysicsWorld,
        frame: RigidBodyHandle,
        parts: &Parts,
        index: usize,
    ) -> Self {
        let (origin_m, com_m) = (origin_m(parts, index), parts.frames[index].com_m);
        let length = |v: [f64; 3]| v.iter().map(|c| c * c).sum::<f64>().sqrt();
        let mut balls = parts.hulls[index].clone();
        let mut arm_m = 0.0_f64;
        for HullBall { centre_m, radius_m } in &mut balls {
            let way_m = length(core::array::from_fn(|i| centre_m[i] - com_m[i])) + *radius_m;
            arm_m = arm_m.max(way_m);
            *centre_m = core::array::from_fn(|i| centre_m[i] - origin_m[i]);
        }
        let collider = insert_hull(world, frame, &balls);
        world.colliders[collider].set_enabled(false);
        Self { frame, collider, balls, arm_m, free_m: 0.0 }
    }

    /// The hull in the engine.
    pub(super) const fn collider(&self) -> ColliderHandle {
        self.collider
    }

    /// Forgets how far the ground was: the machine has been put elsewhere.
    pub(super) const fn look_again(&mut self) {
        self.free_m = 0.0;
    }

    /// Looks at the ground if the frame may have come near it within the next `dt_s` s.
    pub(super) fn look(&mut self, world: &mut PhysicsWorld, terrain: &Terrain, dt_s: f64) {
        let body = &world.bodies[self.frame];
        let speed_m_s =
            f64::from(body.linvel().length()) + f64::from(body.angvel().length()) * self.arm_m;
        self.free_m -= MARGIN * speed_m_s * dt_s;
        if self.free_m > 0.0 {
            return;
        }
        let clear_m = self.clearance_m(body.position(), terrain);
        let near = clear_m < NEAR_M;
        let collider = &mut world.colliders[self.collider];
        if collider.is_enabled() != near {
            collider.set_enabled(near);
        }
        self.free_m = if near { NEAR_M } else { clear_m - NEAR_M };
    }

    /// How far the nearest ground is from the nearest ball, m; at most [`LOOK_M`].
    #[allow(clippy::cast_possible_truncation)]
    fn clearance_m(&self, pose: &Pose, terrain: &Terrain) -> f64 {
        let clear = |ball: &HullBall| {
            let centre = *pose * Vector::from(ball.centre_m.map(|m| m as Real));
            let centre_m = centre.to_array().map(f64::from);
            let minima = terrain.nearest(centre_m, ball.radius_m + LOOK_M);
            let nearest = minima.points().iter().map(|n| n.distance_m - ball.radius_m);
            nearest.fold(LOOK_M, f64::min)
        };
        self.balls.iter().map(clear).fold(LOOK_M, f64::min)
    }
}
