//! Effects of the drive by their signature on the whole vehicle.

use xt28_machine::{Machine, PerWheel};
use xt28_sim::effects::find;
use xt28_sim::{Actuation, Effects, Plant, ReducedBodies, STEP, Terrain, Vehicle, VehicleState};

/// A lag with a lead, s.
fn lag(time_constant_s: f64, lead_s: f64) -> Effects {
    let mut effects = Effects::default();
    let effect = find("drive-lag").unwrap();
    for (key, value) in [("time_constant_s", time_constant_s), ("lead_s", lead_s)] {
        effect.parameter(key).unwrap().set(&mut effects, "all".parse().unwrap(), value);
    }
    effects
}

/// Three seconds from the moment at which the pumps of a machine that has stood for two open at once.
fn throttled(effects: &Effects) -> Vec<VehicleState> {
    let mut vehicle: Vehicle<ReducedBodies> =
        Vehicle::with(&Machine::xt28(), effects, &Terrain::Flat, PerWheel::splat(0.17), STEP);
    (0..400).for_each(|_| vehicle.step(&Actuation::idle(1200.0)));
    let states = (0..600).map(|_| {
        vehicle.step(&Actuation { pump_displacement: [0.5; 2], ..Actuation::idle(1200.0) });
        *vehicle.state()
    });
    states.collect()
}

/// The speed asked for at once is the lead's share of the time constant, and so is the first torque; what comes then
/// comes with the lag. As much lead as lag is no lag but for a step's delay.
#[test]
fn a_lead_shows_in_the_first_torque_and_leaves_the_rest_to_the_lag() {
    let [nominal, led, lagged] =
        [Effects::default(), lag(0.6, 0.15), lag(0.6, 0.0)].map(|effects| throttled(&effects));
    let first_nm = |states: &[VehicleState]| states[0].wheel_torque_nm.sum();
    let lagging = -(-STEP.as_secs_f64() / 0.6).exp_m1();
    let share = 0.25 + 0.75 * lagging;
    let [led_share, lagged_share] =
        [&led, &lagged].map(|states| first_nm(states) / first_nm(&nominal));
    assert!((led_share - share).abs() < 2e-4, "{led_share}, not {share}");
    assert!((lagged_share - lagging).abs() < 2e-4, "{lagged_share}, not {lagging}");
    let speed_rad_s = |states: &[VehicleState], step: usize| states[step].wheel_speed_rad_s.mean();
    let at_half_s = [&lagged, &led, &nominal].map(|states| speed_rad_s(states, 100));
    assert!(at_half_s.is_sorted(), "{at_half_s:?}");
    let apart = (speed_rad_s(&led, 599) / speed_rad_s(&nominal, 599) - 1.0).abs();
    assert!(apart < 0.01, "{apart}");
    let balanced = throttled(&lag(0.6, 0.6));
    for (ours, theirs) in balanced.iter().zip(&nominal) {
        let apart_nm = ours.wheel_torque_nm.sum() - theirs.wheel_torque_nm.sum();
        assert!(apart_nm.abs() < 1e-6, "{apart_nm} Nm");
    }
}

#[test]
fn without_lag_no_lead_shows_to_the_bit() {
    assert_eq!(throttled(&lag(0.0, 0.3)), throttled(&Effects::default()));
    assert_eq!(lag(0.0, 0.0), Effects::default());
}
