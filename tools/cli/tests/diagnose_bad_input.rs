//! What `xt28 gap diagnose` answers to logs, databases and mappings that do not fit: one line that says
//! what, where and what to do, exit status 2, and nothing on stdout.

mod command;
mod short_drive;

use std::fs;

use command::xt28;
use short_drive::{DBC, log, path};
use tempfile::TempDir;

/// The one line of a refusal to diagnose.
fn refusal(arguments: &[&str]) -> String {
    let output = xt28(&[&["gap", "diagnose", "--dbc", DBC], arguments].concat());
    let talk = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{talk}");
    assert!(output.stdout.is_empty(), "a refusal leaves no data");
    assert_eq!(talk.lines().count(), 1, "{talk}");
    talk
}

/// The log with every line changed or left out.
fn changed(change: impl Fn(f64, &str) -> Option<(f64, String)>) -> (TempDir, String) {
    let folder = tempfile::tempdir().unwrap();
    let text = fs::read_to_string(log()).unwrap();
    let mut start_s = None;
    let line = |line: &str| {
        let (time, rest) = line[1..].split_once(')').unwrap();
        let time_s: f64 = time.parse().unwrap();
        let start_s = *start_s.get_or_insert(time_s);
        let (at_s, rest) = change(time_s - start_s, rest)?;
        Some(format!("({:.6}){rest}\n", start_s + at_s))
    };
    let text: String = text.lines().filter_map(line).collect();
    let path = path(folder.path(), "changed.log");
    fs::write(&path, text).unwrap();
    (folder, path)
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

#[test]
fn a_file_that_is_no_database_is_said_to_be_none() {
    let output = xt28(&["gap", "where", &log(), "--dbc", &log()]);
    let talk = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{talk}");
    assert!(talk.contains("short.log: is no DBC, as no line of it declares a message"), "{talk}");
}

#[test]
fn a_log_that_is_too_short_is_refused_with_its_length() {
    let (_folder, log) = changed(|at_s, rest| (at_s < 2.0).then(|| (at_s, rest.to_owned())));
    let talk = refusal(&[&log]);
    assert!(
        talk.contains(
            "changed.log: only 2.00 s of it have every signal, and a diagnosis needs 5 s"
        ),
        "{talk}"
    );
}

#[test]
fn a_clock_that_steps_is_refused_with_its_line() {
    let ahead = |at_s: f64, rest: &str| {
        Some((if at_s > 5.0 { at_s + 3600.0 } else { at_s }, rest.to_owned()))
    };
    let (_folder, log) = changed(ahead);
    let talk = refusal(&[&log]);
    assert!(talk.contains(": no frames for 3600.0 s, or a clock step; cut the log"), "{talk}");
    let back =
        |at_s: f64, rest: &str| Some((if at_s > 5.0 { at_s - 3.0 } else { at_s }, rest.to_owned()));
    let (_folder, log) = changed(back);
    let talk = refusal(&[&log]);
    assert!(talk.contains("clock steps by -") && talk.contains("cut the log before"), "{talk}");
}

/// Identifier of a message of the bench's database, as a log writes it.
fn id(message: &str) -> String {
    let dbc = fs::read_to_string(DBC).unwrap();
    let line = dbc.lines().find(|line| line.contains(&format!(" {message}: "))).unwrap();
    let raw: u32 = line.split(' ').nth(1).unwrap().parse().unwrap();
    if raw > 0x8000_0000 { format!("{:08X}", raw - 0x8000_0000) } else { format!("{raw:03X}") }
}

#[test]
fn a_signal_that_was_not_recorded_is_named_with_its_message() {
    for (message, words) in [
        ("PosFront", "no frame `PosFront` in the log"),
        ("DriveCurrent", "steer_current.front_A (DriveCurrent."),
    ] {
        let id = format!(" {}#", id(message));
        let (_folder, log) =
            changed(|at_s, rest| (!rest.contains(&id)).then(|| (at_s, rest.to_owned())));
        let talk = refusal(&[&log]);
        assert!(talk.contains(words), "{talk}");
    }
}

/// Its wheel loads are worked out from the cylinders'; a replay alone compares those that a log has.
#[test]
fn a_log_without_wheel_loads_is_looked_at_as_one_with_them() {
    let ids = ["WheelForceFront", "WheelForceMidRear"].map(|name| format!(" {}#", id(name)));
    let (_with, with) = changed(|at_s, rest| Some((at_s, rest.to_owned())));
    let (_without, without) = changed(|at_s, rest| {
        (!ids.iter().any(|id| rest.contains(id))).then(|| (at_s, rest.to_owned()))
    });
    assert!(fs::metadata(&without).unwrap().len() < fs::metadata(&with).unwrap().len());
    let where_of = |log: &str| xt28(&["gap", "where", log, "--dbc", DBC]);
    let [with, without] = [where_of(&with), where_of(&without)];
    assert_ne!(without.status.code(), Some(2), "{}", String::from_utf8_lossy(&without.stderr));
    assert!(!with.stdout.is_empty());
    assert_eq!(without.stdout, with.stdout);
}

/// No block is driven by it; a replay's machine would not move without.
#[test]
fn a_database_without_enable_is_diagnosed_as_one_with_it() {
    let folder = tempfile::tempdir().unwrap();
    let (dbc, json) = (path(folder.path(), "own.dbc"), path(folder.path(), "a.json"));
    let text = fs::read_to_string(DBC).unwrap();
    let without: Vec<&str> = text.lines().filter(|line| !line.contains(" Enable ")).collect();
    assert!(without.len() < text.lines().count());
    fs::write(&dbc, without.join("\n") + "\n").unwrap();
    let answer = |dbc: &str| {
        let output =
            xt28(&["gap", "diagnose", &log(), "--dbc", dbc, "--no-how-far", "--json", &json]);
        assert_ne!(output.status.code(), Some(2), "{}", String::from_utf8_lossy(&output.stderr));
        let answer = fs::read_to_string(&json).unwrap();
        // Behind it come the time that it took and the files that it rests on.
        let (answer, _) = answer.split_once(",\n  \"seconds\"").unwrap();
        answer.to_owned()
    };
    assert_eq!(answer(&dbc), answer(DBC));
    let output = xt28(&["replay", &log(), "--dbc", &dbc]);
    let talk = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{talk}");
    assert!(talk.contains("a replay needs target.enable, and log or DBC has none"), "{talk}");
}

#[test]
fn a_message_that_stops_or_begins_late_is_told_and_the_rest_left_out() {
    let heard_of = |message: &str, from_s: f64, to_s: f64| {
        let id = format!(" {}#", id(message));
        let (_folder, log) = changed(|at_s, rest| {
            let is_there = (from_s..to_s).contains(&at_s) || !rest.contains(&id);
            is_there.then(|| (at_s, rest.to_owned()))
        });
        let output = xt28(&["gap", "where", &log, "--dbc", DBC]);
        (output.status.code(), String::from_utf8(output.stderr).unwrap())
    };
    let heard = |from_s, to_s| heard_of("PosFront", from_s, to_s);
    let (status, talk) = heard(0.0, 8.0);
    assert_ne!(status, Some(2), "{talk}");
    assert!(talk.contains("stroke.FR stops at 8.0 s of a log of 10.0 s"), "{talk}");
    assert!(talk.contains("only 0.0 to 8.0 s of it are looked at"), "{talk}");
    let (_, talk) = heard(2.0, 20.0);
    assert!(talk.contains(" begins at 2.0 s of a log of 10.0 s"), "{talk}");
    let (status, talk) = heard(3.0, 7.0);
    assert_eq!(status, Some(2), "{talk}");
    assert!(
        talk.contains("only 3.99 s of it have every signal, and a diagnosis needs 5 s"),
        "{talk}"
    );
    // Pressures are read where they are logged, though a diagnosis does without.
    let (_, talk) = heard_of("PressMid", 0.0, 8.0);
    assert!(talk.contains("bore_pressure.MR stops at 8.0 s"), "{talk}");
    // But most of a log is not given for them.
    let (status, talk) = heard_of("PressMid", 6.0, 20.0);
    assert_ne!(status, Some(2), "{talk}");
    assert!(
        talk.contains("bore_pressure.MR begins at 6.0 s, as 3 more that come and go"),
        "{talk}"
    );
    assert!(talk.contains("looked at without") && !talk.contains("are looked at."), "{talk}");
}

#[test]
fn what_a_message_held_while_it_was_away_is_not_taken_for_measured() {
    let id = format!(" {}#", id("PosFront"));
    let where_of = |log: &str| {
        let output = xt28(&["gap", "where", log, "--dbc", DBC]);
        (output.status.code(), String::from_utf8(output.stderr).unwrap())
    };
    let away = |id: &str, from_s: f64, to_s: f64| {
        let (_folder, log) = changed(|at_s, rest| {
            let is_there = !(from_s..to_s).contains(&at_s) || !rest.contains(id);
            is_there.then(|| (at_s, rest.to_owned()))
        });
        where_of(&log)
    };
    let (status, talk) = away(&id, 6.0, 8.0);
    assert_ne!(status, Some(2), "{talk}");
    assert!(!talk.contains("held") && !talk.contains("missing"), "it is left out: {talk}");
    assert!(talk.contains("stroke.FR is away from 6.0 to 8.0 s of a log of 10.0 s"), "{talk}");
    assert!(talk.contains("only 0.0 to 6.0 s of it are looked at"), "{talk}");
    let (_, talk) = away(&id, 6.0, 6.5);
    assert!(
        talk.contains("PosFront is missing") && talk.contains(", from 5.99 to 6.50 s"),
        "{talk}"
    );
    assert!(talk.contains("the value before is held") && !talk.contains("looked at"), "{talk}");
    let (_, talk) = away(&format!(" {}#", self::id("PressMid")), 3.0, 7.0);
    assert!(talk.contains("looked at without") && !talk.contains("is held"), "{talk}");
    // The logger paused, or its clock went ahead: one cannot tell which.
    let (_folder, log) =
        changed(|at_s, rest| Some((if at_s > 3.0 { at_s + 0.3 } else { at_s }, rest.to_owned())));
    let (_, talk) = where_of(&log);
    assert!(talk.contains("nothing was logged from 3.00 to 3.3"), "{talk}");
    assert!(!talk.contains("held") && !talk.contains("missing"), "it is left out: {talk}");
    assert!(talk.contains("only 3.3 to 10.3 s of it are looked at"), "{talk}");
}

#[test]
fn a_clock_that_was_set_back_a_little_makes_two_logs_too() {
    let (_folder, log) =
        changed(|at_s, rest| Some((if at_s > 5.0 { at_s - 0.2 } else { at_s }, rest.to_owned())));
    let talk = refusal(&[&log]);
    assert!(talk.contains("clock steps by -0.2") && talk.contains("cut the log"), "{talk}");
}

#[test]
fn pressures_on_another_scale_than_loads_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let dbc = path(folder.path(), "bar.dbc");
    let text = fs::read_to_string(DBC).unwrap();
    let wrong = text.replace("(1,0) [0|65535] \"kPa\"", "(0.1,0) [0|65535] \"kPa\"");
    assert_ne!(wrong, text, "there are pressures");
    fs::write(&dbc, wrong).unwrap();
    let output = xt28(&["gap", "where", &log(), "--dbc", &dbc]);
    let talk = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{talk}");
    assert!(talk.contains("0.10 on FR") && talk.contains("check unit and factor"), "{talk}");
}

