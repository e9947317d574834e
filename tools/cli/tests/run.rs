//! What `xt28 run` gives: data on stdout, talk on stderr, files where asked, its exit status.

mod command;

use std::fs;

use command::xt28;
use serde_json::Value;

/// Half a second with the arms held: short, and the whole loop.
fn short(expect: &str) -> (tempfile::TempDir, String) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("short.toml");
    let text = format!("title = \"Short\"\npolicy = \"hold\"\nduration_s = 0.5\n{expect}");
    fs::write(&path, text).unwrap();
    let path = path.to_str().unwrap().to_owned();
    (folder, path)
}

const STANDS: &str = "[[expect]]\nstands-still = { below_m_s = 0.1, over_s = 0.3 }\n";
const FLIES: &str = "[[expect]]\nreaches-pose = { x_m = 9, y_m = 0, heading_deg = 0, within_m = 1, within_deg = 9 }\n";

#[test]
fn json_has_all_that_a_script_needs_and_nothing_else_is_on_stdout() {
    let (_folder, path) = short(STANDS);
    let output = xt28(&["run", &path, "--json", "--seed", "9"]);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let json: Value = serde_json::from_slice(&output.stdout).expect("one JSON value");
    assert_eq!(json["scenario"], "short");
    assert_eq!(json["seed"], 9);
    assert_eq!(json["passed"], true);
    assert_eq!(json["simulated_s"], 0.5);
    for key in ["wall_s", "real_time_factor", "physics_step_us", "frames", "bus_load"] {
        assert!(json[key].as_f64().is_some_and(|number| number > 0.0), "{key}: {}", json[key]);
    }
    assert_eq!(json["log_sha256"].as_str().map(str::len), Some(64));
    assert!(json["expectations"].as_array().is_some_and(|list| list.len() >= 3));
}

#[test]
fn an_expectation_that_fails_is_exit_status_1() {
    let (_folder, path) = short(FLIES);
    let output = xt28(&["run", &path]);
    assert_eq!(output.status.code(), Some(1));
    let table = String::from_utf8(output.stdout).unwrap();
    assert!(table.contains("FAIL"), "{table}");
}

#[test]
fn files_land_where_asked_and_the_same_seed_gives_the_same_log() {
    let (folder, path) = short(STANDS);
    let out = folder.path().join("deep/out");
    let out = out.to_str().unwrap();
    assert_eq!(xt28(&["run", &path, "--out", out]).status.code(), Some(0));
    let log = fs::read_to_string(format!("{out}/short.log")).unwrap();
    assert!(log.lines().all(|line| line.contains(" vcan0 ")));
    let picture = fs::read_to_string(format!("{out}/short.svg")).unwrap();
    assert!(picture.starts_with("<svg") && picture.ends_with("</svg>\n"));
    let report: Value =
        serde_json::from_str(&fs::read_to_string(format!("{out}/short.json")).unwrap()).unwrap();
    assert_eq!(report["frames"].as_u64(), Some(log.lines().count() as u64));
    let again = folder.path().join("again.log");
    let output = xt28(&["run", &path, "--record", again.to_str().unwrap(), "--realtime", "--json"]);
    assert_eq!(output.status.code(), Some(0));
    assert_eq!(fs::read_to_string(again).unwrap(), log);
    let json: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert!(json["wall_s"].as_f64().is_some_and(|wall_s| wall_s >= 0.5), "paced by wall time");
    assert!(json["lateness_max_ms"].is_number());
}

#[test]
fn a_scenario_that_plays_the_script_of_another_is_written_with_it_and_runs() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("own");
    let at = |name: &str| out.join(name).to_str().unwrap().to_owned();
    let written = xt28(&["scenarios", "broken-wire", "--out", out.to_str().unwrap()]);
    assert_eq!(written.status.code(), Some(0), "{}", String::from_utf8_lossy(&written.stderr));
    let run = xt28(&["run", &at("broken-wire.toml")]);
    assert_eq!(run.status.code(), Some(0), "{}", String::from_utf8_lossy(&run.stderr));
    assert!(std::path::Path::new(&at("brown-out.script.toml")).exists());
}

#[test]
fn the_list_of_scenarios_has_its_columns_under_one_another() {
    let list = String::from_utf8(xt28(&["scenarios"]).stdout).unwrap();
    let columns: Vec<_> = list.lines().map(|line| line.find(" s  ").unwrap()).collect();
    assert!(columns.len() > 20 && columns.iter().all(|at| *at == columns[0]), "{list}");
}

#[test]
fn the_lists_print() {
    let output = xt28(&["scenarios", "--json"]);
    let list: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert!(list.as_array().is_some_and(|list| list.len() >= 7));
    let text = xt28(&["scenarios", "ramp"]).stdout;
    assert!(String::from_utf8(text).unwrap().contains("[terrain.ramp]"));
    let text = xt28(&["config", "show"]).stdout;
    assert!(String::from_utf8(text).unwrap().contains("radius_m"));
    let text = xt28(&["config", "mapping"]).stdout;
    assert!(String::from_utf8(text).unwrap().contains("\"stroke.FR\" = \"PosFront.FR\""));
}

#[test]
fn an_overlay_has_the_numbers_and_the_wheels_that_it_was_asked_for() {
    let text = |arguments: &[&str]| {
        let output = xt28(arguments);
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stdout).unwrap()
    };
    let asked = text(&["effects", "slippery-ground", "friction_factor=0.3", "--scope", "rear"]);
    for line in ["scope = \"rear\" ", "friction_factor = 0.3 ", "slip = 0.0 "] {
        assert!(asked.contains(line), "{line}: {asked}");
    }
    assert!(text(&["effects", "slippery-ground"]).contains("slip = 0.03 "));
    let (folder, path) = short(STANDS);
    let overlay = folder.path().join("slippery.toml");
    fs::write(&overlay, asked).unwrap();
    text(&["run", &path, "--effects", overlay.to_str().unwrap()]);
}

#[test]
fn a_machine_file_on_the_command_line_takes_the_place_of_the_scenarios_own() {
    let (folder, path) = short(STANDS);
    let log_of = |machine: Option<&str>| {
        let log = folder.path().join("run.log");
        let mut arguments = vec!["run", &path, "--record", log.to_str().unwrap()];
        arguments.extend(machine.into_iter().flat_map(|file| ["--machine", file]));
        let output = xt28(&arguments);
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
        fs::read_to_string(log).unwrap()
    };
    let builtin = String::from_utf8(xt28(&["config", "show"]).stdout).unwrap();
    let same = folder.path().join("same.toml");
    fs::write(&same, &builtin).unwrap();
    let lighter = folder.path().join("lighter.toml");
    let line = builtin.lines().find(|line| line.starts_with("arm_kg")).expect("the arms' mass");
    fs::write(&lighter, builtin.replace(line, "arm_kg = 100.0")).unwrap();
    assert_eq!(log_of(same.to_str()), log_of(None));
    assert_ne!(log_of(lighter.to_str()), log_of(None));
}
