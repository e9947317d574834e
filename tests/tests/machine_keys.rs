//! Nothing in a machine file is ignored: each number changed by itself changes what the bench does, or
//! the file is refused.
//!
//! The bench is asked in turn for what costs more: sensors alone, a load, the plant driven to its limits,
//! then closed loops of gateway, ECUs and plant, until one of them answers differently.

use std::io;
use std::path::Path;
use std::time::Duration;

use toml::{Table, Value};
use xt28_machine::{Machine, PerWheel, SimTime};
use xt28_scenarios::{Lockstep, Scenario, Setup};
use xt28_sim::effects::Overlay;
use xt28_sim::terrain::{LocalMap, MapPose};
use xt28_sim::{
    Actuation, Effects, GnssReceiver, HeightMapReader, Plant, Ramp, ReducedBodies, STEP, Solver,
    Terrain, Vehicle, VehicleState,
};

/// What the bench makes of a machine: a text that differs where any bit does.
type Answer = fn(&Machine) -> String;

const ANSWERS: [Answer; 7] =
    [sensed, loaded, grounded, driven_hard, at_once, on_bumps_with_automatic_arms, to_a_pose];

/// The built-in machine with what it leaves out switched on, so that those numbers act as well.
fn table() -> Table {
    let text = Machine::builtin_text()
        .replace("tyre_model = \"rigid\"", "tyre_model = \"brush\"")
        .replace("tyre_stiffness_n_m = 8.0e6", "tyre_stiffness_n_m = 9.0e5")
        .replace("roll_hinge = false", "roll_hinge = true")
        .replace("roll_hinge_stiffness_nm = 0.0", "roll_hinge_stiffness_nm = 1.0e4")
        .replace("roll_hinge_max_deg = 15.0", "roll_hinge_max_deg = 0.5");
    text.parse().unwrap()
}

fn parse(table: &Table) -> Result<Machine, String> {
    Machine::parse(&table.to_string(), Path::new("m.toml")).map_err(|error| error.to_string())
}

/// Other values for a key: every number a little less, and every choice the other one.
fn changed(key: &str, value: &Value) -> Vec<Value> {
    match value {
        Value::Float(x) => vec![Value::Float(if *x == 0.0 { 0.02 } else { x * 0.98 })],
        Value::Boolean(b) => vec![Value::Boolean(!b)],
        Value::String(s) => {
            let pairs = [["brush", "rigid"], ["forward", "backward"]];
            let pair = pairs.iter().find(|pair| pair.contains(&s.as_str()));
            let pair = pair.unwrap_or_else(|| panic!("{key}: no other word for {s} is known"));
            vec![Value::String(pair[usize::from(pair[0] == s)].to_owned())]
        }
        // A circuit by itself can only be refused; that is a test of the machine file's own.
        Value::Array(list) if list.iter().all(Value::is_str) => Vec::new(),
        Value::Array(list) => (0..list.len())
            .flat_map(|i| {
                changed(key, &list[i]).into_iter().map(move |other| {
                    let mut list = list.clone();
                    list[i] = other;
                    Value::Array(list)
                })
            })
            .collect(),
        other => panic!("{key} = {other}: what kind of value is this?"),
    }
}

#[test]
fn every_key_of_the_machine_file_does_something() {
    let table = table();
    let machine = parse(&table).unwrap();
    let nominal = ANSWERS.map(|answer| answer(&machine));
    let mut idle = Vec::new();
    for (section, keys) in &table {
        for (key, value) in keys.as_table().unwrap() {
            for other in changed(key, value) {
                let mut table = table.clone();
                let name = format!("{section}.{key} = {other}");
                table[section].as_table_mut().unwrap().insert(key.clone(), other);
                let Ok(other) = parse(&table) else { continue };
                let mut answers = ANSWERS.iter().zip(&nominal);
                if !answers.any(|(answer, nominal)| answer(&other) != *nominal) {
                    idle.push(name);
                }
            }
        }
    }
    assert!(idle.is_empty(), "these change nothing: {idle:#?}");
}

#[test]
fn circuits_that_swap_a_wheel_drive_otherwise() {
    let mut swapped = Machine::xt28();
    swapped.wheels.circuit_1[0] = "FL".to_owned();
    swapped.wheels.circuit_2[0] = "FR".to_owned();
    assert_ne!(driven_hard(&swapped), driven_hard(&Machine::xt28()));
}

fn sensed(machine: &Machine) -> String {
    let mut gnss = GnssReceiver::new(machine, &Effects::default(), Some(1));
    let state = VehicleState::default();
    let fixes = (0..30).map(|tick| gnss.step(SimTime::from_millis(10 * tick), &state));
    let fixes: Vec<_> = fixes.collect();
    let mut heights_m = Vec::new();
    HeightMapReader::new(machine, LocalMap::default(), Some(1)).read(
        &Terrain::Flat,
        &MapPose::default(),
        &mut heights_m,
    );
    format!("{fixes:?} {heights_m:?}")
}

