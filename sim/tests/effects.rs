//! What holds of every effect in the catalogue, whatever its block.

use std::path::Path;

use xt28_machine::{Machine, PerWheel};
use xt28_sim::effects::{CATALOGUE, Effect, Entry, Overlay, Scope};
use xt28_sim::{
    Actuation, Effects, Plant, Ramp, RapierBodies, STEP, Sensors, Terrain, Vehicle, VehicleState,
};

/// Some numbers of a state.
type Signal = fn(&VehicleState) -> Vec<f64>;

/// Onto a ramp with everything in motion: drive, both joints and all arms.
fn trace_of(machine: &Machine, effects: &Effects, steps: u32) -> Vec<VehicleState> {
    let ramp = Ramp { x_m: [0.3, 1.3, 3.0, 4.0], height_m: 0.2, y_min_m: -1.9, y_max_m: -0.5 };
    let strokes = PerWheel::splat(0.17);
    let terrain = Terrain::ramp(&ramp);
    let mut vehicle: Vehicle<RapierBodies> =
        Vehicle::with(machine, effects, &terrain, strokes, STEP);
    let states = (0..steps).map(|step| {
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

/// An overlay at severity zero is the nominal machine, by its values and through its file.
#[test]
fn severity_zero_leaves_every_value_nominal() {
    let all: Vec<_> = CATALOGUE.iter().collect();
    let each = CATALOGUE.iter().map(|effect| vec![effect]);
    for effects in each.chain([all.clone()]) {
        let text = overlay(&effects, 0.0).to_toml();
        let read = Overlay::parse(&text, Path::new("o.toml")).unwrap();
        assert_eq!(
            read.effects(&Machine::xt28()).unwrap(),
            Effects::default(),
            "{}",
            effects[0].name
        );
    }
}

/// No effect sets in with a jump: at a millionth of its range the vehicle moves within the solver's
/// rounding of the nominal one, and not within a millimetre or a kilonewton.
#[test]
fn every_effect_fades_in_from_nominal() {
    fades_in(&Machine::xt28());
}

/// Nor on a machine whose file has other numbers than the nominal one where effects replace some.
#[test]
fn every_effect_fades_in_from_what_the_machine_file_says() {
    let mut machine = Machine::xt28();
    machine.vehicle.tyre_stiffness_n_m = 9.0e5;
    machine.vehicle.tyre_damping_n_s_m = 2.0e4;
    fades_in(&machine);
}

fn fades_in(machine: &Machine) {
    let nominal = trace_of(machine, &Effects::default(), 400);
    for effect in CATALOGUE {
        let with = trace_of(machine, &overlay(&[effect], 1e-6).effects(machine).unwrap(), 400);
        let most = |signal: Signal| {
            let both = with.iter().zip(&nominal).map(|(a, b)| (signal(a), signal(b)));
            let apart = both.flat_map(|(a, b)| a.into_iter().zip(b).map(|(a, b)| (a - b).abs()));
            apart.fold(0.0, f64::max)
        };
        let bounds: [(&str, Signal, f64); 5] = [
            ("stroke", |s| s.stroke_m.0.to_vec(), 1e-5),
            ("cylinder force", |s| s.cylinder_force_n.0.to_vec(), 20.0),
            ("joint", |s| s.joint_rad.to_vec(), 1e-5),
            ("wheel speed", |s| s.wheel_speed_rad_s.0.to_vec(), 1e-3),
            ("position", |s| s.position_m.to_vec(), 1e-4),
        ];
        for (name, signal, bound) in bounds {
            let apart = most(signal);
            assert!(apart < bound, "{}: {name} is {apart:e} off", effect.name);
        }
    }
}

/// A parameter that is said not to act alone moves nothing and shows in no reading while the others are neutral.
#[test]
fn what_does_not_act_alone_changes_no_bit() {
    let machine = Machine::xt28();
    let nominal = trace_of(&machine, &Effects::default(), 400);
    let waiting = CATALOGUE.iter().flat_map(|e| e.parameters).filter(|p| !p.acts_alone);
    for parameter in waiting {
        let mut effects = Effects::default();
        parameter.set(&mut effects, Scope::All, far(parameter.range, parameter.neutral));
        let with = trace_of(&machine, &effects, 400);
        assert!(with == nominal, "{} moves something", parameter.name);
        let (read, as_is) = (Sensors::new(&effects), Sensors::new(&Effects::default()));
        let shows = nominal.iter().any(|state| read.read(state) != as_is.read(state));
        assert!(!shows, "{} shows", parameter.name);
    }
}
