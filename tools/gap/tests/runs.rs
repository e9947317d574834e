//! Which run is meant by a name, and what is refused: nothing is guessed.

mod frames;

use frames::{decoder, once};
use xt28_gap::{Choice, FieldLog, GapError, KnownRun, RunSet, Terrain, Use};

/// A run whose frames differ from another's by `seed`.
fn run(file: &str, scenario: Option<&str>, advised: Option<bool>, seed: u8) -> KnownRun {
    let text = once(&format!("1.{seed:02}0000"))
        + &format!("(2.{seed:02}0000) can0 18FE1026#{seed:02X}002B00\n");
    KnownRun {
        file: file.to_owned(),
        scenario: scenario.map(str::to_owned),
        advised,
        terrain: Terrain::Flat,
        log: FieldLog::read(text.as_bytes(), file, &decoder(), false).unwrap(),
    }
}

fn five() -> RunSet {
    let runs = vec![
        run("run-1-step.log.gz", Some("step"), Some(true), 1),
        run("run-2-sine.log.gz", Some("sine"), Some(true), 2),
        run("run-3-bend.log.gz", Some("bend"), Some(false), 3),
        run("run-4-bend.log.gz", Some("bend"), Some(true), 4),
        run("run-5-ramp.log.gz", Some("ramp"), Some(false), 5),
    ];
    RunSet::new(runs, Vec::new()).unwrap()
}

fn names(names: &[&str]) -> Vec<String> {
    names.iter().map(|&name| name.to_owned()).collect()
}

fn choose(fit: &[&str], held: &[&str]) -> Result<Choice, GapError> {
    five().choose(&names(fit), &names(held))
}

/// F fitted, h held, - left out.
fn letters(choice: &Choice) -> String {
    let letter = |used: &Use| match used {
        Use::Fit => 'F',
        Use::Held => 'h',
        Use::Left => '-',
    };
    choice.uses.iter().map(letter).collect()
}

#[test]
fn a_run_goes_by_file_number_or_scenario() {
    for (fit, held, wanted) in [
        (&["run-2-sine.log.gz"][..], &[][..], "hFhhh"),
        (&["run-2-sine", "1"], &[], "FFhhh"),
        (&[], &["bend"], "FFhhF"),
        (&["step"], &["5"], "F---h"),
        (&["1", "step", "run-1-step"], &["2"], "Fh---"),
        (&["run-1", "run-4"], &[], "FhhFh"),
    ] {
        assert_eq!(letters(&choose(fit, held).unwrap()), wanted, "{fit:?} {held:?}");
    }
}

#[test]
fn unasked_it_is_as_advised_and_else_the_last_third_is_held_out() {
    let advised = choose(&[], &[]).unwrap();
    assert_eq!(
        (letters(&advised).as_str(), advised.why.as_str()),
        ("FFhFh", "as about.toml advises")
    );
    let plain = |n: u8| {
        let runs = (0..n).map(|i| run(&format!("{i}.log"), None, None, i)).collect();
        letters(&RunSet::new(runs, Vec::new()).unwrap().choose(&[], &[]).unwrap())
    };
    assert_eq!([1, 2, 3, 5].map(plain), ["F", "Fh", "FFh", "FFFhh"]);
}

#[test]
fn what_is_not_there_is_answered_with_what_is() {
    let error = choose(&["run-9"], &[]).unwrap_err().to_string();
    assert!(
        error.starts_with("no run `run-9`; there are run-1-step.log.gz (1, step), "),
        "{error}"
    );
    assert!(choose(&["0"], &[]).is_err() && choose(&["6"], &[]).is_err());
    let error = choose(&["bend"], &["4"]).unwrap_err().to_string();
    assert!(error.starts_with("run-4-bend.log.gz: both to fit on and to hold out"), "{error}");
    let error = choose(&[], &["1", "2", "3", "4", "5"]).unwrap_err().to_string();
    assert!(error.starts_with("no run is left to fit causes on"), "{error}");
}

#[test]
fn a_number_that_may_mean_two_runs_is_refused() {
    let runs = vec![run("run-2-sine.log", None, None, 2), run("run-3-bend.log", None, None, 3)];
    let set = RunSet::new(runs, Vec::new()).unwrap();
    let error = set.choose(&names(&["2"]), &[]).unwrap_err().to_string();
    assert!(error.starts_with("`2` may mean run-2-sine.log and run-3-bend.log"), "{error}");
    assert_eq!(letters(&set.choose(&names(&["3"]), &[]).unwrap()), "hF");
    assert_eq!(letters(&set.choose(&names(&["run-2"]), &[]).unwrap()), "Fh", "its own number");
}

/// Each day's first run has the same file name.
#[test]
fn a_file_name_of_two_folders_goes_with_its_folder() {
    let runs = ["one/run-1.log", "two/run-1.log"];
    let runs = runs.into_iter().zip(1..).map(|(name, seed)| run(name, None, None, seed));
    let set = RunSet::new(runs.collect(), Vec::new()).unwrap();
    let fitted = |name: &str| set.choose(&names(&[name]), &[]).map(|choice| letters(&choice));
    assert_eq!(fitted("two/run-1").unwrap(), "hF");
    for name in ["run-1", "run-1.log"] {
        let error = fitted(name).unwrap_err().to_string();
        assert!(error.contains("may mean one/run-1.log and two/run-1.log"), "{error}");
    }
}

#[test]
fn one_log_under_two_names_is_refused() {
    let runs = vec![run("a.log", None, None, 1), run("copy.log", None, None, 1)];
    let error = RunSet::new(runs, Vec::new()).unwrap_err().to_string();
    assert!(error.starts_with("copy.log: the same log as a.log"), "{error}");
}