#[test]
fn a_log_without_chamber_pressures_is_taken_with_a_word() {
    let pressures = ["PressFront", "PressMid", "PressRear"].map(|name| format!(" {}#", id(name)));
    let (_folder, log) = changed(|at_s, rest| {
        let is_pressure = pressures.iter().any(|id| rest.contains(id));
        (!is_pressure).then(|| (at_s, rest.to_owned()))
    });
    let output = xt28(&["gap", "where", &log, "--dbc", DBC]);
    let talk = String::from_utf8(output.stderr).unwrap();
    assert_ne!(output.status.code(), Some(2), "{talk}");
    assert!(talk.contains("which come more slowly and say less: changed.log."), "{talk}");
}

#[test]
fn the_log_of_another_bus_is_refused_with_what_is_on_it() {
    let other = |at_s: f64, rest: &str| {
        let data = rest.split_once('#').unwrap().1;
        Some((at_s, format!(" can0 18FF0001#{data}")))
    };
    let (_folder, log) = changed(other);
    let talk = refusal(&[&log]);
    assert!(talk.contains("none of its") && talk.contains("18FF0001"), "{talk}");
}

#[test]
fn a_mapping_in_another_unit_is_refused_with_what_it_reads() {
    let folder = tempfile::tempdir().unwrap();
    let mapping = path(folder.path(), "m.toml");
    let text = "[signals]\n\"stroke.FR\" = { signal = \"PosFront.FR\", unit = \"m\" }\n";
    fs::write(&mapping, text).unwrap();
    let talk = refusal(&[&log(), "--mapping", &mapping]);
    assert!(talk.contains("stroke.FR (PosFront.FR) reads"), "{talk}");
    assert!(talk.contains("check DBC and mapping (signal, unit, scale)"), "{talk}");
}

