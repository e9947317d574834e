//! The parts of the vehicle as the engine takes them: frames, arms, wheels, hinges, contact settings.

use rapier3d::prelude::*;
use xt28_machine::Wheel;

use super::ground_contact::GroundDispatcher;
use super::shapes::Hull;
use crate::parts::{ArmPart, HullBall, Part, Parts};

/// How a frame's contact with the ground springs, Hz, and its share of critical damping (assumed).
const HULL_SPRING: (Real, Real) = (16.0, 0.4);
/// The cross of a joint that rolls and turns: next to nothing, as its mass is in the frames' already.
const CROSS: Part =
    Part { mass_kg: 1e-3, com_m: [0.0; 3], inertia_kg_m2: [1e-3; 3], products_kg_m2: [0.0; 3] };
/// Coefficient of friction of steel on ground (assumed).
const HULL_FRICTION: Real = 0.5;
/// Hulls meet the ground only, never one another.
const ON_GROUND: InteractionGroups =
    InteractionGroups::new(Group::GROUP_2, Group::GROUP_1, InteractionTestMode::And);

#[allow(clippy::cast_possible_truncation)]
pub(super) fn vector(v: [f64; 3]) -> Vector {
    Vector::new(v[0] as Real, v[1] as Real, v[2] as Real)
}

/// A world without sleep, clustering or continuous collision: wheels roll slowly on known ground.
pub(super) fn new_world(parts: &Parts) -> PhysicsWorld {
    let mut world = PhysicsWorld::new();
    world.gravity = vector(parts.gravity_m_s2);
    world.narrow_phase = NarrowPhase::with_query_dispatcher(GroundDispatcher);
    let p = &mut world.integration_parameters;
    p.num_solver_iterations = 1;
    p.num_internal_pgs_iterations = 8;
    // Without friction in this pass a slowly turning machine shakes itself apart at the step rate.
    p.friction_in_bias_pass = true;
    p.max_ccd_substeps = 0;
    p.contact_recycling = false;
    p.contact_clustering = false;
    p.static_contact_softness = SpringCoefficients::new(HULL_SPRING.0, HULL_SPRING.1);
    p.normalized_allowed_linear_error = 0.0;
    world
}

/// Where a frame's body has its origin among the machine's axes.
///
/// The engine carries the origin of a multibody's root along with the velocity of its centre of
/// mass. So the front frame's origin has to lie there, or the whole machine would slip sideways
/// whenever it pitches or rolls; the frames behind keep the machine file's origin.
pub(super) fn origin_m(parts: &Parts, frame: usize) -> [f64; 3] {
    if frame == 0 { parts.frames[0].com_m } else { [0.0; 3] }
}

/// A point of a frame, given in the machine's axes, in those of its body.
fn on_frame(parts: &Parts, frame: usize, point_m: [f64; 3]) -> Vector {
    let origin_m = origin_m(parts, frame);
    vector(core::array::from_fn(|i| point_m[i] - origin_m[i]))
}

/// The frames, and the body whose hinge is the roll hinge, where there is one.
pub(super) fn insert_frames(
    parts: &Parts,
    world: &mut PhysicsWorld,
) -> ([RigidBodyHandle; 3], Option<RigidBodyHandle>) {
    let frames: [_; 3] = core::array::from_fn(|i| {
        let origin_m = origin_m(parts, i);
        let mut frame = parts.frames[i];
        frame.com_m = core::array::from_fn(|k| frame.com_m[k] - origin_m[k]);
        world.bodies.insert(body(&frame).translation(vector(origin_m)))
    });
    let [front_m, rear_m] = parts.joint_m;
    let turn = |on_parent: Vector, on_child: Vector| {
        RevoluteJointBuilder::new(Vector::Z).local_anchor1(on_parent).local_anchor2(on_child)
    };
    let (before, behind) = (on_frame(parts, 0, front_m), on_frame(parts, 1, front_m));
    let mut rolled = None;
    if parts.roll_hinge.is_some() {
        // The engine knows no joint of two angles: a cross between the frames has one of each. The front frame
        // rolls on it and the joint turns behind it, so that the axis of the roll stays the front frame's.
        let cross = world.bodies.insert(body(&CROSS).translation(vector(front_m)));
        let roll = RevoluteJointBuilder::new(Vector::X).local_anchor1(before);
        world.insert_multibody_joint(frames[0], cross, roll);
        world.insert_multibody_joint(cross, frames[1], turn(Vector::ZERO, behind));
        rolled = Some(cross);
    } else {
        world.insert_multibody_joint(frames[0], frames[1], turn(before, behind));
    }
    let (before, behind) = (on_frame(parts, 1, rear_m), on_frame(parts, 2, rear_m));
    world.insert_multibody_joint(frames[1], frames[2], turn(before, behind));
    (frames, rolled)
}

