//! Frames against the ground: the terminal condition, and a machine that has tipped over.

use std::sync::Arc;

use xt28_machine::{Machine, PerWheel, Wheel};
use xt28_sim::terrain::{Extent, Grid};
use xt28_sim::{
    Actuation, Bodies, Effects, Loads, Parts, Placed, Plant, RapierBodies, ReducedBodies, STEP,
    Terrain, Vehicle, VehicleState,
};

/// A stump between the wheels, from 2.6 m ahead of the front axle: its top is at `height_m` from `right_m`
/// to `left_m` of the centre line.
fn stump(height_m: f64, [right_m, left_m]: [f64; 2]) -> Terrain {
    let on_it = |x: f64, y: f64| (2.6..=3.0).contains(&x) && (right_m..=left_m).contains(&y);
    let extent = Extent { x_m: [-10.0, 15.0], y_m: [-5.0, 5.0] };
    Terrain::Grid(Arc::new(Grid::from_fn(extent, |x, y| if on_it(x, y) { height_m } else { 0.0 })))
}

/// Stands 2 s, then drives over what lies ahead; every state.
fn drive<B: Bodies>(terrain: &Terrain, stroke_m: f64, seconds: f64) -> Vec<VehicleState> {
    let (machine, effects) = (Machine::xt28(), Effects::default());
    let strokes = PerWheel::splat(stroke_m);
    let mut vehicle = Vehicle::<B>::with(&machine, &effects, terrain, strokes, STEP);
    let steps = (seconds / STEP.as_secs_f64()) as u32;
    let pump = |step: u32| ((f64::from(step) * STEP.as_secs_f64() - 2.0) / 2.0).clamp(0.0, 1.0);
    let states = (0..steps).map(|step| {
        vehicle.step(&Actuation { pump_displacement: [pump(step); 2], ..Actuation::idle(1200.0) });
        *vehicle.state()
    });
    states.collect()
}

#[test]
fn a_stump_is_felt_when_the_underside_reaches_it_and_not_before() {
    let machine = Machine::xt28();
    let parts = Parts::new(&machine, &Effects::default());
    let foremost = parts.hulls[0].iter().filter(|ball| ball.radius_m > 0.2);
    let foremost_m = foremost.map(|b| b.centre_m[0]).fold(f64::MIN, f64::max);
    // With the arms at 0.05 m the underside is 0.38 m above level ground.
    let states = drive::<RapierBodies>(&stump(0.5, [-0.2, 0.2]), 0.05, 9.0);
    let touch = states.iter().find(|s| s.chassis_force_n > 0.0).expect("it grounds");
    let reach_m = 2.6 - touch.position_m[0] - foremost_m;
    assert!((0.0..0.5).contains(&reach_m), "touched with {reach_m} m to go");
    let stuck = states.last().unwrap().position_m[0];
    assert!(stuck < 2.6, "it drove through: {stuck} m");
}

#[test]
fn the_same_stump_passes_under_a_machine_that_stands_high() {
    let states = drive::<RapierBodies>(&stump(0.5, [-0.2, 0.2]), 0.3, 12.0);
    assert!(states.last().unwrap().position_m[0] > 3.0, "it got there");
    assert!(states.iter().all(|s| s.chassis_force_n == 0.0));
}

/// A stake that is one point of the grid wide, 0.12 m higher than the underside, wherever it stands between
/// the tyres.
#[test]
fn a_stake_is_felt_wherever_it_stands_between_the_tyres() {
    for y_m in [-0.4, -0.2, 0.0, 0.1, 0.3] {
        let stake = stump(0.5, [y_m - 0.01, y_m + 0.01]);
        let felt = |states: &[VehicleState]| states.iter().any(|s| s.chassis_force_n > 1e4);
        assert!(felt(&drive::<RapierBodies>(&stake, 0.05, 6.0)), "{y_m} m, rapier");
        assert!(felt(&drive::<ReducedBodies>(&stake, 0.05, 6.0)), "{y_m} m, fast core");
    }
}

/// A machine without oil drops on its belly. At 60 Hz the engine makes a step of four: what is told is
/// their mean, as of the wheels.
#[test]
fn a_long_step_tells_the_mean_force_on_the_frames() {
    let parts = Parts::new(&Machine::xt28(), &Effects::default());
    let limp = Loads::default();
    let mut whole = RapierBodies::new(&parts, &Terrain::Flat, PerWheel::splat(0.17));
    let mut quarters = whole.clone();
    let (mut most_n, mut apart_n) = (0.0_f64, 0.0_f64);
    for step in 0..120 {
        whole.advance(&limp, 1.0 / 60.0);
        let forces_n = [(); 4].map(|()| {
            quarters.advance(&limp, 1.0 / 60.0 / 4.0);
            quarters.motion().chassis_force_n
        });
        let told_n = whole.motion().chassis_force_n;
        let mean_n = forces_n.iter().sum::<f64>() / 4.0;
        assert!((told_n - mean_n).abs() <= 1e-9 * mean_n, "{step}: {told_n} N, not {mean_n} N");
        (most_n, apart_n) = (most_n.max(mean_n), apart_n.max((mean_n - forces_n[3]).abs()));
    }
    assert!(most_n > 1e5 && apart_n > 1e4, "{most_n} N, {apart_n} N off its last quarter");
}

