//! What holds of every effect in the catalogue, whatever its block.

use std::path::Path;

use xt28_machine::{Machine, PerWheel};
use xt28_sim::effects::{CATALOGUE, Effect, Entry, Overlay, Scope};
use xt28_sim::{
    Actuation, Effects, Plant, Ramp, RapierBodies, STEP, Terrain, Vehicle, VehicleState,
};

const STEPS: u32 = 1000;

/// Five seconds over a ramp with everything in motion: drive, both joints and all arms.
fn trace(effects: &Effects) -> Vec<VehicleState> {
    let ramp = Ramp { x_m: [0.3, 1.3, 3.0, 4.0], height_m: 0.2, y_min_m: -1.9, y_max_m: -0.5 };
    let (machine, strokes) = (Machine::xt28(), PerWheel::splat(0.17));
    let terrain = Terrain::ramp(&ramp);
    let mut vehicle: Vehicle<RapierBodies> =
        Vehicle::with(&machine, effects, &terrain, strokes, STEP);
    let states = (0..STEPS).map(|step| {
        let t = f64::from(step) * STEP.as_secs_f64();
        vehicle.step(&Actuation {
            pump_displacement: [t.min(1.0); 2],
            steer_opening: [0.4 * (1.3 * t).sin(), 0.2 * (1.3 * t).sin()],
            arm_opening: PerWheel::from_fn(|w| 0.3 * (t * (1.0 + w.index() as f64 * 0.1)).sin()),
            ..Actuation::idle(1200.0)
        });
        *vehicle.state()
    });
    states.collect()
}

/// Every parameter of an effect set to the far end of its range, at this share of the way.
fn overlay(effects: &[&'static Effect], severity: f64) -> Overlay {
    let entry = |effect: &&'static Effect| Entry {
        effect,
        scope: Scope::All,
        severity,
        values: effect.parameters.iter().map(|p| (p, far(p.range, p.neutral))).collect(),
    };
    Overlay { entries: effects.iter().map(entry).collect() }
}

fn far([low, high]: [f64; 2], neutral: f64) -> f64 {
    if high > neutral { high } else { low }
}

/// An overlay at severity zero is the nominal plant, bit for bit: each effect alone, then all.
#[test]
fn severity_zero_is_the_nominal_plant_to_the_bit() {
    let nominal = trace(&Effects::default());
    let each = CATALOGUE.iter().map(|effect| vec![effect]);
    for effects in each.chain([CATALOGUE.iter().collect()]) {
        let text = overlay(&effects, 0.0).to_toml();
        let read = Overlay::parse(&text, Path::new("o.toml")).unwrap();
        let name = effects[0].name;
        assert_eq!(read.effects(), Effects::default(), "{name}");
        for (step, (with, without)) in trace(&read.effects()).iter().zip(&nominal).enumerate() {
            assert_eq!(with, without, "{name} at step {step}");
        }
    }
}