/// Whether it carries a little, and as much as the nominal machine.
fn loaded(machine: &Machine) -> String {
    let load = |mass_kg: f64| {
        let text = format!("[[effect]]\nname = \"payload\"\nmass_kg = {mass_kg}\n");
        Overlay::parse(&text, Path::new("o.toml")).unwrap().effects(machine).is_ok()
    };
    format!("{:?}", [2000.0, 14_000.0].map(load))
}

/// On a ridge between the wheels, a metre high.
fn grounded(machine: &Machine) -> String {
    let ridge = Ramp { x_m: [-8.0, -7.0, 2.0, 3.0], height_m: 1.0, y_min_m: -0.3, y_max_m: 0.3 };
    let mut vehicle: Vehicle<ReducedBodies> = Vehicle::with(
        machine,
        &Effects::default(),
        &Terrain::ramp(&ridge),
        PerWheel::splat(0.2),
        STEP,
    );
    (0..40).for_each(|_| vehicle.step(&Actuation::idle(1200.0)));
    format!("{:?}", vehicle.state())
}

/// Engine, pumps, joints and arms at their limits, uphill and through mud. An engine that turns fast is
/// limited by its power, a slow one by its torque.
fn driven_hard(machine: &Machine) -> String {
    let text = "[[effect]]\nname = \"terrain-slope\"\ngrade_x_rad = 0.4\ngrade_y_rad = 0.1\n\
                [[effect]]\nname = \"rolling-resistance\"\nadded = 0.4\n";
    let effects = Overlay::parse(text, Path::new("o.toml")).unwrap().effects(machine).unwrap();
    let strokes_m = PerWheel::splat(0.2);
    let mut vehicle: Vehicle<ReducedBodies> =
        Vehicle::with(machine, &effects, &Terrain::Flat, strokes_m, STEP);
    let mut states = String::new();
    for step in 0..1300 {
        let engine_rpm = if step < 600 { 1200.0 } else { 900.0 };
        let push = if step < 900 { 1.0 } else { -1.0 };
        vehicle.step(&Actuation {
            pump_displacement: [1.0; 2],
            motor_displacement: PerWheel::splat(0.35),
            steer_opening: [push; 2],
            arm_opening: PerWheel::from_fn(|w| if w.index() % 2 == 0 { push } else { -push }),
            ..Actuation::idle(engine_rpm)
        });
        if step % 25 == 24 {
            states += &format!("{:?}", vehicle.state());
        }
    }
    states
}

/// The log and the truth of a closed loop, or why the machine refuses the script.
fn closed_loop(machine: &Machine, scenario: &str, script: &str) -> String {
    let read = |_: &Path| Ok(script.to_owned());
    let scenario = Scenario::parse(scenario, Path::new("t.toml"), read).unwrap();
    let mut setup = Setup::new(scenario, None).unwrap();
    (setup.machine, setup.solver) = (machine.clone(), Solver::Reduced);
    let mut run = match Lockstep::new(&setup, io::sink()) {
        Ok(run) => run,
        Err(error) => return error.to_string(),
    };
    while run.tick(&mut || Duration::ZERO).unwrap().is_some() {}
    let recording = run.finish().unwrap();
    format!("{} {:?}", recording.log_sha256, recording.truth)
}

/// Everything moves within a second; the arms go to both ends of what the manual modes take.
fn at_once(machine: &Machine) -> String {
    let script = "end_s = 4\n[[command]]\nat_s = 0\nthrottle_percent = 60\nfront_angle_deg = 12\n\
                  stroke_mm = [250, 0, 250, 0, 250, 0]\n";
    let scenario = "title = \"t\"\npolicy = \"script:s.toml\"\nduration_s = 4\nseed = 1\n";
    closed_loop(machine, scenario, script)
}

fn on_bumps_with_automatic_arms(machine: &Machine) -> String {
    let script = "end_s = 6\n[[command]]\nat_s = 0\narms = \"automatic\"\nthrottle_percent = 40\n\
                  front_angle_deg = -12\n";
    let scenario = "title = \"t\"\npolicy = \"script:s.toml\"\nduration_s = 6\nseed = 1\n\
                    [terrain.bumps]\nheight_m = 0.3\nwavelength_m = 4.0\n\
                    [[effect]]\nname = \"terrain-slope\"\ngrade_y_rad = 0.25\n";
    closed_loop(machine, scenario, script)
}

fn to_a_pose(machine: &Machine) -> String {
    let scenario = "title = \"t\"\npolicy = \"goto:5,1,10\"\nduration_s = 12\nseed = 1\n";
    closed_loop(machine, scenario, "")
}
