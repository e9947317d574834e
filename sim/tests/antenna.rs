//! `gnss-lever-arm` by its signature: an antenna elsewhere than the machine file says goes where the
//! frame turns it, and nothing but the receiver feels it.

use std::path::Path;

use xt28_machine::{Machine, PerWheel};
use xt28_sim::effects::Overlay;
use xt28_sim::{Actuation, Effects, Plant, STEP, Terrain, Vehicle, VehicleState};

/// Ahead of where it is believed and right of it, m.
const LEVER_M: [f64; 2] = [0.8, -0.5];

/// Four seconds straight ahead, then six in a bend to the left.
fn drive(effects: &Effects) -> Vec<VehicleState> {
    let mut vehicle: Vehicle =
        Vehicle::with(&Machine::xt28(), effects, &Terrain::Flat, PerWheel::splat(0.17), STEP);
    let states = (0..2000).map(|step| {
        let bend = if step < 800 { 0.0 } else { 0.5 };
        vehicle.step(&Actuation {
            pump_displacement: [0.5; 2],
            steer_opening: [bend, -bend],
            ..Actuation::idle(1200.0)
        });
        *vehicle.state()
    });
    states.collect()
}

fn apart<const N: usize>(a: [f64; N], b: [f64; N]) -> [f64; N] {
    core::array::from_fn(|k| a[k] - b[k])
}

#[test]
fn an_antenna_elsewhere_swings_with_the_frame_and_nothing_else_feels_it() {
    let text = format!(
        "[[effect]]\nname = \"gnss-lever-arm\"\nx_m = {}\ny_m = {}",
        LEVER_M[0], LEVER_M[1]
    );
    let overlay = Overlay::parse(&text, Path::new("o.toml")).unwrap();
    let (nominal, moved) =
        (drive(&Effects::default()), drive(&overlay.effects(&Machine::xt28()).unwrap()));
    let [ahead_m, left_m] = LEVER_M;
    for (step, (n, m)) in nominal.iter().zip(&moved).enumerate() {
        let [x, y, _] = apart(m.antenna_position_m, n.antenna_position_m);
        let (sin, cos) = n.yaw_rad.sin_cos();
        let wanted_m = [cos * ahead_m - sin * left_m, sin * ahead_m + cos * left_m];
        // Roll and pitch of a machine on level ground shorten the lever by less.
        assert!(apart([x, y], wanted_m).iter().all(|m| m.abs() < 2e-3), "step {step}: {x} {y}");
        let [vx, vy, _] = apart(m.antenna_velocity_m_s, n.antenna_velocity_m_s);
        let yaw_rad_s = n.front_rate_rad_s[2];
        let wanted_m_s = [-yaw_rad_s * wanted_m[1], yaw_rad_s * wanted_m[0]];
        let off = apart([vx, vy], wanted_m_s);
        assert!(off.iter().all(|m_s| m_s.abs() < 0.01), "step {step}: {off:?}");
        let without = VehicleState {
            antenna_position_m: n.antenna_position_m,
            antenna_velocity_m_s: n.antenna_velocity_m_s,
            ..*m
        };
        assert_eq!(without, *n, "step {step}: something but the receiver feels it");
    }
    let speed_m_s =
        |k: usize| apart(moved[k].antenna_velocity_m_s, nominal[k].antenna_velocity_m_s);
    let along = |v: [f64; 3]| v[0].hypot(v[1]);
    assert!(along(speed_m_s(799)) < 0.005, "straight ahead it shows in no velocity");
    assert!(along(speed_m_s(1900)) > 0.02, "in a bend it does: {:?}", speed_m_s(1900));
}
