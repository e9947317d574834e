//! The parts of the vehicle as the engine takes them: frames, arms, wheels, hinges, contact settings.

use rapier3d::prelude::*;
use xt28_machine::Wheel;

use super::ground_contact::GroundDispatcher;
use crate::parts::{ArmPart, Part, Parts, TyrePart};

/// What a wheel's contact moves, kg: the wheel, its share of the arm, and what the cylinder's lock
/// resists within a step. The engine states a contact's spring as a frequency of this mass; a test
/// holds the sag that comes of it to the tyre's stiffness.
const CONTACT_MASS_KG: f64 = 770.0;

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
    p.static_contact_softness = tyre(&parts.tyres[Wheel::Fr]);
    p.normalized_allowed_linear_error = 0.0;
    world
}

/// The tyres' spring and damper, as the engine wants a contact's.
#[allow(clippy::cast_possible_truncation)]
fn tyre(t: &TyrePart) -> SpringCoefficients<Real> {
    let rad_s = (t.stiffness_n_m / CONTACT_MASS_KG).sqrt();
    let damping_ratio = t.damping_n_s_m / (2.0 * CONTACT_MASS_KG * rad_s);
    SpringCoefficients::new((rad_s / core::f64::consts::TAU) as Real, damping_ratio as Real)
}

/// Frames share the machine's axes: each body's origin is the machine file's origin.
pub(super) fn insert_frames(parts: &Parts, world: &mut PhysicsWorld) -> [RigidBodyHandle; 3] {
    let frames = parts.frames.map(|frame| world.bodies.insert(body(&frame)));
    for (i, anchor) in parts.joint_m.into_iter().enumerate() {
        let joint = RevoluteJointBuilder::new(Vector::Z)
            .local_anchor1(vector(anchor))
            .local_anchor2(vector(anchor));
        world.insert_multibody_joint(frames[i], frames[i + 1], joint);
    }
    frames
}

/// An arm with its wheel: the arm's origin is its pivot, the wheel's its centre.
pub(super) fn insert_arm(
    parts: &Parts,
    world: &mut PhysicsWorld,
    frame: RigidBodyHandle,
    wheel: Wheel,
) -> (RigidBodyHandle, RigidBodyHandle, ColliderHandle) {
    let ArmPart { body: arm, pivot_m, to_wheel_m, .. } = &parts.arms[wheel];
    let axle = |parent: [f64; 3], child: [f64; 3]| {
        RevoluteJointBuilder::new(Vector::Y)
            .local_anchor1(vector(parent))
            .local_anchor2(vector(child))
    };
    let arm = world.bodies.insert(body(arm));
    world.insert_multibody_joint(frame, arm, axle(*pivot_m, [0.0; 3]));
    let rim = world.bodies.insert(body(&parts.wheel));
    world.insert_multibody_joint(arm, rim, axle(*to_wheel_m, [0.0; 3]));
    #[allow(clippy::cast_possible_truncation)]
    let ball = ColliderBuilder::ball(parts.radius_m as Real)
        .density(0.0)
        .friction(parts.tyres[wheel].friction as Real)
        .friction_combine_rule(CoefficientCombineRule::Min)
        // Wheels meet the ground only, never one another.
        .collision_groups(InteractionGroups::new(
            Group::GROUP_2,
            Group::GROUP_1,
            InteractionTestMode::And,
        ));
    let collider = world.insert_collider(ball, Some(rim));
    (arm, rim, collider)
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
