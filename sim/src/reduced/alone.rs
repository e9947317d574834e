//! Tyres and masses of the fast core alone, driven by the whole vehicle's own signals.

#[path = "../../tests/mass_rig/mod.rs"]
mod mass_rig;
#[path = "../../tests/tyre_rig/mod.rs"]
mod tyre_rig;

use glam::{DQuat, DVec3};
use xt28_machine::{GRAVITY_M_S2, Machine, PerWheel, Wheel};

use super::ReducedBodies;
use super::contact::Body;
use super::pose::{Generalized, Pose, State};
use super::spatial::{angular, linear};
use super::touch::{Search, patches};
use super::tree::Tree;
use crate::{Actuation, Effects, Parts, Plant, STEP, Terrain, Vehicle, VehicleState};

/// The machines of the tyres' rig, the soft one with a load.
fn machines() -> [(Machine, Effects); 2] {
    let [nominal, mut soft] = tyre_rig::machines();
    soft.1.masses.payload.mass_kg = 5000.0;
    soft.1.masses.com_shift.y_m = 0.2;
    [nominal, soft]
}

/// Drives for 10 s in bends with all arms moving; `see` gets the bodies' state before and the vehicle after each step.
fn drive(
    (machine, effects): &(Machine, Effects),
    terrain: &Terrain,
    mut see: impl FnMut(&State, &Vehicle<ReducedBodies>),
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
        see(&before, &vehicle);
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
/// the tyres alone say the vehicle's ground force in all three directions and its moment at every step, and where its
/// bristles are. Tolerance: 1e-6 N of some 40 kN, 1e-5 Nm about the front axle and 1e-12 m, the rounding of contacts that are stiff against creep; nothing is hidden between them.
#[test]
fn tyres_alone_reproduce_the_whole() {
    let dt_s = STEP.as_secs_f64();
    for terrain in [Terrain::Flat, tyre_rig::rough()] {
        for made in &machines() {
            let tree = Tree::new(&Parts::new(&made.0, &made.1));
            let mut search = Search::new(terrain.clone());
            let (mut bristle_m, mut contacts) = ([[0.0; 2]; 6], Vec::new());
            let (mut worst_n, mut worst_nm, mut worst_m) = (0.0_f64, 0.0_f64, 0.0_f64);
            let mut along_n = 0.0_f64;
            drive(made, &terrain, |before, vehicle| {
                let bodies = vehicle.bodies();
                let state = State { bristle_m, ..before.clone() };
                let (pose, rate) = (Pose::new(&tree, &state), ended(&bodies.state, dt_s));
                let patches = patches(&tree, (&pose, &state), dt_s);
                search.contacts((&tree, &pose, &state), &patches, dt_s, &mut contacts);
                let frames = pose.frame_twists(&rate);
                for wheel in Wheel::ALL {
                    let i = wheel.index();
                    let arm = pose.arm_twist(i, &frames[Tree::frame_of(i)], &rate);
                    let twist = pose.wheel_twist(i, &arm, &rate);
                    let own = contacts.iter_mut().filter(|c| c.body == Body::Wheel(i));
                    own.for_each(|contact| contact.guess(&twist));
                    let [ours, theirs] = [&contacts, &bodies.contacts].map(|contacts| {
                        let own = contacts.iter().filter(|c| c.body == Body::Wheel(i));
                        own.fold([DVec3::ZERO; 2], |[push, turn], c| {
                            [push + c.impulse() / dt_s, turn + c.moment() / dt_s]
                        })
                    });
                    let own = contacts.iter().filter(|c| c.body == Body::Wheel(i));
                    bristle_m[i] = patches[i].end_m(own);
                    let up_n = ours[0].z - bodies.ground_force_n[wheel];
                    worst_n = worst_n.max(up_n.abs()).max((ours[0] - theirs[0]).length());
                    worst_nm = worst_nm.max((ours[1] - theirs[1]).length());
                    along_n = along_n.max(ours[0].x.hypot(ours[0].y));
                    for (ours_m, m) in bristle_m[i].iter().zip(bodies.state.bristle_m[i]) {
                        worst_m = worst_m.max((ours_m - m).abs());
                    }
                }
            });
            assert!(along_n > 3e3, "pushed along by {along_n} N");
            assert!(worst_n < 1e-6 && worst_nm < 1e-5, "{worst_n} N, {worst_nm} Nm");
            assert!(worst_m < 1e-12, "{worst_m} m");
        }
    }
}

/// Fed with what the ground pushes and turns it with, the masses that the machine file and the effects name, alone and
/// over 10 s, gain the momentum and the angular momentum about a place in the world that the vehicle's signals show.
/// Tolerance: 1 mm/s and 0.01 m2/s of the whole machine, which weight alone would take to 100 m/s and some 300 m2/s in that
/// time: arms and frames turn on within a step.
#[test]
fn masses_alone_reproduce_the_whole() {
    let dt_s = STEP.as_secs_f64();
    for terrain in [Terrain::Flat, tyre_rig::rough()] {
        for made in &machines() {
            let of = |s: &VehicleState| mass_rig::sum(&made.0, &made.1.masses, s);
            let mut last: Option<(mass_rig::Sum, [DVec3; 2])> = None;
            let (mut worst, mut most) = ([0.0_f64; 2], [0.0_f64; 2]);
            drive(made, &terrain, |before, vehicle| {
                let (s, bodies) = (vehicle.state(), vehicle.bodies());
                let seen = of(s);
                let now = [seen.momentum, seen.angular].map(DVec3::from);
                if let Some((sum, own)) = &mut last {
                    let pushed: DVec3 = bodies.contacts.iter().map(|c| c.impulse()).sum();
                    let turned: DVec3 = bodies.contacts.iter().map(|c| c.moment()).sum();
                    let weight = DVec3::new(0.0, 0.0, -GRAVITY_M_S2 * dt_s);
                    own[0] += pushed + weight * sum.mass_kg;
                    own[1] += turned + before.position.cross(pushed);
                    own[1] += DVec3::from(sum.first_kg_m).cross(weight);
                    for i in 0..2 {
                        worst[i] = worst[i].max((own[i] - now[i]).length() / sum.mass_kg);
                        most[i] = most[i].max(now[i].length() / sum.mass_kg);
                    }
                }
                let own = last.map_or(now, |(_, own)| own);
                last = Some((seen, own));
            });
            assert!(most[0] > 0.3 && most[1] > 0.3, "it moves with {most:?} m/s, m2/s");
            assert!(worst[0] < 1e-3 && worst[1] < 0.01, "{worst:?} m/s, m2/s of {most:?}");
        }
    }
}
