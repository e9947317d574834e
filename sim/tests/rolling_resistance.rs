//! `rolling-resistance` on the whole machine: which wheels it holds back, and that none is ever driven by it.

use xt28_machine::{GRAVITY_M_S2, Machine, PerWheel, Side, Wheel};
use xt28_sim::effects::Overlay;
use xt28_sim::{
    Actuation, Bodies, Effects, Plant, RapierBodies, ReducedBodies, STEP, Terrain, Vehicle,
    VehicleState,
};

/// The effect on wheels of `scope`.
fn added(added: f64, scope: &str) -> Effects {
    let text =
        format!("[[effect]]\nname = \"rolling-resistance\"\nscope = \"{scope}\"\nadded = {added}");
    Overlay::parse(&text, std::path::Path::new("o.toml"))
        .unwrap()
        .effects(&Machine::xt28())
        .unwrap()
}

/// Its axle bears a wheel's rolling resistance, and the arm so much less of what the motor asks of it: the place of the
/// weight stays where it was however hard the wheels roll.
fn leaves_the_weight<B: Bodies>() {
    let [plain, hard] = [0.0, 0.1].map(|more| rolled::<B>(&Machine::xt28(), &added(more, "all")));
    assert!(hard.wheel_torque_nm.sum() > 3.0 * plain.wheel_torque_nm.sum());
    for wheel in Wheel::ALL {
        let moved_n = hard.ground_force_n[wheel] - plain.ground_force_n[wheel];
        assert!(moved_n.abs() < 900.0, "{wheel}: {moved_n} N");
    }
}

#[test]
fn wheels_that_roll_hard_leave_the_weight_where_it_was() {
    leaves_the_weight::<RapierBodies>();
    leaves_the_weight::<ReducedBodies>();
}

/// After 2 s of standing and 18 s of rolling.
fn rolled<B: Bodies>(machine: &Machine, effects: &Effects) -> VehicleState {
    let stroke_m = PerWheel::splat(0.17);
    let mut vehicle: Vehicle<B> = Vehicle::with(machine, effects, &Terrain::Flat, stroke_m, STEP);
    for step in 0..4000 {
        let pump = f64::from(step >= 400);
        vehicle.step(&Actuation { pump_displacement: [pump; 2], ..Actuation::idle(1200.0) });
    }
    *vehicle.state()
}

fn one_side<B: Bodies>() {
    let machine = Machine::xt28();
    let w = &machine.wheels;
    let s = rolled::<B>(&machine, &added(0.1, "left"));
    let wanted_nm: f64 = Wheel::ALL
        .map(|wheel| {
            let more = if wheel.side() == Side::Left { 0.1 } else { 0.0 };
            (w.rolling_resistance + more) * s.ground_force_n[wheel] * w.radius_m
        })
        .iter()
        .sum();
    let made_nm = s.wheel_torque_nm.sum();
    assert!((made_nm / wanted_nm - 1.0).abs() < 0.02, "{made_nm} Nm, not {wanted_nm} Nm");
    // The side that is held back is the one that it turns to.
    assert!(s.yaw_rad > 1e-3, "{} rad", s.yaw_rad);
    let right = rolled::<B>(&machine, &added(0.1, "right"));
    assert!((right.yaw_rad + s.yaw_rad).abs() < 0.02 * s.yaw_rad, "{} rad", right.yaw_rad);
}

#[test]
fn one_side_held_back_costs_its_torque_and_turns_the_machine() {
    one_side::<RapierBodies>();
    one_side::<ReducedBodies>();
}

fn never_drives<B: Bodies>() {
    let mut machine = Machine::xt28();
    machine.wheels.rolling_resistance = 0.005;
    // 0.015 less than nothing would push at each wheel with a hundredth of the weight.
    let made_nm = rolled::<B>(&machine, &added(-0.02, "all")).wheel_torque_nm.sum();
    let least_nm = 0.001 * machine.mass_kg() * GRAVITY_M_S2 * machine.wheels.radius_m;
    assert!(made_nm.abs() < least_nm, "{made_nm} Nm");
}

#[test]
fn less_than_no_rolling_resistance_is_none() {
    never_drives::<RapierBodies>();
    never_drives::<ReducedBodies>();
}
