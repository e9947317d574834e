//! `xt28 gap diagnose` on a log of this bench's own machine: every file it writes reads back, and
//! every test drive that it may propose is a scenario that runs and holds.

mod command;
mod short_drive;

use std::fs;
use std::path::Path;

use command::xt28;
use short_drive::{DBC, log, path};
use xt28_gap::diagnosis::Manoeuvre;

#[test]
fn an_answer_comes_as_text_json_report_and_overlay() {
    let out = tempfile::tempdir().unwrap();
    let file = |name: &str| path(out.path(), name);
    let (json, report, overlay) = (file("a.json"), file("a.html"), file("a.toml"));
    let output = xt28(&[
        "gap",
        "diagnose",
        &log(),
        "--dbc",
        DBC,
        "--no-how-far",
        "--json",
        &json,
        "--report",
        &report,
        "--overlay",
        &overlay,
    ]);
    let talk = String::from_utf8(output.stderr).unwrap();
    let words = String::from_utf8(output.stdout).unwrap();
    assert!(words.contains("probability  cause"), "{words}\n{talk}");
    assert!(words.contains("Fitted on short.log; held out: none"), "{words}");
    assert!(words.contains("taken as driven on level ground"), "{words}");
    assert_eq!(words.matches("foretold").count(), 1, "it is told once: {words}");
    let answer: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(&json).unwrap()).unwrap();
    let verdict = answer["verdict"].as_str().unwrap();
    assert!(["effect", "none", "unknown"].contains(&verdict), "{verdict}");
    assert_eq!(output.status.code(), Some(i32::from(verdict != "none")));
    for key in ["where", "causes", "not_testable", "notes"] {
        assert!(answer[key].is_array(), "{key}");
    }
    assert!(answer["seconds"].as_f64().unwrap() > 0.0);
    let report = fs::read_to_string(&report).unwrap();
    assert!(report.starts_with("<!DOCTYPE html>") && report.ends_with("</html>\n"));
    assert!(report.contains("short.log"));
    assert_eq!(report.matches("nothing was foretold").count(), 1);
    let is_held = |note: &&serde_json::Value| note.as_str().unwrap().contains("held out");
    assert_eq!(answer["notes"].as_array().unwrap().iter().filter(is_held).count(), 1);
    assert_eq!(answer["asked"]["logs"][0]["sha256"].as_str().map(str::len), Some(64));
    assert_eq!(answer["asked"]["dbc"]["file"], DBC);
    assert_eq!(answer["asked"]["fitted_runs"], serde_json::json!(["short.log"]));
    // Another command takes the causes found.
    let output = xt28(&["run", "straight-25m", "--effects", &overlay, "--solver", "reduced"]);
    assert_ne!(output.status.code(), Some(2), "{}", String::from_utf8_lossy(&output.stderr));
}

/// Of one drive straight ahead of a sound machine nothing is left to tell apart, and much is not tested.
#[test]
fn json_names_the_drive_that_is_written_also_where_it_is_for_what_no_log_tests() {
    let out = tempfile::tempdir().unwrap();
    let [log, json, next] = ["a.log", "a.json", "next.toml"].map(|name| path(out.path(), name));
    let driven = xt28(&["run", "straight-25m", "--solver", "reduced", "--record", &log]);
    assert_ne!(driven.status.code(), Some(2), "{driven:?}");
    let answer = ["gap", "diagnose", &log, "--dbc", DBC, "--no-how-far", "--json", &json];
    let output = xt28(&[&answer[..], &["--next", &next]].concat());
    let talk = String::from_utf8(output.stderr).unwrap();
    let answer: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(&json).unwrap()).unwrap();
    let drive = &answer["next"];
    assert!(drive["nats"].is_null() && drive["separates"] == serde_json::json!([]), "{drive}");
    let not_testable = answer["not_testable"].as_array().unwrap().iter();
    let tested: Vec<_> = not_testable
        .filter(|one| one["manoeuvre"] == drive["manoeuvre"])
        .map(|one| one["effect"].clone())
        .collect();
    assert!(!tested.is_empty(), "{talk}");
    assert_eq!(drive["tests"], serde_json::json!(tested));
    let scenario = fs::read_to_string(&next).unwrap();
    assert!(scenario.contains(drive["manoeuvre"].as_str().unwrap()), "{scenario}");
}

