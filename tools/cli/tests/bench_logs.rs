//! Logs of the bench's own scenarios, diagnosed: a sound machine is sound whatever drives it and however it stands, and
//! a sensor that comes loose is told.

use std::path::Path;
use std::process::{Command, Output};

fn xt28(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_xt28")).args(arguments).output().unwrap()
}

/// What the diagnosis of the log of `scenario` says in JSON, driven by `policy` where one is given.
fn diagnosed(scenario: &str, policy: Option<&str>) -> serde_json::Value {
    let folder = tempfile::tempdir().unwrap();
    let [log, json] = ["run.log", "said.json"].map(|name| folder.path().join(name));
    let [log, json] = [&log, &json].map(|path| path.to_str().unwrap());
    let mut run = vec!["run", scenario, "--record", log];
    run.extend(policy.into_iter().flat_map(|policy| ["--policy", policy]));
    assert!(xt28(&run).status.success(), "{scenario}");
    let dbc = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../dbc/xt28.dbc");
    let mut diagnose = vec!["gap", "diagnose", log, "--dbc", dbc.to_str().unwrap()];
    diagnose.extend(["--terrain", scenario, "--no-how-far", "--json", json]);
    let output = xt28(&diagnose);
    let said = std::fs::read_to_string(json);
    let said = said.unwrap_or_else(|_| panic!("{}", String::from_utf8_lossy(&output.stderr)));
    serde_json::from_str(&said).unwrap()
}

#[test]
fn a_sound_machine_that_a_network_drives_and_brakes_is_sound() {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../gateway/examples/imitated.toml");
    let said = diagnosed("straight-25m", Some(&format!("network:{file}@25,0,0")));
    assert_eq!(said["verdict"], "none", "{:#}", said["causes"]);
}

#[test]
fn a_sound_machine_that_levels_itself_on_a_cross_slope_is_sound() {
    let said = diagnosed("cross-slope", None);
    assert_eq!(said["verdict"], "none", "{:#}", said["causes"]);
}

#[test]
fn a_sound_machine_whose_joints_stay_straight_over_a_ramp_is_sound() {
    let said = diagnosed("ramp-automatic", None);
    assert_eq!(said["verdict"], "none", "{:#}", said["causes"]);
}

#[test]
fn sensors_that_come_loose_early_in_a_short_log_are_told() {
    let said = diagnosed("false-stroke", None);
    let [cause, others @ ..] = &said["causes"].as_array().unwrap()[..] else { panic!("{said:#}") };
    assert_eq!((&cause["effect"], &cause["scope"]), (&"stroke-bias".into(), &"right".into()));
    // 200 mV of 8.25 mV/mm, from 3 s on.
    let bias_m = cause["parameters"]["bias_m"][0].as_f64().unwrap();
    assert!((bias_m - 0.02425).abs() < 1e-3, "{bias_m}");
    assert!((cause["begins"]["at_s"].as_f64().unwrap() - 3.0).abs() < 0.1, "{cause:#}");
    assert!(others.iter().all(|other| other["probability"].as_f64().unwrap() < 0.5), "{said:#}");
}
