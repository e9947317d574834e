//! A log of the firmware of 2016 replays: every frame decoded by cantools, every value calculated anew.
#![allow(clippy::disallowed_methods, clippy::disallowed_macros)] // a test finds its oracle and says when it has none

use std::fmt::Write as _;
use std::io::{self, Write as _};
use std::path::Path;
use std::process::{Command, Stdio};

use ecu_emu::{Emulator, EmulatorConfig, Operator, Profile, Quirks, TICK, Wire};
use xt28_dbc::{Frame, Outbox};
use xt28_ecus::pins;
use xt28_machine::{Machine, PerWheel, SimTime, Wheel};
use xt28_sim::{Ramp, Terrain, VehicleState};

/// All of the operator's script.
const TICKS: u32 = 2800;

fn python_with_cantools() -> Option<&'static str> {
    let found = Command::new("python3")
        .args(["-c", "import cantools"])
        .stderr(Stdio::null())
        .status()
        .is_ok_and(|status| status.success());
    if found {
        return Some("python3");
    }
    assert!(
        std::env::var_os("CI").is_none(),
        "CI needs python3 with cantools (pip install cantools)"
    );
    let _ = writeln!(io::stdout(), "SKIPPED: python3 has no cantools; pip install cantools");
    None
}

/// What is on the pins in a state of the vehicle and of the cab: the harness alone, no ECU.
struct Inputs {
    table: String,
}

impl Inputs {
    fn new() -> Self {
        let mut table = String::new();
        for column in ["stroke", "a", "b", "hz"] {
            Wheel::ALL.iter().for_each(|w| table += &format!("{column}_{w},"));
        }
        table += "joint_front,joint_rear,Pump1_A,Pump1_B,Pump2_A,Pump2_B,gas,brake,supply\n";
        Self { table }
    }

    fn push(&mut self, s: &VehicleState, operator: &Operator, now: SimTime) {
        let columns: [PerWheel<f64>; 4] = [
            s.stroke_m.map(pins::stroke_mv),
            s.pressure_a_pa.map(pins::pressure_mv),
            s.pressure_b_pa.map(pins::pressure_mv),
            s.wheel_speed_rad_s.map(pins::wheel_hz),
        ];
        let cab = operator.cab(now);
        let pedal_mv = |share: f64| 530.0 + share * (4540.0 - 530.0);
        let rest = [
            pins::joint_front_mv(s.joint_rad[0]),
            pins::joint_rear_mv(s.joint_rad[1]),
            pins::pump_mv(s.pump_pressure_pa[0]),
            pins::pump_mv(s.pump_pressure_pa[1]),
            pins::pump_mv(s.pump_pressure_pa[2]),
            pins::pump_mv(s.pump_pressure_pa[3]),
            pedal_mv(cab.gas),
            pedal_mv(cab.brake),
            24_000.0,
        ];
        let values = columns.iter().flat_map(|column| column.0).chain(rest);
        // Shortest digits that read back as the same number.
        let row: Vec<String> = values.map(|value| format!("{value:?}")).collect();
        self.table += &row.join(",");
        self.table.push('\n');
    }
}

fn log(text: &mut String, now: SimTime, wire: &str, frames: &[Frame]) {
    for frame in frames {
        writeln!(text, "({:.6}) {wire} {frame:?}", now.as_secs_f64()).unwrap();
    }
}

/// Log and inputs of so many ticks over a one-sided ramp.
fn run(ticks: u32, quirks: Quirks) -> (String, String) {
    let ramp = Ramp { x_m: [3.0, 5.0, 7.0, 9.0], height_m: 0.3, y_min_m: -1.9, y_max_m: -0.5 };
    let script = include_str!("replay_2016.operator.toml");
    let operator = Operator::parse(script, Path::new("replay_2016.operator.toml")).unwrap();
    let mut config = EmulatorConfig::new(Machine::xt28(), Terrain::ramp(&ramp), None);
    config.profile = Profile::Firmware2016;
    config.operator = operator.clone();
    config.quirks = quirks;
    let mut emulator = Emulator::new(&config);
    let (mut text, mut inputs, mut out) = (String::new(), Inputs::new(), Outbox::default());
    for tick in 0..ticks {
        let now = SimTime::ZERO + TICK * tick;
        inputs.push(&emulator.truth(), &operator, now);
        out.clear();
        emulator.tick(now, &mut out);
        log(&mut text, now, "can1", out.frames());
        let wires = [
            (Wire::Inertial, "inertial"),
            (Wire::LeftArmrest, "left"),
            (Wire::RightArmrest, "right"),
            (Wire::Engine, "engine"),
            (Wire::Display, "display"),
        ];
        for (wire, name) in wires {
            log(&mut text, now, name, emulator.on_wire(wire));
        }
    }
    (text, inputs.table)
}

/// Whether the calculation agrees with a run, and what it says.
fn replayed(python: &str, ticks: u32, quirks: Quirks) -> (bool, String) {
    let (text, table) = run(ticks, quirks);
    let folder = tempfile::tempdir().unwrap();
    let (log, inputs) = (folder.path().join("run.log"), folder.path().join("inputs.csv"));
    std::fs::write(&log, text).unwrap();
    std::fs::write(&inputs, table).unwrap();
    let output = Command::new(python)
        .args(["tests/replay_2016", "../dbc/xt28.dbc"])
        .args([&log, &inputs])
        .env("PYTHONDONTWRITEBYTECODE", "1")
        .output()
        .unwrap();
    let said = [output.stdout, output.stderr].map(|said| String::from_utf8(said).unwrap()).concat();
    (output.status.success(), said)
}

#[test]
fn every_value_of_a_log_is_what_the_published_formulas_make_of_the_pins() {
    let Some(python) = python_with_cantools() else { return };
    let (agrees, said) = replayed(python, TICKS, Quirks::firmware());
    println!("{said}");
    assert!(agrees, "{said}");
}

/// The calculation is no mirror: of a machine without one oddity it says which value is wrong.
#[test]
fn another_geometry_in_the_force_code_is_found() {
    let Some(python) = python_with_cantools() else { return };
    let quirks = Quirks { force_closed_length_0_82: false, ..Quirks::firmware() };
    let (agrees, said) = replayed(python, 20, quirks);
    assert!(!agrees && said.contains(": WheelForceFront.FR is "), "{said}");
}
