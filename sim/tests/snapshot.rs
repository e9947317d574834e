//! A vehicle resumed from its own state against the snapshot that it is of.

#[path = "../examples/resume/drift.rs"]
mod drift;

use core::time::Duration;
use std::sync::Arc;

use drift::{Drift, drive, with_roll_hinge};
use xt28_machine::{Machine, PerWheel};
use xt28_sim::terrain::{Extent, Grid};
use xt28_sim::{
    Actuation, Effects, Loads, Parts, Placed, Plant, RapierBodies, ReducedBodies, STEP, Terrain,
    Vehicle,
};

/// A placed machine shows the state that it was placed at.
#[test]
fn what_is_resumed_shows_what_was_measured() {
    shows_what_was_measured::<RapierBodies>(1.0);
    // In double precision, so only rounding is left.
    shows_what_was_measured::<ReducedBodies>(1e-6);
}

/// `precision`: of the solver, against single precision.
fn shows_what_was_measured<B: Placed>(precision: f64) {
    let (vehicle, terrain) = drive::<B>(&Machine::xt28(), 10.0);
    let measured = *vehicle.state();
    let warm = Duration::from_millis(50);
    let resumed: Vehicle<B> = Drift::resumed(&Machine::xt28(), &measured, &terrain, 10.0, warm);
    let s = resumed.state();
    for (ours, theirs, bound) in [
        (s.position_m[0], measured.position_m[0], 1e-5),
        (s.position_m[2], measured.position_m[2], 1e-5),
        (s.roll_rad, measured.roll_rad, 1e-5),
        (s.pitch_rad, measured.pitch_rad, 1e-5),
        (s.yaw_rad, measured.yaw_rad, 1e-5),
        (s.joint_rad[0], measured.joint_rad[0], 1e-6),
        (s.antenna_velocity_m_s[0], measured.antenna_velocity_m_s[0], 1e-4),
        (s.antenna_velocity_m_s[2], measured.antenna_velocity_m_s[2], 1e-4),
        (s.stroke_m.mean(), measured.stroke_m.mean(), 1e-6),
        (s.cylinder_force_n.mean(), measured.cylinder_force_n.mean(), 5.0),
        (s.wheel_speed_rad_s.mean(), measured.wheel_speed_rad_s.mean(), 1e-6),
    ] {
        assert!((ours - theirs).abs() < bound * precision, "{ours}, not {theirs}");
    }
}

/// The drift that the documentation of `from_measured` and the example's table say.
#[test]
fn a_resumed_vehicle_stays_near_the_snapshot() {
    stays_near_the_snapshot::<RapierBodies>(&Machine::xt28(), [1e-3, 1.2e-3]);
}

/// The same on the fast core.
#[test]
fn a_resumed_vehicle_stays_near_the_snapshot_on_the_fast_core() {
    stays_near_the_snapshot::<ReducedBodies>(&Machine::xt28(), [1e-3, 1.2e-3]);
}

/// The front lies on the ramp with its roll hinge turned: taken up level, it would be centimetres off.
#[test]
fn a_resumed_vehicle_keeps_the_angle_of_its_roll_hinge() {
    let machine = with_roll_hinge();
    assert!(drive::<ReducedBodies>(&machine, 10.0).0.state().roll_hinge_rad.abs() > 0.01);
    stays_near_the_snapshot::<RapierBodies>(&machine, [3.5e-3, 5.5e-3]);
    stays_near_the_snapshot::<ReducedBodies>(&machine, [3.5e-3, 5.5e-3]);
}

