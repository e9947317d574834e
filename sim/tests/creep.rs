//! Ground that shears under a push, behind both solvers and both tyres.

use xt28_machine::{GRAVITY_M_S2, Machine, PerWheel, TyreModel, Wheel};
use xt28_sim::{
    Actuation, Bodies, Effects, Plant, RapierBodies, ReducedBodies, STEP, Terrain, Vehicle,
};

/// Speed at which the ground shears, m/s/N.
const CREEP_M_S_N: f64 = 2.0e-5;
/// Grade that the machine climbs, as a share of gravity.
const GRADE: f64 = 0.06;

/// Climbs for 12 s; mean speed by which rims are faster than the machine over the last 4 s, m/s.
fn slips_m_s<B: Bodies>(machine: &Machine, creep_m_s_n: f64) -> f64 {
    let mut effects = Effects::default();
    effects.slope.grade_x_rad = GRADE;
    for wheel in Wheel::ALL {
        effects.wheels[wheel].slippery_ground.creep_m_s_n = creep_m_s_n;
    }
    let strokes = PerWheel::splat(0.17);
    let mut vehicle: Vehicle<B> = Vehicle::with(machine, &effects, &Terrain::Flat, strokes, STEP);
    let (steps, last) = (2400, 800);
    let (mut rolled_m, mut from_m) = (0.0, 0.0);
    for step in 0..steps {
        let t = f64::from(step) * STEP.as_secs_f64();
        let pump = ((t - 3.0) / 0.5).clamp(0.0, 1.0);
        vehicle.step(&Actuation { pump_displacement: [pump; 2], ..Actuation::idle(1200.0) });
        let state = vehicle.state();
        if step < steps - last {
            from_m = state.position_m[0];
        } else {
            let mean_rad_s = state.wheel_speed_rad_s.mean();
            rolled_m += mean_rad_s * machine.wheels.radius_m * STEP.as_secs_f64();
        }
    }
    let travelled_m = vehicle.state().position_m[0] - from_m;
    (rolled_m - travelled_m) / (f64::from(last) * STEP.as_secs_f64())
}

fn shears_by_its_push<B: Bodies>(model: TyreModel) {
    let mut machine = Machine::xt28();
    machine.vehicle.tyre_model = model;
    let push_n = machine.mass_kg() * GRAVITY_M_S2 * GRADE.sin() / 6.0;
    let none = slips_m_s::<B>(&machine, 0.0);
    let slips = slips_m_s::<B>(&machine, CREEP_M_S_N) - none;
    let wanted = CREEP_M_S_N * push_n;
    assert!((slips / wanted - 1.0).abs() < 0.03, "{slips} m/s, not {wanted}");
}

#[test]
fn ground_shears_by_what_a_climbing_machine_pushes_it_with() {
    shears_by_its_push::<RapierBodies>(TyreModel::Rigid);
    shears_by_its_push::<RapierBodies>(TyreModel::Brush);
    shears_by_its_push::<ReducedBodies>(TyreModel::Rigid);
    shears_by_its_push::<ReducedBodies>(TyreModel::Brush);
}
