//! An effect at severity zero is not there, to the last bit of a drive, whatever wheels it is said of.

use std::path::Path;

use rayon::prelude::*;
use xt28_machine::{Axle, Machine, PerWheel, Wheel};
use xt28_sim::effects::{CATALOGUE, Effect, Entry, Overlay, Scope, find};
use xt28_sim::{
    Actuation, Bodies, Effects, Plant, Ramp, RapierBodies, ReducedBodies, STEP, Terrain, Vehicle,
};

/// How long the machine drives, steps: 5 s, in which its right wheels go over the ramp.
const STEPS: u32 = 1000;
/// What of an effect's range is in force where it is.
const SEVERITY: f64 = 0.1;

/// A machine whose valves take twice as much, for cylinders twice as wide: more than the nominal pump's flow.
fn larger() -> Machine {
    let mut machine = Machine::xt28();
    machine.hydraulics.flow_full_m3_s *= 2.0;
    machine.arms.area_bore_m2 *= 2.0;
    machine.arms.area_rod_m2 *= 2.0;
    machine
}

/// Over a ramp with everything in motion: drive, both joints and all arms, these up to `opening`. Every tenth
/// state to the bit: a minus before zero shows.
fn drive_by<B: Bodies>(machine: &Machine, effects: &Effects, opening: f64) -> Vec<String> {
    let ramp = Ramp { x_m: [0.2, 0.8, 1.2, 1.8], height_m: 0.2, y_min_m: -1.9, y_max_m: -0.5 };
    let (terrain, strokes) = (Terrain::ramp(&ramp), PerWheel::splat(0.17));
    let mut vehicle = Vehicle::<B>::with(machine, effects, &terrain, strokes, STEP);
    let mut states = Vec::new();
    for step in 0..STEPS {
        let t_s = f64::from(step) * STEP.as_secs_f64();
        let swing = |w: Wheel| opening * (t_s * (1.0 + w.index() as f64 * 0.1)).sin();
        vehicle.step(&Actuation {
            pump_displacement: [t_s.min(1.0); 2],
            steer_opening: [0.4 * (1.3 * t_s).sin(), 0.2 * (1.3 * t_s).sin()],
            arm_opening: PerWheel::from_fn(swing),
            ..Actuation::idle(1200.0)
        });
        if step % 10 == 9 {
            states.push(format!("{:?}", vehicle.state()));
        }
    }
    states
}

/// The nominal machine so, no valve of an arm open by more than 30 %.
fn drive<B: Bodies>(effects: &Effects) -> Vec<String> {
    drive_by::<B>(&Machine::xt28(), effects, 0.3)
}

/// The value at the far end of the range.
fn far([low, high]: [f64; 2], neutral: f64) -> f64 {
    if high > neutral { high } else { low }
}

/// An effect with every parameter set to the far end of its range, at this share of the way.
fn entry(effect: &'static Effect, scope: Scope, severity: f64) -> Entry {
    let values = effect.parameters.iter().map(|p| (p, far(p.range, p.neutral)));
    Entry { effect, scope, severity, values: values.collect() }
}

/// All effects but one in force by their slots, without an overlay.
fn all_but(left_out: &Effect) -> Effects {
    let mut effects = Effects::default();
    for p in CATALOGUE.iter().filter(|effect| *effect != left_out).flat_map(|e| e.parameters) {
        let value = p.neutral + SEVERITY * (far(p.range, p.neutral) - p.neutral);
        p.set(&mut effects, Scope::All, value);
    }
    effects
}

/// The effects on `machine` that an overlay's file says.
fn read_on(machine: &Machine, entries: Vec<Entry>) -> Effects {
    let text = Overlay { entries }.to_toml();
    let overlay = Overlay::parse(&text, Path::new("o.toml")).expect("it was written as it is read");
    overlay.effects(machine).expect("a tenth of the load is no overload")
}

/// Those on the nominal machine.
fn read(entries: Vec<Entry>) -> Effects {
    read_on(&Machine::xt28(), entries)
}