/// Within `bounds` of stroke (m) and of roll and pitch (rad).
fn stays_near_the_snapshot<B: Placed>(machine: &Machine, bounds: [f64; 2]) {
    let [stroke_m, attitude_rad] = bounds;
    for at_s in [6.0, 10.0, 14.0] {
        let drift = Drift::of::<B>(machine, at_s, Duration::from_millis(50));
        let [one, five] = [drift.after_1_s, drift.after_5_s];
        assert!(one.stroke_m.max(five.stroke_m) < stroke_m, "{at_s} s: {drift:?}");
        let most_rad = one.attitude_rad.max(five.attitude_rad);
        assert!(most_rad < attitude_rad, "{at_s} s: {drift:?}");
        assert!(one.position_m < 0.012 && five.position_m < 0.03, "{at_s} s: {drift:?}");
        // What the tyres scrub at the joints no sensor shows.
        assert!(one.joint_rad < 0.012 && five.joint_rad < 0.012, "{at_s} s: {drift:?}");
    }
}

/// Both solvers spare themselves the search for the hull's contacts while they know the hull far from
/// the ground; that knowledge ends where the machine is put elsewhere.
#[test]
fn a_machine_put_over_a_stump_feels_it_at_once() {
    put_over_a_stump::<RapierBodies>();
    put_over_a_stump::<ReducedBodies>();
}

fn put_over_a_stump<B: Placed>() {
    // 0.6 m high, ahead of a machine whose underside is 0.38 m above the ground.
    let stump = |x: f64, y: f64| (2.6..=3.0).contains(&x) && y.abs() <= 0.2;
    let height_m = |x, y| if stump(x, y) { 0.6 } else { 0.0 };
    let terrain = Terrain::Grid(Arc::new(Grid::from_fn(Extent::default(), height_m)));
    let parts = Parts::new(&Machine::xt28(), &Effects::default());
    let mut bodies = B::new(&parts, &terrain, PerWheel::splat(0.05));
    bodies.advance(&Loads::default(), STEP.as_secs_f64());
    let mut motion = bodies.motion();
    assert_eq!(motion.chassis_force_n, 0.0);
    motion.position_m[0] += 3.5;
    bodies.place(&motion);
    bodies.advance(&Loads::default(), STEP.as_secs_f64());
    assert!(bodies.motion().chassis_force_n > 1e5, "{} N", bodies.motion().chassis_force_n);
}

/// In free fall nothing pushes: the front frame's centre of mass goes on as a stone does, however the
/// machine spins. (What a root's origin beside its centre of mass would break.)
#[test]
fn a_spinning_machine_falls_like_a_stone() {
    falls_like_a_stone::<RapierBodies>();
    falls_like_a_stone::<ReducedBodies>();
}

fn falls_like_a_stone<B: Placed>() {
    let (machine, terrain) = (Machine::xt28(), Terrain::Flat);
    let mut vehicle: Vehicle<B> =
        Vehicle::with(&machine, &Effects::default(), &terrain, PerWheel::splat(0.17), STEP);
    (0..400).for_each(|_| vehicle.step(&Actuation::idle(1200.0)));
    let mut thrown = *vehicle.state();
    thrown.position_m[2] += 30.0;
    thrown.front_rate_rad_s = [0.6, -0.4, 0.3];
    let actuation = Actuation::idle(1200.0);
    let mut vehicle: Vehicle<B> = Vehicle::from_measured(
        &machine,
        &Effects::default(),
        &terrain,
        STEP,
        &thrown,
        &actuation,
        Duration::ZERO,
    );
    // Frames, arms and wheels move against one another a little, so the front frame's centre of mass
    // is the whole machine's only within that.
    let com_m = |v: &Vehicle<B>| {
        let s = v.state();
        let [x, _, z] = machine.frames.front_com_m;
        let ((sp, cp), (_, cr)) = (s.pitch_rad.sin_cos(), s.roll_rad.sin_cos());
        s.position_m[2] + x * sp + z * cr * cp
    };
    let start = com_m(&vehicle);
    for _ in 0..300 {
        vehicle.step(&actuation);
    }
    let (end, t) = (com_m(&vehicle), 1.5);
    let fallen_m = start - end;
    assert!((fallen_m - 0.5 * 9.81 * t * t).abs() < 0.35, "{fallen_m} m");
}
