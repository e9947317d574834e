//! The fast core behind the vehicle: statics, the reference solver, snapshots.

use std::sync::Arc;
use std::time::Duration;

use xt28_machine::{Axle, GRAVITY_M_S2, Machine, PerWheel, Side, Wheel};
use xt28_sim::terrain::{Extent, Grid};
use xt28_sim::{
    Actuation, Bodies, Effects, Plant, Ramp, RapierBodies, ReducedBodies, Terrain, Vehicle,
    VehicleState,
};

fn idle() -> Actuation {
    Actuation::idle(1200.0)
}

fn vehicle<B: Bodies>(machine: &Machine, terrain: &Terrain, rate_hz: u32) -> Vehicle<B> {
    let step = Duration::from_secs_f64(1.0 / f64::from(rate_hz));
    Vehicle::with(machine, &Effects::default(), terrain, PerWheel::splat(0.17), step)
}

/// Steps for `seconds` of an actuation over time.
fn run(
    plant: &mut impl Plant,
    rate_hz: u32,
    seconds: f64,
    actuation: impl Fn(f64) -> Actuation,
) -> Vec<VehicleState> {
    (0..(seconds * f64::from(rate_hz)).round() as u32)
        .map(|step| {
            plant.step(&actuation(f64::from(step) / f64::from(rate_hz)));
            *plant.state()
        })
        .collect()
}

fn settled<B: Bodies>(terrain: &Terrain, rate_hz: u32) -> Vehicle<B> {
    settled_machine(&Machine::xt28(), terrain, rate_hz)
}

fn settled_machine<B: Bodies>(machine: &Machine, terrain: &Terrain, rate_hz: u32) -> Vehicle<B> {
    let mut vehicle = vehicle(machine, terrain, rate_hz);
    run(&mut vehicle, rate_hz, 4.0, |_| idle());
    vehicle
}

/// Drives off, turns left and right, moves the arms.
fn lively(t: f64) -> Actuation {
    Actuation {
        pump_displacement: [(t / 2.0).min(1.0); 2],
        steer_opening: [0.3 * (0.8 * t).sin(), 0.2 * (0.8 * t - 0.5).sin()],
        arm_opening: PerWheel::from_fn(|w| 0.15 * (t + w.index() as f64).sin()),
        ..idle()
    }
}

/// Slopes of some 15 degrees, hollows and crests of a few metres.
fn gentle() -> Terrain {
    Terrain::Grid(Arc::new(Grid::from_fn(Extent::default(), |x, y| {
        0.15 * (1.1 * x).sin() * (0.9 * y + 0.4).cos() + 0.02 * (3.0 * x - 2.0 * y).sin()
    })))
}

fn field_ramp() -> Terrain {
    Terrain::ramp(&Ramp { x_m: [4.0, 7.0, 8.5, 11.5], height_m: 0.3, y_min_m: -1.9, y_max_m: -0.5 })
}

#[test]
fn the_ground_carries_the_weight_and_each_tyre_sags_by_its_share() {
    let machine = Machine::xt28();
    let mut vehicle = vehicle::<ReducedBodies>(&machine, &Terrain::Flat, 120);
    run(&mut vehicle, 120, 20.0, |_| Actuation { brake_released: false, ..idle() });
    let s = vehicle.state();
    let weight_n = machine.mass_kg() * GRAVITY_M_S2;
    assert!((s.ground_force_n.sum() / weight_n - 1.0).abs() < 1e-6);
    let linkage = machine.linkage();
    for wheel in Wheel::ALL {
        let x_m = machine.wheels.axle_x_m[wheel.axle() as usize];
        let drop_m = linkage.at_stroke(s.stroke_m[wheel]).drop_m - linkage.at_stroke(0.25).drop_m;
        let sag_m = drop_m - s.position_m[2] - x_m * s.pitch_rad.sin();
        let wanted_m = s.ground_force_n[wheel] / machine.vehicle.tyre_stiffness_n_m;
        // The wheel swings about its pivot as well, which moves it along the slope of the frame.
        assert!((sag_m - wanted_m).abs() < 5e-4, "{wheel}: {sag_m} m, not {wanted_m} m");
    }
}

