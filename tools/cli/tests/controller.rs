//! A stock controller, Python's roslibpy, drives a scenario that `xt28 run` judges.
//!
//! Where a bus is named in `XT28_VCAN` emulator and gateway run there as programs; without, in lockstep. Skipped,
//! and said so, where roslibpy is not installed; with `CI` set it has to be.
#![allow(clippy::disallowed_methods, clippy::disallowed_macros)] // finds its client; says what is skipped

use std::io::{BufRead, BufReader, Read, Write};
use std::process::{Child, Command, Stdio};

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

/// Starts the example where whoever listens says that it does.
fn controller(said: &mut impl BufRead) -> Child {
    let mut line = String::new();
    let port = loop {
        line.clear();
        assert!(said.read_line(&mut line).unwrap() > 0, "nobody listens for a controller");
        if let Some((_, port)) = line.trim().rsplit_once("ws://127.0.0.1:") {
            break port.to_owned();
        }
    };
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/../../gateway/examples/controller.py");
    Command::new("python3").args([script, "--port", &port]).spawn().unwrap()
}

#[test]
fn roslibpy_drives_a_scenario_to_its_end() {
    if !roslibpy_is_there() {
        return;
    }
    let bus = std::env::var("XT28_VCAN").unwrap_or_else(|_| "virtual".to_owned());
    let mut run = Command::new(env!("CARGO_BIN_EXE_xt28"))
        .args(["run", "straight-25m", "--policy", "rosbridge:0", "--bus", &bus, "--json"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut said = BufReader::new(run.stderr.take().unwrap());
    let mut python = controller(&mut said);
    let mut talk = String::new();
    said.read_to_string(&mut talk).unwrap();
    let output = run.wait_with_output().unwrap();
    assert!(output.status.success(), "{talk}");
    assert!(python.wait().unwrap().success());
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(report["gateway"]["outcome"], "reached", "{report:#}");
}
