//! What bounds the machine's motion: end stops, joint stops, saturated valves.

use xt28_machine::{Axle, Machine, PerWheel, Wheel};
use xt28_sim::{
    Actuation, Bodies, Effects, Plant, RapierBodies, ReducedBodies, STEP, Terrain, Vehicle,
    VehicleState,
};

/// Every state over `seconds` under one actuation, standing for a second before.
fn hold(actuation: Actuation, stroke_m: f64, seconds: f64) -> Vec<VehicleState> {
    let machine = Machine::xt28();
    let mut vehicle = Vehicle::new(&machine, &Terrain::Flat, PerWheel::splat(stroke_m));
    (0..200).for_each(|_| vehicle.step(&Actuation::idle(1200.0)));
    let steps = (seconds / STEP.as_secs_f64()) as u32;
    let states = (0..steps).map(|_| {
        vehicle.step(&actuation);
        *vehicle.state()
    });
    states.collect()
}

#[test]
fn arms_stop_at_the_ends_of_their_strokes() {
    let machine = Machine::xt28();
    for (opening, stroke_m, end_m) in [(1.0, 0.4, machine.arms.stroke_max_m), (-1.0, 0.1, 0.0)] {
        let opening = PerWheel::splat(opening);
        let states =
            hold(Actuation { arm_opening: opening, ..Actuation::idle(1200.0) }, stroke_m, 4.0);
        let s = states.last().unwrap();
        for wheel in Wheel::ALL {
            let past_m = (s.stroke_m[wheel] - end_m).abs();
            assert!(past_m < 0.02, "{wheel}: {past_m} m from the stop at {end_m} m");
            assert!(s.stroke_rate_m_s[wheel].abs() < 1e-3, "{wheel} has come to rest");
            // The oil pushes on against the stop up to the relief valve.
            let most_n = machine.arms.force_max_n * 1.001;
            assert!(
                s.cylinder_force_n[wheel].abs() <= most_n,
                "{wheel}: {}",
                s.cylinder_force_n[wheel]
            );
        }
        assert!(s.front_rate_rad_s.iter().all(|w| w.abs() < 1e-2), "{:?}", s.front_rate_rad_s);
    }
}

#[test]
fn joints_stop_at_their_limit_and_no_further_for_all_the_oil() {
    let machine = Machine::xt28();
    let limit_deg = machine.articulation.angle_max_deg;
    let turn = Actuation {
        steer_opening: [1.0, -1.0],
        pump_displacement: [1.0; 2],
        ..Actuation::idle(1200.0)
    };
    let states = hold(turn, 0.17, 12.0);
    let most = |i: usize| states.iter().map(|s| s.joint_rad[i].abs()).fold(0.0, f64::max);
    for i in 0..2 {
        let most_deg = most(i).to_degrees();
        assert!(
            (limit_deg - 3.0..limit_deg + 3.0).contains(&most_deg),
            "joint {i}: {most_deg} deg"
        );
    }
}

/// Steepest turn of the front joint, degrees, of a braked machine that stands across a steep slope: its
/// front wheels on ice, the others where they hold.
fn thrown_deg<B: Bodies>(angle_max_deg: f64) -> f64 {
    let mut machine = Machine::xt28();
    machine.articulation.angle_max_deg = angle_max_deg;
    let mut effects = Effects::default();
    effects.slope.grade_y_rad = 0.4;
    for wheel in Wheel::ALL {
        let ice = wheel.axle() == Axle::Front;
        effects.wheels[wheel].slippery_ground.friction_factor = if ice { 0.02 } else { 3.0 };
    }
    let stroke_m = PerWheel::splat(0.17);
    let mut vehicle: Vehicle<B> = Vehicle::with(&machine, &effects, &Terrain::Flat, stroke_m, STEP);
    let steps = (0..2400).map(|_| {
        vehicle.step(&Actuation { brake_released: false, ..Actuation::idle(1200.0) });
        vehicle.state().joint_rad[0].abs()
    });
    steps.fold(0.0, f64::max).to_degrees()
}

#[test]
fn metal_holds_a_joint_that_the_oil_lets_go() {
    for (free_deg, stopped_deg) in [
        (thrown_deg::<RapierBodies>(60.0), thrown_deg::<RapierBodies>(10.0)),
        (thrown_deg::<ReducedBodies>(60.0), thrown_deg::<ReducedBodies>(10.0)),
    ] {
        assert!(free_deg > 15.0, "the slope does not throw it: {free_deg} deg");
        assert!((10.0..11.0).contains(&stopped_deg), "{stopped_deg} deg");
    }
}

/// A valve is open at 1: asking for more moves nothing faster, to the bit.
#[test]
fn a_valve_cannot_open_further_than_open() {
    let asked = |opening: f64| {
        let actuation = Actuation {
            arm_opening: PerWheel::splat(opening),
            steer_opening: [opening; 2],
            pump_displacement: [0.5; 2],
            ..Actuation::idle(1200.0)
        };
        hold(actuation, 0.17, 1.0)
    };
    let (open, more) = (asked(1.0), asked(7.0));
    let joints = |states: &[VehicleState]| states.iter().map(|s| s.joint_rad).collect::<Vec<_>>();
    assert_eq!(joints(&open), joints(&more));
    let strokes = |states: &[VehicleState]| states.iter().map(|s| s.stroke_m).collect::<Vec<_>>();
    assert_eq!(strokes(&open), strokes(&more));
    // Fully open, the oil moves a cylinder at its full speed.
    let machine = Machine::xt28();
    let (a, b) = (&open[100], &open[199]);
    let speed_m_s = (b.stroke_m.mean() - a.stroke_m.mean()) / (99.0 * STEP.as_secs_f64());
    assert!((speed_m_s / machine.hydraulics.speed_full_m_s - 1.0).abs() < 0.1, "{speed_m_s} m/s");
}
