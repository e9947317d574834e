//! A learnt policy, the example's, drives a scenario that `xt28 run` judges; what does not fit is refused.
//!
//! Where a bus is named in `XT28_VCAN` emulator and gateway run there as programs; without, in lockstep.
#![allow(clippy::disallowed_methods)] // finds the bus and the example

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// A file of the example.
fn example(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../gateway/examples").join(name)
}

fn run(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_xt28")).arg("run").args(arguments).output().unwrap()
}

/// Why a run was refused: one line on stderr, status 2.
fn refused(arguments: &[&str]) -> String {
    let output = run(arguments);
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!((output.status.code(), said.lines().count()), (Some(2), 1), "{said}");
    said
}

/// The hash of the log of a drive of 25 m that went as it should.
fn driven_well(bus: &str, policy: &str) -> String {
    let output = run(&["straight-25m", "--policy", policy, "--bus", bus, "--json"]);
    let said = String::from_utf8_lossy(&output.stderr);
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).expect(&said);
    assert!(output.status.success(), "{said}{report:#}");
    assert_eq!(report["gateway"]["outcome"], "reached", "{report:#}");
    report["log_sha256"].as_str().unwrap().to_owned()
}

#[test]
fn a_network_drives_a_scenario_to_its_end() {
    let policy = format!("network:{}@25,0,0", example("imitated.toml").display());
    match std::env::var("XT28_VCAN") {
        Ok(bus) => drop(driven_well(&bus, &policy)),
        Err(_) => assert_eq!(driven_well("virtual", &policy), driven_well("virtual", &policy)),
    }
}

#[test]
fn a_scenario_has_its_network_beside_it() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["imitated.toml", "imitated.safetensors"] {
        fs::copy(example(name), folder.path().join(name)).unwrap();
    }
    let scenario = folder.path().join("short.toml");
    let text = "title = \"t\"\npolicy = \"network:imitated.toml@3,0,0\"\nduration_s = 12\n\
                [[expect]]\nreaches-pose = { x_m = 3, y_m = 0, heading_deg = 0, within_m = 0.3, within_deg = 9 }\n";
    fs::write(&scenario, text).unwrap();
    let output = run(&[scenario.to_str().unwrap()]);
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success(), "{said}{}", String::from_utf8_lossy(&output.stderr));
}

#[test]
fn what_does_not_fit_is_refused_before_anything_is_driven() {
    let folder = tempfile::tempdir().unwrap();
    let [policy_file, weights] =
        ["imitated.toml", "imitated.safetensors"].map(|name| folder.path().join(name));
    let text = fs::read_to_string(example("imitated.toml")).unwrap();
    let policy = format!("network:{}", policy_file.display());
    let goal = format!("{policy}@25,0,0");
    let straight = |policy: &str| refused(&["straight-25m", "--policy", policy]);
    assert!(straight(&goal).contains("imitated.toml: cannot read it"));
    fs::write(&policy_file, &text).unwrap();
    assert!(straight(&goal).contains("imitated.safetensors: cannot read it"));
    let bytes = fs::read(example("imitated.safetensors")).unwrap();
    fs::write(&weights, &bytes[..bytes.len() / 2]).unwrap();
    assert!(straight(&goal).contains("imitated.safetensors: no safetensors file"));
    fs::write(&weights, &bytes).unwrap();
    assert!(straight(&policy).contains("it sees a goal; give one, as network:FILE@25,0,0"));
    assert!(straight(&format!("{policy}@25,0")).contains("bad goal"));
    fs::write(&policy_file, text.replace("goal_m", "goal")).unwrap();
    assert!(
        straight(&goal).contains("imitated.toml:10: unknown variant `goal`"),
        "{}",
        straight(&goal)
    );
    fs::write(&policy_file, text.replace("    { name = \"roll_rad\"", "    # {")).unwrap();
    let error = straight(&goal);
    assert!(error.contains("0.weight takes 5 numbers") && error.contains("are 4;"), "{error}");
    let latin: Vec<u8> = text.bytes().chain(*b"# \xe9\n").collect();
    fs::write(&policy_file, latin).unwrap();
    assert!(straight(&goal).contains("imitated.toml:15: no UTF-8"), "{}", straight(&goal));
    // A log must not cost a policy.
    fs::write(&policy_file, &text).unwrap();
    for file in [&policy_file, &weights] {
        let record = file.to_str().unwrap();
        let error = refused(&["straight-25m", "--policy", &goal, "--record", record]);
        assert!(error.contains(record), "{error}");
    }
    assert_eq!(fs::read(&weights).unwrap(), bytes);
}
