//! The tyre's block alone, fed with how the whole vehicle's wheels meet the ground.

mod overheard;
mod tyre_rig;

use overheard::Overheard;
use tyre_rig::{machines, rough};
use xt28_machine::{Machine, PerWheel, Wheel};
use xt28_sim::{
    Actuation, Bodies, Effects, Loads, Parts, PatchInput, PatchState, Patches, Plant, RapierBodies,
    STEP, Terrain, Tread, Tyre, Vehicle, VehicleState,
};

type V3 = [f64; 3];

/// Throttle, weaving steering and all arms.
fn driven(t: f64) -> Actuation {
    Actuation {
        arm_opening: PerWheel::from_fn(|w| 0.15 * (t + w.index() as f64).sin()),
        steer_opening: [0.3 * (0.8 * t).sin(), 0.2 * (0.8 * t - 0.5).sin()],
        pump_displacement: [(t / 2.0).min(1.0); 2],
        ..Actuation::idle(1200.0)
    }
}

type Driven = Vehicle<Overheard<RapierBodies>>;

/// Drives for 10 s; `see` gets the state before and the vehicle after each step.
fn drive(
    (machine, effects): &(Machine, Effects),
    terrain: &Terrain,
    mut see: impl FnMut(&VehicleState, &Driven),
) {
    let strokes = PerWheel::splat(0.17);
    let mut vehicle: Driven = Vehicle::with(machine, effects, terrain, strokes, STEP);
    for step in 0..2000 {
        let before = *vehicle.state();
        vehicle.step(&driven(f64::from(step) * STEP.as_secs_f64()));
        see(&before, &vehicle);
    }
}

/// What the patches push the wheel with, N, and turn it with about its centre, Nm. Forces along the ground act where
/// half the deflection has left the radius.
fn push(tread: &Tread, states: &[PatchState], radius_m: f64) -> [V3; 2] {
    let mut sum = [[0.0; 3]; 2];
    for (PatchInput { normal, depth_m, .. }, state) in tread.patches().iter().zip(states) {
        let forward = unit(cross(tread.axle, *normal));
        let left = cross(*normal, forward);
        let force_n: V3 = core::array::from_fn(|k| {
            state.load_n * normal[k] + state.along_n[0] * forward[k] + state.along_n[1] * left[k]
        });
        let lever_m = normal.map(|n| -(radius_m - 0.5 * depth_m) * n);
        for (sum, more) in sum.iter_mut().zip([force_n, cross(lever_m, force_n)]) {
            *sum = core::array::from_fn(|k| sum[k] + more[k]);
        }
    }
    sum
}

fn apart(a: V3, b: V3) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// Fed with the depth, its rate, the slip and the rolling of each point touched, the tyres alone say with what force, in
/// all three directions, and with what torque the ground pushes every wheel at every step. Tolerances: 0.1 N and 0.1 Nm
/// of some 40 kN and 30 kNm, the engine's single precision; nothing is hidden between them.
#[test]
fn tyres_alone_reproduce_the_whole() {
    let dt_s = STEP.as_secs_f64();
    for (terrain, most) in [(Terrain::Flat, 1), (rough(), 2)] {
        for made in &machines() {
            let parts = Parts::new(&made.0, &made.1);
            let turns_kg = parts.wheel.inertia_kg_m2[1] / (parts.radius_m * parts.radius_m);
            let tyres = parts.tyres.map(|tyre| Tyre::new(&tyre, [parts.wheel.mass_kg, turns_kg]));
            let mut alone = PerWheel::splat(Patches::default());
            let (mut touched, mut worst) = (0, [0.0_f64; 3]);
            let (mut along_n, mut across_n) = (0.0_f64, 0.0_f64);
            drive(made, &terrain, |_, vehicle| {
                for w in Wheel::ALL {
                    let tread = vehicle.bodies().bodies.tread(w);
                    alone[w] = tyres[w].step(alone[w].states(), tread.patches(), dt_s);
                    touched = touched.max(tread.patches().len());
                    let [force_n, torque_nm] = push(tread, alone[w].states(), parts.radius_m);
                    for state in alone[w].states() {
                        along_n = along_n.max(state.along_n[0].abs());
                        across_n = across_n.max(state.along_n[1].abs());
                    }
                    for (worst, off) in worst.iter_mut().zip([
                        apart(force_n, tread.force_n),
                        (tread.force_n[2] - vehicle.state().ground_force_n[w]).abs(),
                        apart(torque_nm, tread.torque_nm),
                    ]) {
                        *worst = worst.max(off);
                    }
                }
            });
            assert!(touched >= most, "wheels touch in {touched} points at most");
            assert!(along_n > 2e3 && across_n > 3e3, "pushed along by {along_n}, {across_n} N");
            assert!(worst.iter().all(|off| *off < 0.1), "{worst:?} N, N, Nm");
        }
    }
}