#[test]
fn wheels_in_another_order_are_named_and_not_put_in_order() {
    let folder = tempfile::tempdir().unwrap();
    let mapping = path(folder.path(), "m.toml");
    let text = "[signals]\n\"stroke.FR\" = \"PosFront.FL\"\n\"stroke.FL\" = \"PosFront.FR\"\n";
    fs::write(&mapping, text).unwrap();
    let talk = refusal(&[&log(), "--mapping", &mapping]);
    assert!(talk.contains("wheels look swapped"), "{talk}");
    assert!(talk.contains("the stroke of FL follows the target of FR"), "{talk}");
    assert!(talk.contains("the stroke of FR follows the target of FL"), "{talk}");
    // The map is drawn all the same, and says so.
    let output = xt28(&["gap", "where", &log(), "--dbc", DBC, "--mapping", &mapping]);
    let talk = String::from_utf8(output.stderr).unwrap();
    assert_ne!(output.status.code(), Some(2), "{talk}");
    assert!(talk.contains("wheels look swapped"), "{talk}");
}

#[test]
fn what_lies_beside_and_speaks_of_other_logs_is_loudly_passed_over_unless_it_was_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    let [copy, about, flat] =
        ["short.log", "about.toml", "flat.toml"].map(|name| path(folder.path(), name));
    fs::copy(log(), &copy).unwrap();
    fs::write(&about, "case = \"other\"\nrun = []\n").unwrap();
    fs::write(&flat, "kind = \"flat\"\n").unwrap();
    for task in [&["where"][..], &["diagnose", "--no-how-far"]] {
        let of =
            |more: &[&str]| xt28(&[&["gap"], task, &[copy.as_str(), "--dbc", DBC], more].concat());
        let beside = of(&[]);
        let talk = String::from_utf8(beside.stderr).unwrap();
        assert_ne!(beside.status.code(), Some(2), "{talk}");
        assert!(talk.contains("IGNORED for short.log: ") && talk.contains("about.toml"), "{talk}");
        assert!(talk.contains("taken as driven on level ground"), "{talk}");
        let asked = of(&["--about", &about]);
        let talk = String::from_utf8(asked.stderr).unwrap();
        assert_eq!(asked.status.code(), Some(2), "{talk}");
        assert!(talk.contains("about.toml: no [[run]] with file = \"short.log\""), "{talk}");
        assert!(talk.contains("--terrain"), "{talk}");
        let told = of(&["--terrain", &flat]);
        let talk = String::from_utf8(told.stderr).unwrap();
        assert_ne!(told.status.code(), Some(2), "{talk}");
        assert!(talk.contains("taken as driven where --terrain says"), "{talk}");
    }
}

