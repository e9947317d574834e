//! Tyres and masses of the fast core alone, driven by the whole vehicle's own signals.

#[path = "../../tests/tyre_rig/mod.rs"]
mod tyre_rig;

use glam::{DQuat, DVec3};
use xt28_machine::{GRAVITY_M_S2, Machine, PerWheel, Wheel};

use super::ReducedBodies;
use super::contact::Body;
use super::pose::{Generalized, Pose, State};
use super::spatial::{angular, linear};
use super::tests::momenta;
use super::touch::{Search, patch};
use super::tree::Tree;
use crate::{Actuation, Effects, Parts, Plant, STEP, Terrain, Vehicle};

/// The machines of the tyres' rig, the soft one with a load.
fn machines() -> [(Machine, Effects); 2] {
    let [nominal, mut soft] = tyre_rig::machines();
    soft.1.masses.payload.mass_kg = 5000.0;
    soft.1.masses.com_shift.y_m = 0.2;
    [nominal, soft]
}

/// Drives for 10 s in bends with all arms moving; `see` gets the state before and the bodies after each step.
fn drive(
    (machine, effects): &(Machine, Effects),
    terrain: &Terrain,
    mut see: impl FnMut(&State, &ReducedBodies),
) {
    let strokes_m = PerWheel::splat(0.17);
    let mut vehicle: Vehicle<ReducedBodies> =
        Vehicle::with(machine, effects, terrain, strokes_m, STEP);
    for step in 0..2000 {
        let t = f64::from(step) * STEP.as_secs_f64();
        let before = vehicle.bodies().state.clone();
        vehicle.step(&Actuation {
            arm_opening: PerWheel::from_fn(|w| 0.15 * (t + w.index() as f64).sin()),
            steer_opening: [0.3 * (0.8 * t).sin(), 0.2 * (0.8 * t - 0.5).sin()],
            pump_displacement: [(t / 2.0).min(1.0); 2],
            ..Actuation::idle(1200.0)
        });
        see(&before, vehicle.bodies());
    }
}

/// The velocities that the last step of `dt_s` s ended with, before the frame's velocity turned along with it.
pub(super) fn ended(after: &State, dt_s: f64) -> Generalized {
    let twist = core::array::from_fn(|k| after.rate[k]);
    let half = angular(&twist) * (0.5 * dt_s);
    let turn = DQuat::from_xyzw(half.x, half.y, half.z, 1.0).normalize();
    let mut rate = after.rate;
    rate[3..6].copy_from_slice(&(turn.inverse() * linear(&twist)).to_array());
    rate
}

/// Fed with where each wheel is when a step begins and how it moves when it ends, and with bristles of their own,
/// the tyres alone say the vehicle's ground force at every step, and where its bristles are. Tolerance: 1e-6 N of some
/// 40 kN and 1e-12 m, the rounding of contacts that are stiff against creep; nothing is hidden between them.
#[test]
fn tyres_alone_reproduce_the_whole() {
    let dt_s = STEP.as_secs_f64();
    for terrain in [Terrain::Flat, tyre_rig::rough()] {
        for made in &machines() {
            let tree = Tree::new(&Parts::new(&made.0, &made.1));
            let mut search = Search::new(terrain.clone());
            let (mut bristle_m, mut contacts) = ([[0.0; 2]; 6], Vec::new());
            let (mut worst_n, mut worst_m) = (0.0_f64, 0.0_f64);
            drive(made, &terrain, |before, bodies| {
                let state = State { bristle_m, ..before.clone() };
                let (pose, rate) = (Pose::new(&tree, &state), ended(&bodies.state, dt_s));
                search.contacts((&tree, &pose, &state), dt_s, &mut contacts);
                let frames = pose.frame_twists(&rate);
                for wheel in Wheel::ALL {
                    let i = wheel.index();
                    let arm = pose.arm_twist(i, &frames[Tree::frame_of(i)], &rate);
                    let twist = pose.wheel_twist(i, &arm, &rate);
                    let mut up_n = 0.0;
                    for contact in contacts.iter_mut().filter(|c| c.body == Body::Wheel(i)) {
                        contact.guess(&twist);
                        up_n += contact.impulse().z / dt_s;
                    }
                    let own = contacts.iter().filter(|c| c.body == Body::Wheel(i));
                    bristle_m[i] = patch(&tree, i, (&pose, &state), dt_s).end_m(own);
                    worst_n = worst_n.max((up_n - bodies.ground_force_n[wheel]).abs());
                    for (ours_m, m) in bristle_m[i].iter().zip(bodies.state.bristle_m[i]) {
                        worst_m = worst_m.max((ours_m - m).abs());
                    }
                }
            });
            assert!(worst_n < 1e-6, "{worst_n} N");
            assert!(worst_m < 1e-12, "{worst_m} m");
        }
    }
}

/// Linear momentum of all bodies in this state, kg m/s.
fn momentum(tree: &Tree, state: &State) -> DVec3 {
    momenta(tree, state, &state.rate).iter().map(|(_, momentum)| linear(momentum)).sum()
}

/// Fed with what the ground pushes with, the masses that the machine file and the effects name gain, alone and over
/// 10 s, the momentum that the vehicle's motion shows. Tolerance: 1 mm/s of the whole machine, of the 100 m/s that its weight
/// would make in that time: arms and frames turn on within a step.
#[test]
fn masses_alone_reproduce_the_whole() {
    let dt_s = STEP.as_secs_f64();
    for terrain in [Terrain::Flat, tyre_rig::rough()] {
        for made in &machines() {
            let tree = Tree::new(&Parts::new(&made.0, &made.1));
            let weight_n = GRAVITY_M_S2 * (made.0.mass_kg() + made.1.masses.payload.mass_kg);
            let mut gained: Option<DVec3> = None;
            let (mut worst, mut most) = (0.0_f64, 0.0_f64);
            drive(made, &terrain, |before, bodies| {
                let own = gained.get_or_insert_with(|| momentum(&tree, before));
                *own += bodies.contacts.iter().map(|c| c.impulse()).sum::<DVec3>();
                own.z -= weight_n * dt_s;
                let seen = momentum(&tree, &bodies.state);
                worst = worst.max((*own - seen).length());
                most = most.max(seen.length());
            });
            assert!(most > 5e3, "it moves with {most} kg m/s");
            assert!(worst < 1e-3 * tree.mass_kg, "{worst} kg m/s");
        }
    }
}
