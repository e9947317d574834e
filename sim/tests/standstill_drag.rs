//! `standstill-drag` by its signature: wheels that do not roll pinch when arms swing, and cylinders weigh
//! what is no weight.

use std::path::Path;

use xt28_machine::{Axle, GRAVITY_M_S2, Machine, PerWheel, Wheel};
use xt28_sim::effects::Overlay;
use xt28_sim::{Actuation, Effects, Plant, STEP, Terrain, Vehicle, VehicleState};

/// What a cylinder does not carry of a wheel and its arm, kg.
const UNSPRUNG_KG: f64 = 650.0;

/// Stands 3 s, extends front and rear arms by some 5 cm, and stands 3 s more.
fn extend(effects: &Effects) -> VehicleState {
    let stroke_m = PerWheel::splat(0.17);
    let mut vehicle: Vehicle =
        Vehicle::with(&Machine::xt28(), effects, &Terrain::Flat, stroke_m, STEP);
    for step in 0..1400 {
        let open = if (600..800).contains(&step) { 0.25 } else { 0.0 };
        let outer = |wheel: Wheel| if wheel.axle() == Axle::Middle { 0.0 } else { open };
        vehicle
            .step(&Actuation { arm_opening: PerWheel::from_fn(outer), ..Actuation::idle(1200.0) });
    }
    *vehicle.state()
}

/// Weight that the cylinders of one axle say is on it, through the linkage, N.
fn weighed_n(s: &VehicleState, axle: Axle) -> f64 {
    let linkage = Machine::xt28().linkage();
    let weighed_n =
        |wheel: Wheel| s.cylinder_force_n[wheel] * linkage.at_stroke(s.stroke_m[wheel]).force_ratio;
    Wheel::ALL.into_iter().filter(|wheel| wheel.axle() == axle).map(weighed_n).sum()
}

#[test]
fn wheels_that_hold_pinch_and_the_cylinders_weigh_it() {
    let held = "[[effect]]\nname = \"standstill-drag\"\ntorque_nm = 5000";
    let held =
        Overlay::parse(held, Path::new("o.toml")).unwrap().effects(&Machine::xt28()).unwrap();
    let (free, held) = (extend(&Effects::default()), extend(&held));
    let false_n = |s: &VehicleState, axle: Axle| {
        let on = Wheel::ALL.into_iter().filter(|wheel| wheel.axle() == axle);
        let unsprung_n = 2.0 * UNSPRUNG_KG * GRAVITY_M_S2;
        weighed_n(s, axle) + unsprung_n - on.map(|wheel| s.ground_force_n[wheel]).sum::<f64>()
    };
    for axle in [Axle::Front, Axle::Middle, Axle::Rear] {
        assert!(false_n(&free, axle).abs() < 300.0, "{axle:?}: {} N", false_n(&free, axle));
    }
    // Its middle arms did not swing.
    assert!(false_n(&held, Axle::Middle).abs() < 300.0, "{} N", false_n(&held, Axle::Middle));
    for axle in [Axle::Front, Axle::Rear] {
        assert!(false_n(&held, axle) > 4e3, "{axle:?}: {} N", false_n(&held, axle));
    }
    // It is no weight: the ground knows nothing of it.
    let ground_n = |s: &VehicleState| s.ground_force_n.sum();
    assert!((ground_n(&held) / ground_n(&free) - 1.0).abs() < 2e-3);
}