#[test]
fn what_lies_beside_one_days_logs_speaks_of_no_other_days() {
    let folder = tempfile::tempdir().unwrap();
    let days = ["monday", "tuesday"].map(|day| folder.path().join(day));
    let [first, other] = days.each_ref().map(|day| {
        fs::create_dir(day).unwrap();
        let copy = path(day, "run-1.log");
        fs::copy(log(), &copy).unwrap();
        copy
    });
    let about = path(&days[0], "about.toml");
    let known =
        "case = \"monday\"\n[[run]]\nfile = \"run-1.log\"\nterrain = \"flat\"\nfit = true\n";
    fs::write(&about, known).unwrap();
    let talk = refusal(&[&first, &other]);
    assert!(talk.contains("about.toml lies beside the first log"), "{talk}");
    assert!(talk.contains("tuesday") && talk.contains("--about"), "{talk}");
    // Said outright it is for all, and what one run says of two logs is not taken for either.
    let talk = refusal(&[&first, &other, "--about", &about]);
    assert!(talk.contains("about.toml:3: run run-1.log would speak of"), "{talk}");
    assert!(talk.contains("file = \"tuesday/run-1.log\""), "{talk}");
    // With a run for each, that both are one log is found.
    let run =
        |day| format!("[[run]]\nfile = \"{day}/run-1.log\"\nterrain = \"flat\"\nfit = true\n");
    fs::write(&about, ["case = \"two days\"\n".to_owned(), run("monday"), run("tuesday")].concat())
        .unwrap();
    let talk = refusal(&[&first, &other, "--about", &about]);
    assert!(talk.contains("the same log as"), "{talk}");
}

