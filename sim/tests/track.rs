//! A plant led along another one goes on as that one does, with what no sensor shows.

use std::time::Duration;

use xt28_machine::{Machine, PerWheel, Wheel};
use xt28_sim::{
    Actuation, Effects, Held, Plant, ReducedBodies, STEP, Solver, Terrain, Track, Vehicle,
};

fn late() -> Effects {
    let mut effects = Effects::default();
    effects.arms = effects.arms.map(|mut arm| {
        arm.delay.delay_s = 0.3;
        arm
    });
    effects
}

fn plant(solver: Solver, effects: &Effects) -> Box<dyn Track + Send> {
    let stroke_m = PerWheel::splat(0.17);
    let mut plant = solver.vehicle(&Machine::xt28(), effects, &Terrain::Flat, stroke_m, STEP);
    for _ in 0..400 {
        plant.step(&Actuation::idle(1200.0));
    }
    plant
}

fn opened(opening: f64) -> Actuation {
    Actuation { arm_opening: PerWheel::splat(opening), ..Actuation::idle(1200.0) }
}

/// Valves open for a moment; what is still on its way when the other is let go must arrive there too.
#[test]
fn delays_are_as_full_as_those_of_the_plant_it_followed() {
    for solver in [Solver::Rapier, Solver::Reduced] {
        let (mut real, mut led) = (plant(solver, &late()), plant(solver, &late()));
        for _ in 0..40 {
            real.step(&opened(0.2));
            led.track(real.state(), &opened(0.2));
        }
        let cold_state = *real.state();
        for _ in 0..200 {
            real.step(&opened(0.0));
            led.step(&opened(0.0));
        }
        let mut cold = Vehicle::<ReducedBodies>::from_measured(
            &Machine::xt28(),
            &late(),
            &Terrain::Flat,
            STEP,
            &cold_state,
            &opened(0.0),
            Duration::ZERO,
        );
        (0..200).for_each(|_| cold.step(&opened(0.0)));
        for wheel in Wheel::ALL {
            let [real, led, cold] =
                [real.state(), led.state(), cold.state()].map(|s| s.stroke_m[wheel]);
            assert!((led - real).abs() < 1.0e-3, "{solver} {wheel}: {led} {real}");
            assert!((cold - real).abs() > 5.0e-3, "{solver} {wheel}: {cold} {real}");
        }
    }
}

#[test]
fn a_snapshot_goes_on_bit_for_bit() {
    let mut one = plant(Solver::Reduced, &late());
    one.step(&opened(0.1));
    let mut other = one.snapshot();
    for _ in 0..100 {
        one.step(&opened(-0.1));
        other.step(&opened(-0.1));
    }
    assert_eq!(one.state(), other.state());
}

#[test]
fn held_arms_stay_where_they_were_measured_and_others_do_not() {
    let run = |arms: bool| {
        let mut plant = plant(Solver::Reduced, &Effects::default());
        let measured = *plant.state();
        for _ in 0..100 {
            plant.hold(&measured, &opened(0.3), Held { arms, ..Held::default() });
            plant.step(&opened(0.3));
        }
        (plant.state().stroke_m[Wheel::Mr] - measured.stroke_m[Wheel::Mr]).abs()
    };
    assert!(run(true) < 2.0e-3, "{}", run(true));
    assert!(run(false) > 20.0e-3, "{}", run(false));
}

/// The throttle asks for full speed, the measurement for half of it and its torque.
#[test]
fn a_held_drive_turns_the_wheels_as_measured() {
    let ahead = Actuation { pump_displacement: [0.6; 2], ..Actuation::idle(1200.0) };
    let mut plant = plant(Solver::Reduced, &Effects::default());
    let mut measured = *plant.state();
    measured.wheel_speed_rad_s = PerWheel::splat(0.5);
    for _ in 0..600 {
        plant.hold(&measured, &ahead, Held { drive: true, ..Held::default() });
        plant.step(&ahead);
    }
    let mean = plant.state().wheel_speed_rad_s.mean();
    assert!((mean - 0.5).abs() < 0.05, "{mean}");
}