/// How deep the front frame's outside is in the leaning ground, m.
fn depth_m(parts: &Parts, s: &VehicleState) -> f64 {
    let (sp, cp) = s.pitch_rad.sin_cos();
    let (sr, cr) = s.roll_rad.sin_cos();
    let (sy, cy) = s.yaw_rad.sin_cos();
    // Yaw, then nose up, then right side high: columns are the frame's axes in the world.
    let x = [cp * cy, cp * sy, sp];
    let y = [-sy * cr + cy * sp * sr, cy * cr + sy * sp * sr, -sr * cp];
    let z = [-sy * sr - cy * sp * cr, cy * sr - sy * sp * cr, cr * cp];
    let tilt = parts.tilt.unwrap();
    let depth = parts.hulls[0].iter().map(|ball| {
        let c = ball.centre_m;
        let at = |i: usize| s.position_m[i] + c[0] * x[i] + c[1] * y[i] + c[2] * z[i];
        ball.radius_m - tilt.to_ground([at(0), at(1), at(2)])[2]
    });
    depth.fold(f64::MIN, f64::max)
}

/// On a bank of 52 degrees with grip to spare the machine tips over its lower wheels and rolls down
/// on cab and frames: nothing sinks in, and it falls no faster than it has fallen far.
#[test]
fn a_bank_too_steep_rolls_the_machine_over_and_the_ground_stops_it() {
    let machine = Machine::xt28();
    let mut effects = Effects::default();
    effects.slope.grade_y_rad = 0.9;
    for wheel in Wheel::ALL {
        effects.wheels[wheel].slippery_ground.friction_factor = 2.0;
    }
    let parts = Parts::new(&machine, &effects);
    let mut vehicle: Vehicle =
        Vehicle::with(&machine, &effects, &Terrain::Flat, PerWheel::splat(0.17), STEP);
    let (mut landed, mut turned) = (false, 0.0_f64);
    for step in 0..800 {
        let before = vehicle.state().position_m;
        vehicle.step(&Actuation { brake_released: false, ..Actuation::idle(1200.0) });
        let s = vehicle.state();
        assert!(s.position_m.iter().chain(&s.front_rate_rad_s).all(|v| v.is_finite()));
        landed |= s.chassis_force_n > 1e5;
        turned = turned.max(s.roll_rad.abs());
        let depth_m = depth_m(&parts, s);
        assert!(depth_m < 0.1, "{step}: {depth_m} m deep");
        let way_m = before.iter().zip(s.position_m).map(|(a, b)| (b - a).powi(2)).sum::<f64>();
        let speed_m_s = way_m.sqrt() / STEP.as_secs_f64();
        // The origin is 2 m from the centre of mass and swings about it.
        let swing_m_s = 2.0 * s.front_rate_rad_s.iter().map(|w| w * w).sum::<f64>().sqrt();
        let fallen_m = 2.0 - s.position_m[2];
        let fall_m_s = (2.0 * 9.81 * fallen_m).sqrt();
        assert!(speed_m_s < fall_m_s + swing_m_s, "{step}: {speed_m_s} m/s");
    }
    assert!(landed && turned > 1.6, "landed {landed}, turned by {turned} rad");
}

/// Laid on its side and on its roof, the machine comes to rest on the ground and the ground carries it.
#[test]
fn a_machine_that_lies_down_stays_on_the_ground() {
    lies_still::<RapierBodies>();
    lies_still::<ReducedBodies>();
}

fn lies_still<B: Bodies + Placed>() {
    let (machine, effects) = (Machine::xt28(), Effects::default());
    let idle = Actuation { brake_released: false, ..Actuation::idle(1200.0) };
    let weight_n = machine.mass_kg() * xt28_machine::GRAVITY_M_S2;
    for (roll_rad, up_m) in [(1.4, 1.7), (-1.4, 1.7), (3.0, 3.4)] {
        let mut lying = *Vehicle::new(&machine, &Terrain::Flat, PerWheel::splat(0.17)).state();
        lying.roll_rad = roll_rad;
        lying.position_m[2] = up_m;
        let mut vehicle = Vehicle::<B>::from_measured(
            &machine,
            &effects,
            &Terrain::Flat,
            STEP,
            &lying,
            &idle,
            core::time::Duration::ZERO,
        );
        let (mut carried_n, mut on_hull_n) = (0.0, [f64::INFINITY, 0.0_f64]);
        for step in 0..2000 {
            vehicle.step(&idle);
            let s = vehicle.state();
            assert!(s.position_m.iter().all(|m| m.is_finite() && m.abs() < 20.0), "{step}");
            if step >= 1800 {
                carried_n += (s.chassis_force_n + s.ground_force_n.sum()) / 200.0;
                let [least_n, most_n] = on_hull_n;
                on_hull_n = [least_n.min(s.chassis_force_n), most_n.max(s.chassis_force_n)];
            }
        }
        let s = vehicle.state();
        assert!((carried_n / weight_n - 1.0).abs() < 0.1, "{roll_rad}: {carried_n} N");
        // Parts that touch the ground at once are all found at every step: what lies still is pushed evenly.
        let [least_n, most_n] = on_hull_n;
        assert!(most_n - least_n < 0.05 * weight_n, "{roll_rad}: {on_hull_n:?} N");
        let turning = s.front_rate_rad_s.iter().fold(0.0_f64, |most, w| most.max(w.abs()));
        assert!(turning < 0.05, "{roll_rad}: {:?}", s.front_rate_rad_s);
        assert!(s.position_m[2] > 0.5, "{roll_rad}: {:?}", s.position_m);
    }
}
