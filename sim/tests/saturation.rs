//! Inputs beyond what a spool, a swash plate or an engine can do act as those at their stops.

use xt28_machine::{Machine, PerWheel, Wheel};
use xt28_sim::{
    Actuation, Bodies, Effects, Plant, RapierBodies, ReducedBodies, STEP, Terrain, Vehicle,
    VehicleState,
};

fn after<B: Bodies>(actuation: &Actuation) -> VehicleState {
    let mut vehicle = Vehicle::<B>::with(
        &Machine::xt28(),
        &Effects::default(),
        &Terrain::Flat,
        PerWheel::splat(0.17),
        STEP,
    );
    (0..300).for_each(|_| vehicle.step(actuation));
    *vehicle.state()
}

/// An input of a broken policy and what the machine makes of it.
fn pairs() -> [(Actuation, Actuation); 2] {
    let idle = Actuation::idle(1200.0);
    let far = Actuation {
        arm_opening: PerWheel::from_fn(|w| if w == Wheel::Fl { 3.0 } else { 0.0 }),
        steer_opening: [5.0, -f64::INFINITY],
        pump_displacement: [7.0, f64::INFINITY],
        motor_displacement: PerWheel::splat(2.0),
        ..idle
    };
    let full = Actuation {
        arm_opening: far.arm_opening.map(|opening| opening.min(1.0)),
        steer_opening: [1.0, -1.0],
        pump_displacement: [1.0; 2],
        motor_displacement: PerWheel::splat(1.0),
        ..idle
    };
    let nothing = Actuation {
        arm_opening: PerWheel::splat(f64::NAN),
        steer_opening: [f64::NAN; 2],
        pump_displacement: [f64::NAN; 2],
        motor_displacement: PerWheel::splat(f64::NAN),
        engine_speed_rpm: f64::NAN,
        ..idle
    };
    let stands =
        Actuation { motor_displacement: PerWheel::splat(0.0), engine_speed_rpm: 0.0, ..idle };
    [(far, full), (nothing, stands)]
}

#[test]
fn what_is_beyond_a_stop_or_no_number_acts_as_the_machine_can() {
    for (asked, done) in pairs() {
        assert_eq!(after::<RapierBodies>(&asked), after::<RapierBodies>(&done));
        assert_eq!(after::<ReducedBodies>(&asked), after::<ReducedBodies>(&done));
    }
    let [(far, _), (nothing, _)] = pairs();
    assert!(after::<ReducedBodies>(&far).antenna_velocity_m_s[0] > 0.5, "it drives");
    assert!(after::<ReducedBodies>(&nothing).position_m.iter().all(|x| x.is_finite()));
}
