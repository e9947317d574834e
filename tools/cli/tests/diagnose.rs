//! `xt28 gap diagnose` on a log of this bench's own machine: every file it writes reads back.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};
use std::sync::OnceLock;

use tempfile::TempDir;

/// The database that this bench's logs are sent with.
const DBC: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../dbc/xt28.dbc");

fn xt28(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_xt28")).args(arguments).output().expect("xt28 starts")
}

/// Every block does something, in as little time as that takes.
const SCENARIO: &str = r#"
title = "Arms up, off, left"
policy = "script:short.script.toml"
duration_s = 10.0
[[expect]]
carries-weight = { from_s = 0.5, to_s = 1.0, within_percent = 5.0 }
"#;
const SCRIPT: &str = r#"
end_s = 10
[[command]]
at_s = 0
stroke_mm = [100, 100, 100, 100, 100, 100]
[[command]]
at_s = 1
stroke_mm = [130, 130, 100, 100, 130, 130]
throttle_percent = 40
[[command]]
at_s = 4
front_angle_deg = 8
"#;

/// A folder with one log in it, driven once.
fn logs() -> &'static Path {
    static FOLDER: OnceLock<TempDir> = OnceLock::new();
    let folder = FOLDER.get_or_init(|| {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
        fs::write(path("short.toml"), SCENARIO).unwrap();
        fs::write(path("short.script.toml"), SCRIPT).unwrap();
        let (scenario, log) = (path("short.toml"), path("short.log"));
        let output = xt28(&["run", &scenario, "--solver", "reduced", "--record", &log]);
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
        folder
    });
    folder.path()
}

fn log() -> String {
    logs().join("short.log").to_str().unwrap().to_owned()
}

#[test]
fn an_answer_comes_as_text_json_and_overlay() {
    let out = tempfile::tempdir().unwrap();
    let file = |name: &str| out.path().join(name).to_str().unwrap().to_owned();
    let (json, overlay) = (file("a.json"), file("a.toml"));
    let output = xt28(&[
        "gap",
        "diagnose",
        &log(),
        "--dbc",
        DBC,
        "--no-how-far",
        "--json",
        &json,
        "--overlay",
        &overlay,
    ]);
    let talk = String::from_utf8(output.stderr).unwrap();
    let words = String::from_utf8(output.stdout).unwrap();
    assert!(words.contains("probability  cause"), "{words}\n{talk}");
    assert!(words.contains("Fitted on short.log; held out: none"), "{words}");
    assert!(words.contains("taken as driven on level ground"), "{words}");
    let answer: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(&json).unwrap()).unwrap();
    let verdict = answer["verdict"].as_str().unwrap();
    assert!(["effect", "none", "unknown"].contains(&verdict), "{verdict}");
    assert_eq!(output.status.code(), Some(i32::from(verdict != "none")));
    for key in ["where", "causes", "not_testable", "notes"] {
        assert!(answer[key].is_array(), "{key}");
    }
    assert!(answer["seconds"].as_f64().unwrap() > 0.0);
    // Another command takes the causes found.
    let output = xt28(&["run", "straight-25m", "--effects", &overlay, "--solver", "reduced"]);
    assert_ne!(output.status.code(), Some(2), "{}", String::from_utf8_lossy(&output.stderr));
}

/// The one line of a refusal.
fn refusal(arguments: &[&str]) -> String {
    let output = xt28(&[&["gap", "diagnose", "--dbc", DBC], arguments].concat());
    let talk = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{talk}");
    assert!(output.stdout.is_empty(), "a refusal leaves no data");
    assert_eq!(talk.lines().count(), 1, "{talk}");
    talk
}

#[test]
fn runs_that_are_none_are_answered_with_those_there_are() {
    let talk = refusal(&[&log(), "--fit", "2"]);
    assert!(talk.contains("no run `2`; there are short.log (1)"), "{talk}");
    let talk = refusal(&[&log(), "--held", "short"]);
    assert!(talk.contains("no run is left to fit causes on"), "{talk}");
    let talk = refusal(&[&log(), "--held", "1", "--fit", "1"]);
    assert!(talk.contains("both to fit on and to hold out"), "{talk}");
}

#[test]
fn a_log_given_twice_is_refused() {
    let talk = refusal(&[&log(), &log()]);
    assert!(talk.contains("the same log as"), "{talk}");
}