/// Whether a refusal of `outputs` says `words` and leaves the log and its database as they were.
fn assert_kept(outputs: &[&str], files: [&str; 2], words: &str) {
    let [log, dbc] = files;
    let before = files.map(|file| fs::read(file).unwrap());
    let output = xt28(&[&["gap", "diagnose", log, "--dbc", dbc], outputs].concat());
    let talk = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{talk}");
    assert!(talk.contains(words), "{talk}");
    assert_eq!(files.map(|file| fs::read(file).unwrap()), before);
}

#[test]
fn no_answer_is_written_over_what_was_asked_about_nor_over_another() {
    let folder = tempfile::tempdir().unwrap();
    let [copy, dbc, effects, next, script, out] =
        ["a.log", "a.dbc", "e.toml", "n.toml", "n.script.toml", "out"]
            .map(|name| path(folder.path(), name));
    fs::copy(log(), &copy).unwrap();
    fs::copy(DBC, &dbc).unwrap();
    fs::write(&effects, "").unwrap();
    let files = [copy.as_str(), dbc.as_str()];
    assert_kept(&["--json", &dbc], files, "this command reads that file; give --json another");
    assert_kept(&["--report", &copy], files, "give --report another");
    let both = ["--effects", effects.as_str(), "--overlay", &effects];
    assert_kept(&both, files, "give --overlay another");
    assert_kept(&["--json", &out, "--report", &out], files, "would write the same file");
    assert_kept(&["--next", &next, "--overlay", &script], files, "would write the same file");
    assert!(!fs::exists(&out).unwrap() && !fs::exists(&next).unwrap());
    fs::copy(log(), &out).unwrap();
    assert_kept(&["--json", &out], files, "is no JSON to be replaced; give --json another");
}