#[test]
fn rolling_takes_the_torque_of_the_rolling_resistance_at_any_step() {
    let machine = Machine::xt28();
    for rate_hz in [60, 120, 200] {
        let mut vehicle = settled::<ReducedBodies>(&Terrain::Flat, rate_hz);
        run(&mut vehicle, rate_hz, 10.0, |_| Actuation { pump_displacement: [1.0; 2], ..idle() });
        let torque_nm = vehicle.state().wheel_torque_nm.sum();
        let w = &machine.wheels;
        let wanted_nm = w.rolling_resistance * machine.mass_kg() * GRAVITY_M_S2 * w.radius_m;
        assert!((torque_nm / wanted_nm - 1.0).abs() < 2e-3, "{rate_hz} Hz: {torque_nm} Nm");
    }
}

/// Largest distance between the paths of two solvers, m.
fn apart(one: &[VehicleState], other: &[VehicleState]) -> f64 {
    let distance = |(a, b): (&VehicleState, &VehicleState)| {
        let squares = a.position_m.iter().zip(b.position_m).map(|(a, b)| (a - b).powi(2));
        squares.sum::<f64>().sqrt()
    };
    one.iter().zip(other).map(distance).fold(0.0, f64::max)
}

fn against_rapier(terrain: &Terrain, actuation: impl Fn(f64) -> Actuation) -> f64 {
    let mut reference = settled::<RapierBodies>(terrain, 200);
    let mut fast = settled::<ReducedBodies>(terrain, 200);
    let reference = run(&mut reference, 200, 10.0, &actuation);
    apart(&reference, &run(&mut fast, 200, 10.0, &actuation))
}

#[test]
fn it_stands_drives_turns_and_climbs_where_the_reference_does() {
    let drive = |t: f64| Actuation { pump_displacement: [(t / 2.0).min(1.0); 2], ..idle() };
    let cases = [
        ("stand", against_rapier(&Terrain::Flat, |_| idle()), 0.001),
        ("straight", against_rapier(&Terrain::Flat, drive), 0.002),
        ("turn", against_rapier(&Terrain::Flat, lively), 0.02),
        ("ramp", against_rapier(&field_ramp(), drive), 0.005),
        ("gentle", against_rapier(&gentle(), drive), 0.01),
    ];
    for (name, apart_m, bound_m) in cases {
        assert!(apart_m < bound_m, "{name}: {apart_m} m apart, {bound_m} m allowed");
    }
}

/// Roll of a machine with a roll hinge on the field ramp, on the reference and on the fast core, degrees.
fn rolls_deg(max_deg: f64) -> [Vec<f64>; 2] {
    let mut machine = Machine::xt28();
    machine.vehicle.roll_hinge = true;
    machine.vehicle.roll_hinge_stiffness_nm = 2.0e5;
    machine.vehicle.roll_hinge_max_deg = max_deg;
    let drive = |t: f64| Actuation { pump_displacement: [(t / 2.0).min(1.0); 2], ..idle() };
    let roll_deg = |states: &[VehicleState]| -> Vec<f64> {
        states.iter().map(|s| s.roll_rad.to_degrees()).collect()
    };
    let ramp = field_ramp();
    let mut reference = settled_machine::<RapierBodies>(&machine, &ramp, 200);
    let mut fast = settled_machine::<ReducedBodies>(&machine, &ramp, 200);
    [roll_deg(&run(&mut reference, 200, 14.0, drive)), roll_deg(&run(&mut fast, 200, 14.0, drive))]
}

