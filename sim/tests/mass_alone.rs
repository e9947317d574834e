//! The machine's masses alone, driven by the whole vehicle's own signals: what acts on it from outside is what its
//! momentum and its angular momentum about a place in the world gain.

mod mass_rig;
mod overheard;
mod tyre_rig;

use core::time::Duration;

use mass_rig::{Sum, V3, cross, plus, sum};
use overheard::Overheard;
use xt28_machine::{GRAVITY_M_S2, Machine, PerWheel, Wheel};
use xt28_sim::effects::{ComShift, MassEffects, Payload};
use xt28_sim::{
    Actuation, Bodies, Effects, Placed, Plant, RapierBodies, ReducedBodies, STEP, Terrain, Vehicle,
    VehicleState,
};

/// Empty, and with a load off the middle and a front frame whose centre of mass is elsewhere.
fn masses() -> [MassEffects; 2] {
    let payload = Payload { mass_kg: 6000.0, longitudinal_m: -0.6, lateral_m: 0.3, height_m: 2.2 };
    let com_shift = ComShift { x_m: 0.4, y_m: -0.2, z_m: 0.3 };
    [MassEffects::default(), MassEffects { payload, com_shift }]
}

/// Arms, joints and wheels to and fro.
fn driven(t_s: f64) -> Actuation {
    Actuation {
        arm_opening: PerWheel::from_fn(|w| 0.5 * (3.0 * t_s + w.index() as f64).sin()),
        steer_opening: [(2.0 * t_s).sin(), -(2.5 * t_s).sin()],
        pump_displacement: [(2.0 * t_s).min(1.0); 2],
        ..Actuation::idle(1200.0)
    }
}

/// What the weight gives in a step of `dt_s` s: momentum, and angular momentum about the world's origin.
fn weight(at: &Sum, dt_s: f64) -> [V3; 2] {
    let down = [0.0, 0.0, -GRAVITY_M_S2 * dt_s];
    [down.map(|g| at.mass_kg * g), cross(at.first_kg_m, down)]
}

/// The states, with a step of `dt_s` s, of a machine that is thrown up bent and turning and moves all it has for a second.
fn flown<B: Bodies + Placed>(
    machine: &Machine,
    masses: MassEffects,
    dt_s: f64,
) -> Vec<VehicleState> {
    let effects = Effects { masses, ..Effects::default() };
    let mut thrown = *Vehicle::new(machine, &Terrain::Flat, PerWheel::splat(0.17)).state();
    thrown.position_m = [1.0, -2.0, 20.0];
    (thrown.yaw_rad, thrown.pitch_rad, thrown.roll_rad) = (0.7, 0.15, -0.2);
    (thrown.joint_rad, thrown.joint_rate_rad_s) = ([0.2, -0.15], [0.1, -0.1]);
    thrown.front_rate_rad_s = [0.9, -0.7, 0.5];
    thrown.wheel_speed_rad_s = PerWheel::splat(0.5);
    thrown.cylinder_force_n = PerWheel::splat(-12e3);
    let mut vehicle = Vehicle::<B>::from_measured(
        machine,
        &effects,
        &Terrain::Flat,
        Duration::from_secs_f64(dt_s),
        &thrown,
        &driven(0.0),
        Duration::ZERO,
    );
    let first = *vehicle.state();
    let later = (0..(1.0 / dt_s).round() as u32).map(|step| {
        vehicle.step(&driven(f64::from(step) * dt_s));
        *vehicle.state()
    });
    let states: Vec<VehicleState> = core::iter::once(first).chain(later).collect();
    assert!(states.iter().all(|s| s.ground_force_n.sum() == 0.0), "it flies");
    states
}