/// A wheel's turning gains what motor, ground and rolling resistance turn it with, alone over each step; the last is all
/// there is of it on a wheel that rolls. Tolerance: 10 Nm of a thousand, to
/// which the engine's single precision tells an arm's turning.
#[test]
fn the_drive_line_alone_reproduces_how_wheels_turn() {
    let dt_s = STEP.as_secs_f64();
    for terrain in [Terrain::Flat, rough()] {
        for made in &machines() {
            let parts = Parts::new(&made.0, &made.1);
            let inertia_kg_m2 = parts.wheel.inertia_kg_m2[1];
            let mut last: PerWheel<Option<f64>> = PerWheel::splat(None);
            let (mut worst_nm, mut turned_nm) = (0.0_f64, 0.0_f64);
            drive(made, &terrain, |_, vehicle| {
                let (s, motion) = (vehicle.state(), vehicle.bodies().motion());
                for w in Wheel::ALL {
                    let tread = vehicle.bodies().bodies.tread(w);
                    let Loads { drive_nm, drag, .. } = &vehicle.bodies().loads;
                    let (drag_nm, most_nm) = (tread.drag_nm, drag[w].most_nm);
                    let turning_nm = drive_nm[w] + drag_nm + dot(tread.torque_nm, tread.axle);
                    let speed_rad_s = s.wheel_speed_rad_s[w];
                    let off_nm = (drag_nm + most_nm.copysign(speed_rad_s)).abs();
                    let is_all = speed_rad_s.abs() < 0.5 || off_nm < 0.1;
                    assert!(is_all && drag_nm.abs() <= most_nm, "{drag_nm} of {most_nm} Nm");
                    let arm_rad_s = parts.arms[w].extends * motion.arm[w].rate_rad_s;
                    let rate_rad_s = s.wheel_speed_rad_s[w] + arm_rad_s + frame_rad_s(s, w);
                    if let Some(last_rad_s) = last[w].replace(rate_rad_s) {
                        let gained_nm = inertia_kg_m2 * (rate_rad_s - last_rad_s) / dt_s;
                        worst_nm = worst_nm.max((gained_nm - turning_nm).abs());
                        turned_nm = turned_nm.max(turning_nm.abs());
                    }
                }
            });
            assert!(turned_nm > 5e2, "turned with {turned_nm} Nm at most");
            assert!(worst_nm < 10.0, "{worst_nm} Nm");
        }
    }
}

/// How fast the frame that carries this wheel turns about the wheel's axle, rad/s.
fn frame_rad_s(s: &VehicleState, wheel: Wheel) -> f64 {
    // Frames behind a joint are turned right where the machine bends left.
    let bent_rad: f64 = s.joint_rad[..wheel.axle() as usize].iter().sum();
    let [x, y, _] = s.front_rate_rad_s;
    x * bent_rad.sin() + y * bent_rad.cos()
}

/// What the blocks are fed is how the machine is seen to move: the depth follows from position,
/// attitude and stroke, its rate and the slip from how the front wheels' centres travel.
#[test]
fn what_the_tyres_are_fed_is_how_the_wheels_move() {
    let dt_s = STEP.as_secs_f64();
    // Where the ground leans sideways, a wheel that turns about it slips a little besides.
    for (terrain, slip_bound_m_s) in [(Terrain::Flat, 1e-3), (rough(), 0.03)] {
        for made in &machines() {
            let parts = Parts::new(&made.0, &made.1);
            let mut last: [Option<V3>; 2] = [None; 2];
            let mut worst = [0.0_f64; 3];
            drive(made, &terrain, |before, vehicle| {
                for (i, w) in [Wheel::Fr, Wheel::Fl].into_iter().enumerate() {
                    let centre = place(before, parts.wheel_centres_m(before.stroke_m)[w]);
                    let tread = vehicle.bodies().bodies.tread(w);
                    let deepest =
                        |a: &&PatchInput, b: &&PatchInput| a.depth_m.total_cmp(&b.depth_m);
                    let patch = tread.patches().iter().max_by(deepest);
                    if let (Some(patch), Some(last)) = (patch, last[i]) {
                        let near = terrain.nearest(centre, parts.radius_m);
                        let distances = near.points().iter().map(|near| near.distance_m);
                        let depth_m = parts.radius_m - distances.fold(f64::MAX, f64::min);
                        let velocity: V3 = core::array::from_fn(|k| (centre[k] - last[k]) / dt_s);
                        let forward = unit(cross(tread.axle, patch.normal));
                        let slip_m_s = dot(velocity, forward)
                            - (1.0 - parts.tyres[w].slip) * patch.rolling_m_s;
                        for (worst, apart) in worst.iter_mut().zip([
                            patch.depth_m - depth_m,
                            patch.depth_rate_m_s + dot(velocity, patch.normal),
                            patch.slip_m_s[0] - slip_m_s,
                        ]) {
                            *worst = worst.max(apart.abs());
                        }
                    }
                    last[i] = Some(centre);
                }
            });
            let [depth_m, rate_m_s, slip_m_s] = worst;
            assert!(depth_m < 5e-5, "{depth_m} m");
            assert!(rate_m_s < 1e-3, "{rate_m_s} m/s");
            assert!(slip_m_s < slip_bound_m_s, "{slip_m_s} m/s");
        }
    }
}

/// A point of the front frame in the world.
fn place(s: &VehicleState, point: V3) -> V3 {
    let [(sp, cp), (sr, cr), (sy, cy)] = [s.pitch_rad, s.roll_rad, s.yaw_rad].map(f64::sin_cos);
    // Axes of a frame that is turned, then lifted by the nose, then by its right side.
    let x = [cp * cy, cp * sy, sp];
    let y = [-sy * cr + cy * sp * sr, cy * cr + sy * sp * sr, -sr * cp];
    let z = cross(x, y);
    core::array::from_fn(|k| s.position_m[k] + point[0] * x[k] + point[1] * y[k] + point[2] * z[k])
}

fn dot(a: V3, b: V3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: V3, b: V3) -> V3 {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn unit(a: V3) -> V3 {
    a.map(|component| component / dot(a, a).sqrt())
}
