//! `xt28 gap check` on a folder of cases: which of them it examines, and where its answer goes.

mod command;
mod short_drive;

use std::fs;
use std::path::Path;

use command::xt28;
use short_drive::{DBC, log, path};

const CASES: [&str; 3] = ["a", "b", "c"];

/// The same log of a sound machine, as three cases with their answers.
fn set(folder: &Path) -> String {
    let set = folder.join("set");
    let answers = set.join("answers");
    fs::create_dir_all(&answers).unwrap();
    for name in CASES {
        let case = set.join(name);
        fs::create_dir(&case).unwrap();
        fs::copy(log(), case.join("short.log")).unwrap();
        fs::copy(DBC, case.join("own.dbc")).unwrap();
        let run = "[[run]]\nfile = \"short.log\"\nterrain = \"flat\"\nfit = true\n";
        let about = format!("case = \"{name}\"\ndbc = \"own.dbc\"\n{run}");
        fs::write(case.join("about.toml"), about).unwrap();
        let answer = format!("case = \"{name}\"\nkind = \"null\"\n");
        fs::write(answers.join(format!("{name}.toml")), answer).unwrap();
    }
    path(folder, "set")
}

/// What the command says of the first `cases` of `set`, on stdout and stderr.
fn checked(set: &str, cases: &str, json: &[&str]) -> [String; 2] {
    let words = ["gap", "check", "--set", set, "--cases", cases, "--no-how-far", "--no-baselines"];
    let output = xt28(&[&words, json].concat());
    let said = [output.stdout, output.stderr].map(|bytes| String::from_utf8(bytes).unwrap());
    assert_eq!(output.status.code(), Some(0), "{}", said[1]);
    said
}

/// Names of the cases in a JSON answer.
fn cases(json: &str) -> Vec<String> {
    let answer: serde_json::Value = serde_json::from_str(json).expect("JSON and nothing else");
    let cases = answer["cases"].as_array().unwrap().iter();
    cases.map(|case| case["case"].as_str().unwrap().to_owned()).collect()
}

const TABLE: &str = "null false alarms";

#[test]
fn the_first_cases_of_a_folder_come_as_json_alone_on_stdout() {
    let folder = tempfile::tempdir().unwrap();
    let [json, talk] = checked(&set(folder.path()), "2", &["--json"]);
    assert_eq!(cases(&json), CASES[..2], "in the order of their names");
    assert!(talk.contains(TABLE), "the table is for people: {talk}");
}

#[test]
fn a_case_that_cannot_be_read_is_told_and_the_others_are_scored() {
    let folder = tempfile::tempdir().unwrap();
    let set = set(folder.path());
    fs::write(Path::new(&set).join("a/short.log"), "(1.0) can0 1\n").unwrap();
    let words = ["gap", "check", "--set", &set, "--no-how-far", "--no-baselines", "--json"];
    let output = xt28(&words);
    let [json, talk] = [output.stdout, output.stderr].map(|b| String::from_utf8(b).unwrap());
    assert_eq!(output.status.code(), Some(1), "{talk}");
    assert_eq!(cases(&json), CASES[1..]);
    assert!(talk.contains("1 more could not be read and are in no score"), "{talk}");
    let answer: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(answer["refused"][0]["case"], "a");
    assert!(answer["refused"][0]["why"].as_str().unwrap().contains("short.log:1"), "{answer}");
}

#[test]
fn a_set_of_which_nothing_can_be_read_is_told_case_by_case() {
    let folder = tempfile::tempdir().unwrap();
    let set = set(folder.path());
    for case in CASES {
        fs::write(Path::new(&set).join(case).join("short.log"), "(1.0) can0 1\n").unwrap();
    }
    let output = xt28(&["gap", "check", "--set", &set, "--no-how-far"]);
    let [table, talk] = [output.stdout, output.stderr].map(|b| String::from_utf8(b).unwrap());
    assert_eq!(output.status.code(), Some(1), "{talk}");
    assert!(table.contains("3 more could not be read"), "{table}");
    assert!(table.contains("short.log:1"), "{table}");
}

#[test]
fn json_in_a_file_leaves_the_table_on_stdout() {
    let folder = tempfile::tempdir().unwrap();
    let file = path(folder.path(), "scores.json");
    let [table, _] = checked(&set(folder.path()), "1", &["--json", &file]);
    assert!(table.contains(TABLE), "{table}");
    assert_eq!(cases(&fs::read_to_string(file).unwrap()), CASES[..1]);
    assert!(folder.path().join("scores.seal").is_file());
}