/// What momentum and angular momentum of these masses, over the whole mass, have come off what their weight gave them by
/// each quarter of the second.
fn off(
    machine: &Machine,
    masses: &MassEffects,
    states: &[VehicleState],
    dt_s: f64,
) -> [[V3; 2]; 4] {
    let start = sum(machine, masses, &states[0]);
    let mut own = [start.momentum, start.angular];
    let mut off = Vec::new();
    for (step, pair) in states.windows(2).enumerate() {
        let [before, after] = [&pair[0], &pair[1]].map(|s| sum(machine, masses, s));
        let first_kg_m = plus(before.first_kg_m, after.first_kg_m, 1.0).map(|m| 0.5 * m);
        for (own, gain) in own.iter_mut().zip(weight(&Sum { first_kg_m, ..after }, dt_s)) {
            *own = plus(*own, gain, 1.0);
        }
        if (step + 1).is_multiple_of(states.len() / 4) {
            let seen = [after.momentum, after.angular];
            off.push([0, 1].map(|i| plus(own[i], seen[i], -1.0).map(|c| c / start.mass_kg)));
        }
    }
    off.try_into().expect("four quarters")
}

/// The most of that, m/s and m2/s, without what goes with the step, in which frames and arms turn on: twice what half the
/// step has, less what the whole has.
fn most_off(
    machine: &Machine,
    masses: &MassEffects,
    [whole, half]: &[Vec<VehicleState>; 2],
) -> [f64; 2] {
    let whole = off(machine, masses, whole, STEPS_S[0]);
    let half = off(machine, masses, half, STEPS_S[1]);
    [0, 1].map(|i| {
        let left = half
            .iter()
            .zip(&whole)
            .map(|(half, whole)| length(plus(half[i].map(|c| 2.0 * c), whole[i], -1.0)));
        left.fold(0.0, f64::max)
    })
}

const STEPS_S: [f64; 2] = [1e-3, 5e-4];
/// What is left of it on the reference, whose numbers are single precision, and on the fast core; m/s and m2/s of the whole
/// mass.
const LEFT_REFERENCE: [f64; 2] = [1.5e-3, 1e-2];
const LEFT: [f64; 2] = [5e-5, 5e-4];

/// In the air momentum and angular momentum about a place in the world change by the weight alone, whatever the machine
/// moves. Tolerance: of some 10 m/s and 60 m2/s a ten-thousandth on the reference, and a hundred-thousandth on the fast core.
#[test]
fn masses_alone_reproduce_a_machine_in_the_air() {
    flies::<RapierBodies>(LEFT_REFERENCE);
    flies::<ReducedBodies>(LEFT);
}

fn flies<B: Bodies + Placed>([linear_m_s, angular_m2_s]: [f64; 2]) {
    let machine = Machine::xt28();
    for masses in masses() {
        let flights = STEPS_S.map(|dt_s| flown::<B>(&machine, masses, dt_s));
        let left = most_off(&machine, &masses, &flights);
        assert!(left[0] < linear_m_s && left[1] < angular_m2_s, "{left:?} m/s, m2/s");
    }
}

