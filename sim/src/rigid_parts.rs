//! The parts of the vehicle as the engine takes them: frames, arms, wheels, hinges, contact settings.

use rapier3d::prelude::*;
use xt28_machine::{Axle, Machine, Pointing, Side, Wheel};

use crate::ground_contact::GroundDispatcher;

/// Stroke at which the machine file gives the frames' positions, m.
pub(crate) const REFERENCE_STROKE_M: f64 = 0.25;
/// What a wheel's contact moves, kg: the wheel, its share of the arm, and what the cylinder's lock
/// resists within a step. The engine states a contact's spring as a frequency of this mass; a test
/// holds the sag that comes of it to the tyre's stiffness.
const CONTACT_MASS_KG: f64 = 770.0;

#[allow(clippy::cast_possible_truncation)]
pub(crate) fn vector(v: [f64; 3]) -> Vector {
    Vector::new(v[0] as Real, v[1] as Real, v[2] as Real)
}

/// +1 where an arm points forward: its hinge angle about +y then grows with the stroke.
pub(crate) fn arm_sign(machine: &Machine, wheel: Wheel) -> f64 {
    let front = machine.arms.front_arms_point == Pointing::Forward;
    if (wheel.axle() == Axle::Front) == front { 1.0 } else { -1.0 }
}

/// A world without sleep, clustering or continuous collision: wheels roll slowly on known ground.
pub(crate) fn new_world(machine: &Machine) -> PhysicsWorld {
    let mut world = PhysicsWorld::new();
    world.gravity = vector([0.0, 0.0, -xt28_machine::GRAVITY_M_S2]);
    world.narrow_phase = NarrowPhase::with_query_dispatcher(GroundDispatcher);
    let p = &mut world.integration_parameters;
    p.num_solver_iterations = 1;
    p.num_internal_pgs_iterations = 8;
    // Without friction in this pass a slowly turning machine shakes itself apart at the step rate.
    p.friction_in_bias_pass = true;
    p.max_ccd_substeps = 0;
    p.contact_recycling = false;
    p.static_contact_softness = tyre(machine);
    p.normalized_allowed_linear_error = 0.0;
    world
}

/// The tyres' spring and damper, as the engine wants a contact's.
#[allow(clippy::cast_possible_truncation)]
fn tyre(machine: &Machine) -> SpringCoefficients<Real> {
    let v = &machine.vehicle;
    let rad_s = (v.tyre_stiffness_n_m / CONTACT_MASS_KG).sqrt();
    let damping_ratio = v.tyre_damping_n_s_m / (2.0 * CONTACT_MASS_KG * rad_s);
    SpringCoefficients::new((rad_s / core::f64::consts::TAU) as Real, damping_ratio as Real)
}

/// Frames share the machine's axes: each body's origin is the machine file's origin.
pub(crate) fn insert_frames(machine: &Machine, world: &mut PhysicsWorld) -> [RigidBodyHandle; 3] {
    let (m, f) = (&machine.masses, &machine.frames);
    [
        (m.front_frame_kg, f.front_com_m, f.front_box_m),
        (m.middle_frame_kg, f.middle_com_m, f.middle_box_m),
        (m.rear_frame_kg, f.rear_com_m, f.rear_box_m),
    ]
    .map(|(mass_kg, com_m, box_m)| {
        let body = body(mass_kg, com_m, box_inertia(mass_kg, box_m));
        world.bodies.insert(body)
    })
}

/// An arm with its wheel: the arm's origin is its pivot, the wheel's its centre.
pub(crate) fn insert_arm(
    machine: &Machine,
    world: &mut PhysicsWorld,
    frame: RigidBodyHandle,
    wheel: Wheel,
) -> (RigidBodyHandle, RigidBodyHandle, ColliderHandle) {
    let reference = machine.linkage().at_stroke(REFERENCE_STROKE_M);
    let side = if wheel.side() == Side::Left { 1.0 } else { -1.0 };
    let forward = arm_sign(machine, wheel);
    let v = &machine.vehicle;
    let to_wheel = [
        forward * reference.reach_m,
        side * (machine.wheels.track_m / 2.0 - v.arm_pivot_y_m),
        -reference.drop_m,
    ];
    let pivot = [
        machine.wheels.axle_x_m[wheel.axle() as usize] - to_wheel[0],
        side * v.arm_pivot_y_m,
        machine.wheels.radius_m + reference.drop_m,
    ];
    let arm_kg = machine.masses.arm_kg;
    let length_m = machine.arms.pivot_to_wheel_m;
    let slender = arm_kg * length_m * length_m / 12.0;
    let arm_com = to_wheel.map(|c| c * v.arm_com_share);
    let arm = world.bodies.insert(body(arm_kg, arm_com, [slender; 3]));
    let axle = |parent: [f64; 3], child: [f64; 3]| {
        RevoluteJointBuilder::new(Vector::Y)
            .local_anchor1(vector(parent))
            .local_anchor2(vector(child))
    };
    world.insert_multibody_joint(frame, arm, axle(pivot, [0.0; 3]));

    let wheel_kg = machine.masses.wheel_kg;
    let about_axle = wheel_kg * v.wheel_gyration_m * v.wheel_gyration_m;
    let across = 0.6 * about_axle;
    let rim = world.bodies.insert(body(wheel_kg, [0.0; 3], [across, about_axle, across]));
    world.insert_multibody_joint(arm, rim, axle(to_wheel, [0.0; 3]));
    #[allow(clippy::cast_possible_truncation)]
    let ball = ColliderBuilder::ball(machine.wheels.radius_m as Real)
        .density(0.0)
        .friction(machine.wheels.friction as Real)
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
fn body(mass_kg: f64, com_m: [f64; 3], inertia_kg_m2: [f64; 3]) -> RigidBodyBuilder {
    RigidBodyBuilder::dynamic().can_sleep(false).additional_mass_properties(MassProperties::new(
        vector(com_m),
        mass_kg as Real,
        vector(inertia_kg_m2),
    ))
}

/// Principal inertias of a solid box, kg m².
fn box_inertia(mass_kg: f64, [x, y, z]: [f64; 3]) -> [f64; 3] {
    let m = mass_kg / 12.0;
    [m * (y * y + z * z), m * (x * x + z * z), m * (x * x + y * y)]
}