/// Where an effect can be said to act: everywhere, and where it has a wheel on an axle and on a wheel.
fn scopes(effect: &Effect) -> Vec<Scope> {
    let narrow = [Scope::Axle(Axle::Middle), Scope::Wheel(Wheel::Br)];
    let narrow = narrow.into_iter().filter(|_| effect.has_scope());
    [Scope::All].into_iter().chain(narrow).collect()
}

/// Alone, an effect at severity zero leaves the nominal drive as it is.
fn leaves_nominal<B: Bodies>() {
    let nominal = drive::<B>(&Effects::default());
    CATALOGUE.par_iter().for_each(|effect| {
        for scope in scopes(effect) {
            let with = drive::<B>(&read(vec![entry(effect, scope, 0.0)]));
            assert!(with == nominal, "{} on {scope} at severity zero shows", effect.name);
        }
    });
}

/// Before all others in force or after them it leaves the drive as the others alone have it: it puts
/// nothing back to nominal that another one has set, and no law beside it takes another branch. Minus zero
/// equals zero as a value, so that only driving tells.
fn leaves_others<B: Bodies>() {
    let nominal = drive::<B>(&Effects::default());
    CATALOGUE.par_iter().for_each(|effect| {
        let others: Vec<Entry> = CATALOGUE
            .iter()
            .filter(|other| *other != effect)
            .map(|other| entry(other, Scope::All, SEVERITY))
            .collect();
        let alone = drive::<B>(&all_but(effect));
        assert!(alone != nominal, "the others show");
        for scope in scopes(effect) {
            let none = vec![entry(effect, scope, 0.0)];
            for both in [[&none, &others], [&others, &none]] {
                let with = drive::<B>(&read(both.map(Vec::clone).concat()));
                assert!(with == alone, "{} on {scope} at severity zero shows", effect.name);
            }
        }
    });
}

#[test]
fn an_effect_at_severity_zero_leaves_the_nominal_drive_to_the_bit() {
    leaves_nominal::<ReducedBodies>();
    leaves_nominal::<RapierBodies>();
}

#[test]
fn an_effect_at_severity_zero_leaves_all_others_to_the_bit() {
    leaves_others::<ReducedBodies>();
    leaves_others::<RapierBodies>();
}

#[test]
fn an_effect_at_severity_zero_leaves_a_larger_machine_to_the_bit() {
    let machine = larger();
    let nominal = drive_by::<ReducedBodies>(&machine, &Effects::default(), 1.0);
    CATALOGUE.par_iter().for_each(|effect| {
        for scope in scopes(effect) {
            let effects = read_on(&machine, vec![entry(effect, scope, 0.0)]);
            let with = drive_by::<ReducedBodies>(&machine, &effects, 1.0);
            assert!(with == nominal, "{} on {scope} at severity zero shows", effect.name);
        }
    });
}

/// Faster valves take more than the pump of a larger machine is sure to have: they get it, as long as nobody
/// says what the pump has.
#[test]
fn faster_valves_of_a_larger_machine_meet_no_pump_limit_that_nobody_set() {
    let machine = larger();
    let [gain, limit] = ["valve-gain", "pump-flow-limit"].map(|name| find(name).unwrap());
    let (faster, none) = (entry(gain, Scope::All, 0.5), entry(limit, Scope::All, 0.0));
    let mut effects = Effects::default();
    effects.arms = effects.arms.map(|mut arm| {
        arm.valve_gain.factor = 2.0;
        arm
    });
    let alone = drive_by::<ReducedBodies>(&machine, &effects, 1.0);
    let listed = [vec![faster.clone()], vec![faster.clone(), none.clone()], vec![none, faster]];
    for entries in listed {
        let with = drive_by::<ReducedBodies>(&machine, &read_on(&machine, entries), 1.0);
        assert!(with == alone, "the pump runs short");
    }
    effects.pump_flow.flow_m3_s = 0.02;
    assert!(drive_by::<ReducedBodies>(&machine, &effects, 1.0) != alone, "a limit shows");
}