/// Any mass, place or inertia of the machine file or of the effects that is off by a tenth, or by a tenth of a metre, shows.
#[test]
fn other_masses_do_not_reproduce_it() {
    type Change = (&'static str, fn(&mut Machine, &mut MassEffects));
    let changes: [Change; 16] = [
        ("front mass", |m, _| m.masses.front_frame_kg *= 1.1),
        ("middle mass", |m, _| m.masses.middle_frame_kg *= 1.1),
        ("rear mass", |m, _| m.masses.rear_frame_kg *= 1.1),
        ("arm mass", |m, _| m.masses.arm_kg *= 1.1),
        ("wheel mass", |m, _| m.masses.wheel_kg *= 1.1),
        ("front place", |m, _| m.frames.front_com_m[0] += 0.1),
        ("middle place", |m, _| m.frames.middle_com_m[2] += 0.1),
        ("rear place", |m, _| m.frames.rear_com_m[0] += 0.1),
        ("front box", |m, _| m.frames.front_box_m = m.frames.front_box_m.map(|l| 1.1 * l)),
        ("wheel gyration", |m, _| m.vehicle.wheel_gyration_m *= 1.1),
        ("load", |_, e| e.payload.mass_kg *= 1.1),
        ("load ahead", |_, e| e.payload.longitudinal_m += 0.1),
        ("load left", |_, e| e.payload.lateral_m += 0.1),
        ("load up", |_, e| e.payload.height_m += 0.1),
        ("shift left", |_, e| e.com_shift.y_m += 0.1),
        ("shift up", |_, e| e.com_shift.z_m += 0.1),
    ];
    let (machine, masses) = (Machine::xt28(), masses()[1]);
    let flights = STEPS_S.map(|dt_s| flown::<ReducedBodies>(&machine, masses, dt_s));
    for (what, change) in changes {
        let (mut other, mut others) = (machine.clone(), masses);
        change(&mut other, &mut others);
        let left = most_off(&other, &others, &flights);
        let shows = left[0] > 2.0 * LEFT[0] || left[1] > 2.0 * LEFT[1];
        assert!(shows, "{what}: {left:?} m/s, m2/s");
    }
}

/// Fed with what the ground pushes and turns the wheels with on the reference, they gain over 10 s of bends on flat and on
/// rough ground what the machine shows. Tolerance: 1 mm/s and 0.01 m2/s of the whole mass, of some 0.5 to 1 m/s and 1 to 2.5 m2/s.
#[test]
fn masses_alone_reproduce_a_machine_on_the_ground() {
    for terrain in [Terrain::Flat, tyre_rig::rough()] {
        for (masses, (machine, effects)) in masses().into_iter().zip(tyre_rig::machines()) {
            let [worst, most] = drives(&machine, &Effects { masses, ..effects }, &terrain);
            assert!(most[0] > 0.5 && most[1] > 0.5, "it moves with {most:?} m/s, m2/s");
            assert!(worst[0] < 1e-3 && worst[1] < 1e-2, "{worst:?} m/s, m2/s of {most:?}");
        }
    }
}

/// How far momentum and angular momentum come off at the most, and how large they get, over the whole mass.
fn drives(machine: &Machine, effects: &Effects, terrain: &Terrain) -> [[f64; 2]; 2] {
    let dt_s = STEP.as_secs_f64();
    let mut vehicle: Vehicle<Overheard<RapierBodies>> =
        Vehicle::with(machine, effects, terrain, PerWheel::splat(0.17), STEP);
    let of = |s: &VehicleState| sum(machine, &effects.masses, s);
    let mut before = of(vehicle.state());
    let (mut own, mut worst) = ([before.momentum, before.angular], [0.0_f64; 2]);
    let mut most = [0.0_f64; 2];
    for step in 0..2000 {
        let wild = driven(f64::from(step) * dt_s);
        vehicle.step(&Actuation {
            arm_opening: wild.arm_opening.map(|opening| 0.3 * opening),
            steer_opening: wild.steer_opening.map(|opening| 0.3 * opening),
            ..wild
        });
        let mut gain = weight(&before, dt_s);
        for w in Wheel::ALL {
            let tread = vehicle.bodies().bodies.tread(w);
            let turning_nm = plus(tread.torque_nm, cross(tread.centre_m, tread.force_n), 1.0);
            gain = [plus(gain[0], tread.force_n, dt_s), plus(gain[1], turning_nm, dt_s)];
        }
        before = of(vehicle.state());
        for (i, seen) in [before.momentum, before.angular].into_iter().enumerate() {
            own[i] = plus(own[i], gain[i], 1.0);
            worst[i] = worst[i].max(length(plus(own[i], seen, -1.0)) / before.mass_kg);
            most[i] = most[i].max(length(seen) / before.mass_kg);
        }
    }
    [worst, most]
}

fn length(a: V3) -> f64 {
    a.iter().map(|c| c * c).sum::<f64>().sqrt()
}