#[test]
fn a_front_frame_that_may_roll_rolls_as_in_the_reference() {
    let [reference, fast] = rolls_deg(15.0);
    let most = |roll_deg: &[f64]| roll_deg.iter().copied().fold(0.0, f64::max);
    let apart = |one: &[f64], other: &[f64]| {
        one.iter().zip(other).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    };
    // 0.3 m over a track of 2.35 m is 7.3 degrees, and the spring holds some of that back.
    assert!((5.0..7.3).contains(&most(&fast)), "{} degrees", most(&fast));
    assert!(apart(&fast, &reference) < 0.2, "{} degrees apart", apart(&fast, &reference));
    // The same law stops both.
    let [stopped, stopped_fast] = rolls_deg(2.0);
    assert!(apart(&stopped, &reference) > 0.5, "{} degrees of stop", apart(&stopped, &reference));
    let apart = apart(&stopped_fast, &stopped);
    assert!(apart < 0.05, "{apart} degrees apart at the stop");
}

/// A machine with a roll hinge, on which diagonal arms part, stood for 4 s and then bent and driven.
fn bent_states<B: Bodies>() -> Vec<VehicleState> {
    let mut machine = Machine::xt28();
    machine.vehicle.roll_hinge = true;
    machine.vehicle.roll_hinge_stiffness_nm = 2.0e5;
    let diagonal = |w: Wheel| match (w.axle(), w.side()) {
        (Axle::Middle, _) => 0.0,
        (Axle::Front, Side::Left) | (Axle::Rear, Side::Right) => 0.3,
        _ => -0.3,
    };
    let bend = |t: f64| Actuation {
        pump_displacement: [(t / 2.0).min(1.0); 2],
        steer_opening: if t < 4.0 { [0.5, 0.3] } else { [0.0; 2] },
        arm_opening: if t < 3.0 { PerWheel::from_fn(diagonal) } else { PerWheel::splat(0.0) },
        ..idle()
    };
    run(&mut settled_machine::<B>(&machine, &Terrain::Flat, 200), 200, 10.0, bend)
}

#[test]
fn a_roll_hinge_stays_with_the_front_frame_in_a_bend_as_in_the_reference() {
    let [reference, fast] = [bent_states::<RapierBodies>(), bent_states::<ReducedBodies>()];
    let most = |of: &dyn Fn(&VehicleState) -> f64| fast.iter().map(of).fold(0.0, f64::max);
    let hinge_deg = most(&|s| s.roll_hinge_rad.abs().to_degrees());
    let joint_deg = most(&|s| s.joint_rad[0].abs().to_degrees());
    assert!(hinge_deg > 3.0 && joint_deg > 20.0, "{hinge_deg} and {joint_deg} degrees");
    for (a, b) in reference.iter().zip(&fast) {
        let apart = [a.roll_rad - b.roll_rad, a.pitch_rad - b.pitch_rad];
        let apart_deg = apart.map(|rad| rad.abs().to_degrees());
        assert!(apart_deg.iter().all(|deg| *deg < 0.5), "{apart_deg:?} degrees apart");
    }
    let carried = |states: &[VehicleState]| states.last().unwrap().ground_force_n;
    let [one, other] = [carried(&reference), carried(&fast)];
    for wheel in Wheel::ALL {
        let apart_n = (one[wheel] - other[wheel]).abs();
        assert!(apart_n < 1500.0, "{wheel}: {apart_n} N apart");
    }
    // What joins the frames there weighs nothing of its own.
    assert!((one.sum() - other.sum()).abs() < 100.0, "{} and {} N", one.sum(), other.sum());
}

#[test]
fn a_boulder_under_the_belly_is_felt_and_a_wheel_s_is_not() {
    let boulder = |x_m: f64, y_m: f64| {
        Terrain::Grid(Arc::new(Grid::from_fn(Extent::default(), move |x, y| {
            let apart2 = (x - x_m).powi(2) + (y - y_m).powi(2);
            0.8 * (1.0 - apart2 / 0.36).max(0.0).sqrt()
        })))
    };
    let force_n = |terrain: &Terrain| {
        let mut vehicle = settled::<ReducedBodies>(terrain, 120);
        let drive = Actuation { pump_displacement: [1.0; 2], ..idle() };
        let states = run(&mut vehicle, 120, 8.0, |_| drive);
        assert!(states.iter().all(|s| s.position_m.iter().all(|m| m.is_finite())));
        states.iter().map(|s| s.chassis_force_n).fold(0.0, f64::max)
    };
    assert!(force_n(&boulder(4.0, 0.0)) > 1e3);
    assert_eq!(force_n(&boulder(4.0, 4.0)), 0.0);
}

