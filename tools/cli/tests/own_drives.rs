//! `xt28 gap diagnose` on this bench's own nominal machine: simulator and machine are one, and it says so.

mod short_drive;

use short_drive::{DBC, path, xt28};
use xt28_gap::diagnosis::Manoeuvre;

/// Records each of these and says what a diagnosis of all their logs together says, with its exit code.
fn diagnosed(scenarios: &[String], folder: &std::path::Path) -> (Option<i32>, String) {
    let record = |(i, scenario): (usize, &String)| {
        let log = path(folder, &format!("run-{}.log", i + 1));
        let output = xt28(&["run", scenario, "--record", &log]);
        assert_eq!(output.status.code(), Some(0), "{scenario}: {output:?}");
        log
    };
    let logs: Vec<String> = scenarios.iter().enumerate().map(record).collect();
    let mut words = vec!["gap", "diagnose", "--dbc", DBC, "--no-how-far"];
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
    let (code, words) = diagnosed(&drives, folder.path());
    assert_eq!(code, Some(0), "{words}");
}

/// A bend that the attitude filter stops short in, brakes on arms that still level, arms at the ends of
/// their strokes: each alone.
#[test]
fn what_no_other_drive_does_shows_nothing_either() {
    for scenario in ["straight-25m", "arm-steps", "s-turn"] {
        let folder = tempfile::tempdir().unwrap();
        let (code, words) = diagnosed(&[scenario.to_owned()], folder.path());
        assert_eq!(code, Some(0), "{scenario}: {words}");
    }
}
