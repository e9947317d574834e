//! Wheels that turn too lightly for their drive at the plant's step: blocks and bodies take turns, and nothing shakes.

use core::time::Duration;

use xt28_machine::{Machine, PerWheel};
use xt28_sim::{
    Actuation, Bodies, Effects, Plant, Ramp, RapierBodies, ReducedBodies, STEP, Terrain, Vehicle,
};

const SECONDS: f64 = 8.0;

/// Wheels of an eighth of the nominal inertia, driven thrice as stiffly.
fn light() -> Machine {
    let mut machine = Machine::xt28();
    machine.masses.wheel_kg = 200.0;
    machine.vehicle.wheel_gyration_m = 0.35;
    machine.vehicle.circuit_gain_nms = 3.0e4;
    machine
}

/// Weaves over a ramp under the right wheels for 8 s: how far it gets, m, and how much a wheel's spin changes
/// otherwise from one step to the next than in the step before, rad/s, root of the mean square once it rolls.
fn weave<B: Bodies>(machine: &Machine, step: Duration) -> [f64; 2] {
    let ramp = Ramp { x_m: [1.3, 2.3, 3.0, 4.0], height_m: 0.35, y_min_m: -1.9, y_max_m: -0.5 };
    let (terrain, strokes_m) = (Terrain::ramp(&ramp), PerWheel::splat(0.17));
    let mut vehicle: Vehicle<B> =
        Vehicle::with(machine, &Effects::default(), &terrain, strokes_m, step);
    let mut before = [PerWheel::splat(0.0); 2];
    let (mut squares, mut count) = (0.0, 0.0);
    let mut t = 0.0;
    while t < SECONDS {
        vehicle.step(&Actuation {
            pump_displacement: [t.min(1.0); 2],
            steer_opening: [0.4 * (1.3 * t).sin(), 0.2 * (1.3 * t).sin()],
            ..Actuation::idle(1200.0)
        });
        let now = vehicle.state().wheel_speed_rad_s;
        if t > 2.0 {
            let bent = now.iter().map(|(w, x)| (x - 2.0 * before[0][w] + before[1][w]).powi(2));
            squares += bent.sum::<f64>();
            count += 6.0;
        }
        before = [now, before[0]];
        t += step.as_secs_f64();
    }
    let [x, y, _] = vehicle.state().antenna_position_m;
    [x.hypot(y), (squares / count).sqrt()]
}

/// Without turns their wheels are thrown to and fro by 10 rad/s, on rapier at 5 ms and on both at 60 Hz. The
/// distances part by some millimetres between the solvers and by 2 cm between the steps.
#[test]
fn light_wheels_do_not_shake_on_either_solver_at_any_step() {
    let machine = light();
    let mut ways_m = Vec::new();
    for step in [STEP, Duration::from_secs_f64(1.0 / 60.0)] {
        for [way_m, shake_rad_s] in
            [weave::<RapierBodies>(&machine, step), weave::<ReducedBodies>(&machine, step)]
        {
            assert!(shake_rad_s < 0.05, "{step:?}: {shake_rad_s} rad/s");
            ways_m.push(way_m);
        }
    }
    let apart_m = ways_m.iter().map(|way_m| (way_m - ways_m[0]).abs()).fold(0.0, f64::max);
    assert!(ways_m[0] > 3.0 && apart_m < 0.03, "{ways_m:?} m");
}

/// How long a torque may be held: the nominal machine's over every step that is in use, that of light wheels over
/// less than one.
#[test]
fn the_nominal_machine_needs_no_turns() {
    let held_s = |machine: &Machine, at_most_s: fn(f64, f64) -> f64| {
        let (m, v) = (&machine.masses, &machine.vehicle);
        at_most_s(m.wheel_kg * v.wheel_gyration_m.powi(2), v.circuit_gain_nms)
    };
    for at_most_s in [RapierBodies::held_at_most_s, ReducedBodies::held_at_most_s] {
        assert!(held_s(&Machine::xt28(), at_most_s) > 1.0 / 60.0);
        assert!(held_s(&light(), at_most_s) < STEP.as_secs_f64());
    }
}