#[test]
fn slippery_ground_takes_its_share_of_the_rolling() {
    let mut effects = Effects::default();
    for wheel in Wheel::ALL {
        effects.wheels[wheel].slippery_ground.slip = 0.1;
    }
    let machine = Machine::xt28();
    let step = Duration::from_secs_f64(1.0 / 120.0);
    let strokes = PerWheel::splat(0.17);
    let mut vehicle =
        Vehicle::<ReducedBodies>::with(&machine, &effects, &Terrain::Flat, strokes, step);
    let drive = Actuation { pump_displacement: [1.0; 2], ..idle() };
    let states = run(&mut vehicle, 120, 12.0, |_| drive);
    let [early, late] = [states.len() - 241, states.len() - 1].map(|i| states[i]);
    let gone_m = late.position_m[0] - early.position_m[0];
    let rolled_m = 2.0 * late.wheel_speed_rad_s.mean() * machine.wheels.radius_m;
    assert!((gone_m / rolled_m - 0.9).abs() < 5e-3, "{gone_m} m of {rolled_m} m");
}

/// Held wheels turn with their arms, and loose ground takes its share of that.
#[test]
fn slippery_ground_gives_way_under_arms_that_swing_as_in_the_reference() {
    fn gone_m<B: Bodies>(slip: f64) -> f64 {
        let mut effects = Effects::default();
        for wheel in Wheel::ALL {
            effects.wheels[wheel].slippery_ground.slip = slip;
        }
        let step = Duration::from_secs_f64(1.0 / 200.0);
        let strokes = PerWheel::splat(0.10);
        let mut vehicle =
            Vehicle::<B>::with(&Machine::xt28(), &effects, &Terrain::Flat, strokes, step);
        let front = |w: Wheel| if w.axle() == Axle::Front { 0.5 } else { 0.0 };
        let swing =
            Actuation { brake_released: false, arm_opening: PerWheel::from_fn(front), ..idle() };
        run(&mut vehicle, 200, 3.0, |_| swing).last().unwrap().position_m[0].abs()
    }
    let firm_m = gone_m::<ReducedBodies>(0.0);
    for slip in [0.0, 0.5] {
        let [fast_m, reference_m] = [gone_m::<ReducedBodies>(slip), gone_m::<RapierBodies>(slip)];
        assert!((fast_m - reference_m).abs() < 0.004, "{slip}: {fast_m} and {reference_m} m");
        assert!(slip == 0.0 || fast_m < 0.8 * firm_m, "{fast_m} m, {firm_m} m on firm ground");
    }
}

#[test]
fn a_clone_goes_on_bit_for_bit() {
    let mut vehicle = settled::<ReducedBodies>(&gentle(), 120);
    run(&mut vehicle, 120, 3.0, lively);
    let mut clone = vehicle.clone();
    let later = |t: f64| lively(t + 3.0);
    assert_eq!(run(&mut vehicle, 120, 3.0, later), run(&mut clone, 120, 3.0, later));
}

#[test]
fn it_stays_calm_at_every_step_in_use() {
    for rate_hz in [60, 120, 200] {
        let mut vehicle = settled::<ReducedBodies>(&gentle(), rate_hz);
        let states = run(&mut vehicle, rate_hz, 15.0, lively);
        for s in &states {
            let tilt = s.roll_rad.abs().max(s.pitch_rad.abs());
            assert!(tilt < 0.3 && s.ground_force_n.sum() < 4e5, "{rate_hz} Hz: {s:?}");
        }
        let brake = Actuation { brake_released: false, ..idle() };
        let still = run(&mut vehicle, rate_hz, 5.0, |_| brake);
        let rate = still[still.len() - 1].front_rate_rad_s;
        assert!(rate.iter().all(|r| r.abs() < 1e-3), "{rate_hz} Hz: {rate:?}");
    }
}