#[test]
fn every_manoeuvre_runs_as_a_scenario_and_leaves_the_machine_on_its_wheels() {
    let folder = tempfile::tempdir().unwrap();
    let runs = Manoeuvre::all().into_iter().map(|manoeuvre| {
        let scenario = path(folder.path(), &format!("{}.toml", manoeuvre.name));
        let written = xt28(&["gap", "drive", manoeuvre.name, "--out", &scenario]);
        assert_eq!(written.status.code(), Some(0), "{}", manoeuvre.name);
        std::thread::spawn(move || {
            (manoeuvre.name, xt28(&["run", &scenario, "--solver", "reduced"]))
        })
    });
    for run in runs.collect::<Vec<_>>() {
        let (name, output) = run.join().unwrap();
        let talk = String::from_utf8_lossy(&output.stderr);
        let table = String::from_utf8_lossy(&output.stdout);
        assert_eq!(output.status.code(), Some(0), "{name}: {talk}{table}");
    }
}

#[test]
fn drives_are_listed_and_one_that_is_none_is_answered_with_those_there_are() {
    let listed = String::from_utf8(xt28(&["gap", "drive"]).stdout).unwrap();
    let output = xt28(&["gap", "drive", "wobble"]);
    let talk = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{talk}");
    for manoeuvre in Manoeuvre::all() {
        assert!(listed.contains(manoeuvre.name) && talk.contains(manoeuvre.name), "{listed}{talk}");
    }
}

/// Records each of these on our own nominal machine and gives what a diagnosis of all their logs together
/// says, with its exit code.
fn diagnosed(scenarios: &[String], folder: &Path, options: &[&str]) -> (Option<i32>, String) {
    let record = |(i, scenario): (usize, &String)| {
        let log = path(folder, &format!("run-{}.log", i + 1));
        let output = xt28(&["run", scenario, "--record", &log]);
        assert_eq!(output.status.code(), Some(0), "{scenario}: {output:?}");
        log
    };
    let logs: Vec<String> = scenarios.iter().enumerate().map(record).collect();
    let mut words = [&["gap", "diagnose", "--dbc", DBC, "--no-how-far"], options].concat();
    words.extend(logs.iter().map(String::as_str));
    let output = xt28(&words);
    (output.status.code(), String::from_utf8_lossy(&output.stdout).into_owned())
}

#[test]
fn the_test_drives_together_show_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let drive = |manoeuvre: Manoeuvre| {
        let scenario = path(folder.path(), &format!("{}.toml", manoeuvre.name));
        xt28(&["gap", "drive", manoeuvre.name, "--out", &scenario]);
        scenario
    };
    let drives: Vec<String> = Manoeuvre::all().into_iter().map(drive).collect();
    let next = path(folder.path(), "next.toml");
    xt28(&["gap", "drive", "straight", "--out", &next]);
    let before = fs::read_to_string(&next).unwrap();
    let (code, words) = diagnosed(&drives, folder.path(), &["--next", &next]);
    assert_eq!(code, Some(0), "{words}");
    // No drive is left to ask for, and one of an earlier answer is not taken for it.
    assert!(words.contains("next.script.toml there is older and was left as it was"), "{words}");
    assert_eq!(fs::read_to_string(&next).unwrap(), before);
}

/// A bend that the attitude filter stops short in, brakes on arms that still level, arms at the ends of
/// their strokes: each alone.
#[test]
fn what_no_other_drive_does_shows_nothing_either() {
    for scenario in ["straight-25m", "arm-steps", "s-turn"] {
        let folder = tempfile::tempdir().unwrap();
        let (code, words) = diagnosed(&[scenario.to_owned()], folder.path(), &[]);
        assert_eq!(code, Some(0), "{scenario}: {words}");
    }
}
