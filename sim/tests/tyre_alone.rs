//! The tyre's block alone, fed with how the whole vehicle's wheels meet the ground.

mod tyre_rig;

use tyre_rig::{machines, rough};
use xt28_machine::{Machine, PerWheel, Wheel};
use xt28_sim::{
    Actuation, Effects, Parts, PatchInput, PatchState, Patches, Plant, RapierBodies, STEP, Terrain,
    Tread, Tyre, Vehicle, VehicleState,
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

/// Drives for 10 s; `see` gets the state before and the vehicle after each step.
fn drive(
    (machine, effects): &(Machine, Effects),
    terrain: &Terrain,
    mut see: impl FnMut(&VehicleState, &Vehicle<RapierBodies>),
) {
    let strokes = PerWheel::splat(0.17);
    let mut vehicle: Vehicle<RapierBodies> =
        Vehicle::with(machine, effects, terrain, strokes, STEP);
    for step in 0..2000 {
        let before = *vehicle.state();
        vehicle.step(&driven(f64::from(step) * STEP.as_secs_f64()));
        see(&before, &vehicle);
    }
}

/// What the patches push the wheel up with, N.
fn up_n(tread: &Tread, states: &[PatchState]) -> f64 {
    let each = tread.patches().iter().zip(states).map(|(PatchInput { normal, .. }, state)| {
        let forward = unit(cross(tread.axle, *normal));
        let left = cross(*normal, forward);
        state.load_n * normal[2] + state.along_n[0] * forward[2] + state.along_n[1] * left[2]
    });
    each.sum()
}

/// Fed with the depth, its rate, the slip and the rolling of each point touched, the tyres alone say
/// the vehicle's ground force under every wheel at every step. Tolerance: 0.1 N of some 40 kN, the
/// engine's single precision; nothing is hidden between them.
#[test]
fn tyres_alone_reproduce_the_whole() {
    let dt_s = STEP.as_secs_f64();
    for (terrain, most) in [(Terrain::Flat, 1), (rough(), 2)] {
        for made in &machines() {
            let parts = Parts::new(&made.0, &made.1);
            let turns_kg = parts.wheel.inertia_kg_m2[1] / (parts.radius_m * parts.radius_m);
            let tyres = parts.tyres.map(|tyre| Tyre::new(&tyre, [parts.wheel.mass_kg, turns_kg]));
            let mut alone = PerWheel::splat(Patches::default());
            let (mut step, mut touched) = (0, 0);
            drive(made, &terrain, |_, vehicle| {
                for w in Wheel::ALL {
                    let tread = vehicle.bodies().tread(w);
                    alone[w] = tyres[w].step(alone[w].states(), tread.patches(), dt_s);
                    touched = touched.max(tread.patches().len());
                    let (ours_n, n) =
                        (up_n(tread, alone[w].states()), vehicle.state().ground_force_n[w]);
                    assert!((ours_n - n).abs() < 0.1, "{w} {step}: {ours_n} N, not {n} N");
                }
                step += 1;
            });
            assert!(touched >= most, "wheels touch in {touched} points at most");
        }
    }
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
                    let tread = vehicle.bodies().tread(w);
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
