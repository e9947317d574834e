//! A stock controller, Python's roslibpy, drives a scenario that `xt28 run` judges.
//!
//! Where a bus is named in `XT28_VCAN` emulator and gateway run there as programs; without, in lockstep. Skipped,
//! and said so, where roslibpy is not installed; with `CI` set it has to be.
#![allow(clippy::disallowed_methods, clippy::disallowed_macros)] // finds its client; says what is skipped

use std::io::{BufRead, BufReader, Read, Write};
use std::process::{Child, Command, Stdio};
use std::time::Instant;

fn roslibpy_is_there() -> bool {
    let found = Command::new("python3")
        .args(["-c", "import roslibpy"])
        .stderr(Stdio::null())
        .status()
        .is_ok_and(|status| status.success());
    if !found {
        let wanted = "python3 with roslibpy (pip install it)";
        assert!(std::env::var_os("CI").is_none(), "CI needs {wanted}");
        let _ = writeln!(std::io::stdout(), "SKIPPED: no stock controller; it needs {wanted}");
    }
    found
}

/// Starts the example, to drive to `east_m`, where whoever listens says that it does.
fn controller(said: &mut impl BufRead, east_m: &str) -> Child {
    let mut line = String::new();
    let port = loop {
        line.clear();
        assert!(said.read_line(&mut line).unwrap() > 0, "nobody listens for a controller");
        if let Some((_, port)) = line.trim().rsplit_once("ws://127.0.0.1:") {
            break port.to_owned();
        }
    };
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/../../gateway/examples/controller.py");
    Command::new("python3").args([script, "--port", &port, "--east", east_m]).spawn().unwrap()
}

/// Runs a scenario under the example; its report and what it said, and whether both were content.
fn drive(scenario: &str, more: &[&str], east_m: &str) -> (serde_json::Value, String, [bool; 2]) {
    let mut run = Command::new(env!("CARGO_BIN_EXE_xt28"))
        .args(["run", scenario, "--policy", "rosbridge:0", "--json"])
        .args(more)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut said = BufReader::new(run.stderr.take().unwrap());
    let mut python = controller(&mut said, east_m);
    let mut talk = String::new();
    said.read_to_string(&mut talk).unwrap();
    let output = run.wait_with_output().unwrap();
    let content = [output.status.success(), python.wait().unwrap().success()];
    let report = serde_json::from_slice(&output.stdout).unwrap_or_else(|_| panic!("{talk}"));
    (report, talk, content)
}

/// The hash of the log of a drive that went as it should.
fn driven_well(bus: &str) -> String {
    let (report, talk, content) = drive("straight-25m", &["--bus", bus], "25");
    assert_eq!(content, [true; 2], "{talk}");
    assert_eq!(report["gateway"]["outcome"], "reached", "{report:#}");
    let told: Vec<_> = talk.lines().filter(|line| line.contains(" controller: ")).collect();
    assert!(matches!(told[..], [only] if only.ends_with(" drives")), "{told:?}");
    report["log_sha256"].as_str().unwrap().to_owned()
}

#[test]
fn roslibpy_drives_a_scenario_to_its_end() {
    if !roslibpy_is_there() {
        return;
    }
    match std::env::var("XT28_VCAN") {
        Ok(bus) => drop(driven_well(&bus)),
        // In simulated time it drives the same twice.
        Err(_) => assert_eq!(driven_well("virtual"), driven_well("virtual")),
    }
}

#[test]
fn a_controller_that_starts_at_its_goal_ends_there() {
    if !roslibpy_is_there() || std::env::var_os("XT28_VCAN").is_some() {
        return;
    }
    let (report, talk, content) = drive("straight-25m", &[], "0");
    assert_eq!(content, [false, true], "the scenario wants 25 m: {talk}");
    assert_eq!(report["gateway"]["outcome"], "reached", "{report:#}");
}

/// By wall time the run waits for the first answer, and is not late for it.
#[test]
fn by_wall_time_a_run_begins_with_its_controller() {
    if !roslibpy_is_there() || std::env::var_os("XT28_VCAN").is_some() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let scenario = folder.path().join("short.toml");
    let text = "title = \"t\"\npolicy = \"hold\"\nduration_s = 2\n[[expect]]\nstands-still = { below_m_s = 9 }\n";
    std::fs::write(&scenario, text).unwrap();
    let begun = Instant::now();
    let (report, ..) = drive(scenario.to_str().unwrap(), &["--realtime"], "25");
    let took_s = begun.elapsed().as_secs_f64();
    let wall_s = report["wall_s"].as_f64().unwrap();
    assert!((2.0..took_s).contains(&wall_s), "{wall_s} s of {took_s} s");
}
