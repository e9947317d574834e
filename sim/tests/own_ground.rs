//! What somebody's own ground does to the wheels reaches both solvers, at the wheels' centres.

use xt28_machine::{GRAVITY_M_S2, Machine, PerWheel, Wheel};
use xt28_sim::{
    Effects, HingeSpring, Loads, Motion, Parts, Placed, RapierBodies, ReducedBodies, Terrain,
    Wrench,
};

const DT_S: f64 = 0.001;

/// A machine with stiff joints and arms, lifted off the solver's own ground and held for half a second by
/// what `on_wheel` makes of what carried each wheel there, N.
fn held<B: Placed>(machine: &Machine, on_wheel: impl Fn(Wheel, f64) -> Wrench) -> [Motion; 2] {
    let parts = Parts::new(machine, &Effects::default());
    let mut bodies = B::new(&parts, &Terrain::Flat, PerWheel::splat(0.25));
    let start = bodies.motion();
    let rigid = |rest_rad| HingeSpring { stiffness_nm: 2.0e8, damping_nms: 2.0e6, rest_rad };
    let loads = Loads {
        arm: start.arm.map(|arm| rigid(arm.angle_rad)),
        joint: [rigid(0.0); 2],
        ..Loads::default()
    };
    for _ in 0..2000 {
        bodies.advance(&loads, DT_S);
    }
    let mut start = bodies.motion();
    start.position_m[2] += 50.0;
    bodies.place(&start);
    let carried_n = start.ground_force_n;
    let on_wheel = PerWheel::from_fn(|wheel| on_wheel(wheel, carried_n[wheel]));
    let loads = Loads { on_wheel, ..loads };
    for _ in 0..500 {
        bodies.advance(&loads, DT_S);
    }
    [start, bodies.motion()]
}

fn check<B: Placed>(name: &str) {
    let machine = Machine::xt28();
    // Nothing holds it: it falls.
    let [start, end] = held::<B>(&machine, |_, _| Wrench::default());
    let fell_m = start.position_m[2] - end.position_m[2];
    assert!((fell_m - 0.5 * GRAVITY_M_S2 * 0.25).abs() < 0.01, "{name}: {fell_m}");
    // What the ground did, and a tenth of it to the left: it goes to the left and stays as high as it was.
    let push = |_, up_n| Wrench { force_n: [0.0, 0.1 * up_n, up_n], ..Wrench::default() };
    let [start, end] = held::<B>(&machine, push);
    // It rolls a little as it goes: wheels are below the middle of its mass.
    let left_m_s = end.velocity_m_s[1] / (0.1 * GRAVITY_M_S2 * 0.5);
    assert!((left_m_s - 1.0).abs() < 0.15, "{name}: {left_m_s}");
    assert!((end.position_m[2] - start.position_m[2]).abs() < 0.01, "{name}: {end:?}");
    // A torque about the axle spins that wheel alone.
    let spun = |wheel, _| {
        let nm = if wheel == Wheel::Mr { 100.0 } else { 0.0 };
        Wrench { torque_nm: [0.0, nm, 0.0], ..Wrench::default() }
    };
    let [_, end] = held::<B>(&machine, spun);
    let about_axle = Parts::new(&machine, &Effects::default()).wheel.inertia_kg_m2[1];
    let want_rad_s = 100.0 * 0.5 / about_axle;
    let spins = end.wheel_rate_rad_s;
    assert!((spins[Wheel::Mr] / want_rad_s - 1.0).abs() < 0.02, "{name}: {spins:?} {want_rad_s}");
    assert!(spins[Wheel::Ml].abs() < 0.02 * want_rad_s, "{name}: {spins:?}");
}

#[test]
fn both_solvers_feel_what_acts_on_the_wheels() {
    check::<ReducedBodies>("fast core");
    check::<RapierBodies>("rapier");
}

/// A push at the side of the machine turns it about its upright axis, alike in both.
#[test]
fn a_push_on_one_wheel_turns_both_solvers_alike() {
    let machine = Machine::xt28();
    let push = |wheel, _| {
        let ahead_n = if wheel == Wheel::Fl { 2.0e4 } else { 0.0 };
        Wrench { force_n: [ahead_n, 0.0, 0.0], ..Wrench::default() }
    };
    let [_, fast] = held::<ReducedBodies>(&machine, push);
    let [_, rapier] = held::<RapierBodies>(&machine, push);
    assert!(fast.rate_rad_s[2] < -0.05, "{fast:?}");
    for axis in 0..3 {
        let apart = fast.rate_rad_s[axis] - rapier.rate_rad_s[axis];
        assert!(apart.abs() < 0.05 * fast.rate_rad_s[2].abs(), "{fast:?} {rapier:?}");
    }
}