/// What of a frame can touch the ground, without mass.
pub(super) fn insert_hull(
    world: &mut PhysicsWorld,
    frame: RigidBodyHandle,
    balls: &[HullBall],
) -> ColliderHandle {
    let hull = ColliderBuilder::new(SharedShape::new(Hull::new(balls)))
        .density(0.0)
        .friction(HULL_FRICTION)
        .friction_combine_rule(CoefficientCombineRule::Min)
        .collision_groups(ON_GROUND);
    world.insert_collider(hull, Some(frame))
}

/// An arm with its wheel on it, whose own turning is kept elsewhere; its origin is its pivot.
pub(super) fn insert_arm(
    parts: &Parts,
    world: &mut PhysicsWorld,
    frames: &[RigidBodyHandle; 3],
    wheel: Wheel,
) -> RigidBodyHandle {
    let frame = wheel.axle() as usize;
    let pivot = on_frame(parts, frame, parts.arms[wheel].pivot_m);
    let arm = world.bodies.insert(body(&with_wheel(parts, wheel)));
    let hinge = RevoluteJointBuilder::new(Vector::Y).local_anchor1(pivot);
    world.insert_multibody_joint(frames[frame], arm, hinge);
    arm
}

/// An arm and its wheel as one body, but for the wheel's inertia about its own axle.
fn with_wheel(parts: &Parts, wheel: Wheel) -> Part {
    let ArmPart { body: arm, to_wheel_m, .. } = parts.arms[wheel];
    let mut rim = parts.wheel;
    rim.com_m = core::array::from_fn(|i| to_wheel_m[i] + rim.com_m[i]);
    rim.inertia_kg_m2[1] = 0.0;
    arm.joined(rim)
}

/// A wheel's centre from its arm's pivot and from the centre of mass of both, among the arm's axes.
pub(super) fn hub(parts: &Parts, wheel: Wheel) -> [Vector; 2] {
    let to_wheel_m = parts.arms[wheel].to_wheel_m;
    let com_m = with_wheel(parts, wheel).com_m;
    [to_wheel_m, core::array::from_fn(|i| to_wheel_m[i] - com_m[i])].map(vector)
}

#[allow(clippy::cast_possible_truncation)]
fn body(part: &Part) -> RigidBodyBuilder {
    let (com, mass_kg) = (vector(part.com_m), part.mass_kg as Real);
    let mass = if part.products_kg_m2 == [0.0; 3] {
        MassProperties::new(com, mass_kg, vector(part.inertia_kg_m2))
    } else {
        MassProperties::with_inertia_matrix(com, mass_kg, tensor(part))
    };
    RigidBodyBuilder::dynamic().can_sleep(false).additional_mass_properties(mass)
}

/// The inertia tensor, columns of a symmetric matrix.
fn tensor(part: &Part) -> Matrix {
    let ([xx, yy, zz], [xy, xz, yz]) = (part.inertia_kg_m2, part.products_kg_m2);
    Matrix::from_cols(vector([xx, xy, xz]), vector([xy, yy, yz]), vector([xz, yz, zz]))
}
