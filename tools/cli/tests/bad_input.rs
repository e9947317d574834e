//! What the command answers to bad input: one line with file, line and remedy, exit status 2.

mod command;

use std::fs;
use std::path::PathBuf;
use std::process::{Command, Stdio};

use command::xt28;

/// The one line of a refusal.
fn refusal(arguments: &[&str]) -> String {
    let output = xt28(arguments);
    let talk = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{talk}");
    assert!(output.stdout.is_empty(), "a refusal leaves no data");
    assert_eq!(talk.lines().count(), 1, "{talk}");
    assert!(talk.starts_with("xt28: "), "{talk}");
    talk
}

fn file(folder: &tempfile::TempDir, name: &str, text: &str) -> String {
    let path: PathBuf = folder.path().join(name);
    fs::write(&path, text).unwrap();
    path.to_str().unwrap().to_owned()
}

const SCENARIO: &str = "title = \"t\"\npolicy = \"hold\"\nduration_s = 1\n[[expect]]\nstands-still = { below_m_s = 0.1 }\n";

#[test]
fn an_unknown_scenario_is_answered_with_the_nearest() {
    let talk = refusal(&["run", "straight-25"]);
    assert!(talk.contains("did you mean `straight-25m`?"), "{talk}");
}

#[test]
fn a_file_that_is_named_as_a_scenario_is_pointed_at() {
    let folder = tempfile::tempdir().unwrap();
    file(&folder, "mine", SCENARIO);
    let run = |name: &str| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_xt28"));
        command.args(["run", name]).current_dir(folder.path()).output().unwrap()
    };
    let talk = String::from_utf8(run("mine").stderr).unwrap();
    assert!(talk.contains("a file mine is there; write ./mine, or name it mine.toml"), "{talk}");
    assert_eq!((talk.lines().count(), run("mine").status.code()), (1, Some(2)), "{talk}");
    assert!(run("./mine").status.success());
}

#[test]
fn a_command_of_another_level_is_answered_with_its_whole_name() {
    for (asked, meant) in [
        (&["diagnose", "a.log"][..], "xt28 gap diagnose"),
        (&["where"], "xt28 gap where"),
        (&["check"], "xt28 gap check"),
        (&["drive", "mixed"], "xt28 gap drive"),
        (&["show"], "xt28 config show"),
        (&["gap", "replay"], "xt28 replay"),
    ] {
        let output = xt28(asked);
        let talk = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{talk}");
        assert!(talk.contains(&format!("did you mean {meant}?")), "{talk}");
    }
    let talk = String::from_utf8(xt28(&["dance"]).stderr).unwrap();
    assert!(talk.contains("dance") && !talk.contains("did you mean"), "{talk}");
}

#[test]
fn an_effect_that_the_ecus_of_a_scenario_do_not_hear_of_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let text = "[[effect]]\nname = \"steer-gain\"\nkp_factor = 0.5\n";
    let overlay = file(&folder, "weak.toml", text);
    let talk = refusal(&["run", "2016-bend", "--effects", &overlay]);
    assert!(talk.contains("weak.toml: \"steer-gain\" acts in loops"), "{talk}");
}

#[test]
fn an_overlay_that_says_nothing_of_effects_is_refused_and_one_that_says_none_is_not() {
    let folder = tempfile::tempdir().unwrap();
    let empty = file(&folder, "empty.toml", "");
    let talk = refusal(&["run", "2016-bend", "--effects", &empty]);
    assert!(talk.contains("empty.toml:1: no [[effect]] in this file"), "{talk}");
    let none = file(&folder, "none.toml", "# nothing found\neffect = []\n");
    let scenario = file(&folder, "still.toml", SCENARIO);
    let output = xt28(&["run", &scenario, "--effects", &none]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

#[test]
fn a_missing_scenario_file_is_named() {
    let talk = refusal(&["run", "no/such.toml"]);
    assert!(talk.contains("no/such.toml: cannot read the scenario"), "{talk}");
}

#[test]
fn an_unknown_key_or_unit_is_named_with_file_line_and_the_known_ones() {
    let folder = tempfile::tempdir().unwrap();
    for (from, to, line, known) in [
        ("duration_s", "duration_ms", ":3: unknown field `duration_ms`", "duration_s"),
        ("below_m_s", "below_km_h", ":5: unknown field `below_km_h`", "below_m_s"),
        ("title", "name", ":1: unknown field `name`", "title"),
        ("= 1\n", "= \"1 s\"\n", ":3: invalid type", "f64"),
    ] {
        let path = file(&folder, "bad.toml", &SCENARIO.replace(from, to));
        let talk = refusal(&["run", &path]);
        assert!(talk.contains(&format!("{path}{line}")), "{talk}");
        assert!(talk.contains(known), "{talk}");
    }
}

#[test]
fn a_policy_that_is_none_is_named_with_its_line() {
    let folder = tempfile::tempdir().unwrap();
    let path = file(&folder, "bad.toml", &SCENARIO.replace("\"hold\"", "\"drive\""));
    let talk = refusal(&["run", &path]);
    assert!(talk.contains(&format!("{path}:2: no policy")), "{talk}");
    assert!(talk.contains("goto:X,Y,HEADING"), "{talk}");
    let path = file(&folder, "bad.toml", &SCENARIO.replace("\"hold\"", "\"script:s.toml\""));
    assert!(refusal(&["run", &path]).contains(&format!("{path}:2: cannot read")));
    file(&folder, "s.toml", "[[command]]\nat_s = 1\nthrottle = 40\n");
    let talk = refusal(&["run", &path]);
    assert!(talk.contains("s.toml:3: unknown field `throttle`"), "{talk}");
}

#[test]
fn a_bad_machine_file_is_named_with_its_line() {
    let folder = tempfile::tempdir().unwrap();
    let machine = file(&folder, "m.toml", "[masses]\narm_lb = 441\n");
    let talk = refusal(&["config", "show", "--machine", &machine]);
    assert!(talk.contains("m.toml:2: unknown field `arm_lb`"), "{talk}");
    let path = file(&folder, "s.toml", &format!("machine = \"m.toml\"\n{SCENARIO}"));
    assert!(refusal(&["run", &path]).contains("m.toml:2:"));
    assert!(refusal(&["run", "straight-25m", "--machine", &machine]).contains("m.toml:2:"));
}

#[test]
fn a_number_that_an_effect_does_not_take_is_named() {
    for (arguments, says) in [
        (&["delay_s=9"][..], "arm-delay:6: delay_s = 9 is outside 0 to 1"),
        (&["late=1"], "arm-delay has no `late`, but delay_s"),
    ] {
        let talk = refusal(&[&["effects", "arm-delay"], arguments].concat());
        assert!(talk.contains(says), "{talk}");
    }
    for (arguments, says) in [
        (&["delay_s"][..], "expected KEY=VALUE"),
        (&["delay_s=soon"], "`soon` is no number"),
        (&["delay_s=0.2", "--scope", "left-front"], "left-front"),
    ] {
        let output = xt28(&[&["effects", "arm-delay"], arguments].concat());
        assert_eq!(output.status.code(), Some(2));
        let talk = String::from_utf8(output.stderr).unwrap();
        assert!(talk.contains(says), "{talk}");
    }
    let talk = refusal(&["effects", "steer-delay", "delay_s=0.2", "--scope", "FR"]);
    assert!(talk.contains("steer-delay is of the whole machine"), "{talk}");
}

#[test]
fn a_unit_that_a_mapping_says_is_refused_at_the_mappings_line() {
    let folder = tempfile::tempdir().unwrap();
    let unit = "{ signal = \"Attitude.Roll\", unit = \"furlong\" }";
    let mapping = file(&folder, "map.toml", &format!("[signals]\n\"attitude.roll\" = {unit}\n"));
    let dbc = concat!(env!("CARGO_MANIFEST_DIR"), "/../../dbc/xt28.dbc");
    let talk = refusal(&["gap", "where", "a.log", "--dbc", dbc, "--mapping", &mapping]);
    assert!(talk.contains("map.toml:2: signal `Attitude.Roll` is in `furlong`"), "{talk}");
}

#[test]
fn a_bus_that_does_not_exist_is_refused_before_anything_starts() {
    let talk = refusal(&["run", "straight-25m", "--bus", "nocan7"]);
    assert!(talk.contains("nocan7"), "{talk}");
}

/// That of a documentation's network is nobody's.
#[test]
fn an_address_of_another_machine_is_told_from_a_port_that_is_taken() {
    let run = |policy: &str| refusal(&["run", "straight-25m", "--policy", policy]);
    let talk = run("rosbridge:192.0.2.9:9090");
    assert!(talk.contains("this machine has no such address") && !talk.contains("taken"), "{talk}");
    let holder = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
    let talk = run(&format!("rosbridge:{}", holder.local_addr().unwrap().port()));
    assert!(talk.contains("is the port taken?"), "{talk}");
}

#[test]
fn a_folder_that_cannot_be_made_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = file(&folder, "taken", "");
    let talk = refusal(&["run", "straight-25m", "--out", &path]);
    assert!(talk.contains("taken: cannot make this folder"), "{talk}");
}

#[test]
fn an_unknown_option_is_usage() {
    let output = xt28(&["run", "straight-25m", "--sed", "3"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8(output.stderr).unwrap().contains("--seed"));
}

/// A DBC of the field, kept by the crate that reads field logs.
const FIELD_DBC: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../gap/tests/field.dbc");

#[test]
fn a_log_cut_in_the_middle_is_named_with_its_line() {
    let folder = tempfile::tempdir().unwrap();
    let text = "(1.500000) can0 0CFF4027#5555555555551299\n(1.510000) can0 0CFF40";
    let log = file(&folder, "cut.log", text);
    for command in [&["replay"][..], &["gap", "where"], &["gap", "diagnose"]] {
        let arguments = [command, &[&log, "--dbc", FIELD_DBC]].concat();
        let talk = refusal(&arguments);
        assert!(talk.contains("cut.log:2: log is cut"), "{talk}");
        // The remedy that it names is one that the command knows.
        assert!(talk.contains("--accept-cut"), "{talk}");
        let talk = refusal(&[&arguments[..], &["--accept-cut"]].concat());
        assert!(talk.contains("cut.log: no frame"), "{talk}");
    }
}

#[test]
fn a_dbc_without_a_frame_is_named_with_the_frame() {
    let folder = tempfile::tempdir().unwrap();
    let text = fs::read_to_string(FIELD_DBC).unwrap();
    assert!(text.contains("PosFront"));
    let lacking = text.replace("PosFront", "SomethingElse");
    let dbc = file(&folder, "lacking.dbc", &lacking);
    let log = file(&folder, "a.log", "(1.500000) can0 0CFF4027#5555555555551299\n");
    let talk = refusal(&["replay", &log, "--dbc", &dbc]);
    assert!(talk.contains("lacking.dbc: no message `PosFront`"), "{talk}");
}

#[test]
fn a_misspelt_answer_is_named_before_anything_is_diagnosed() {
    let folder = tempfile::tempdir().unwrap();
    let set = folder.path().join("set");
    fs::create_dir_all(set.join("one")).unwrap();
    fs::create_dir(folder.path().join("answers")).unwrap();
    fs::write(set.join("one/about.toml"), "").unwrap();
    let answer = "case = \"one\"\nkind = \"single\"\n[[truth]]\neffect = \"ArmDealy\"\n";
    file(&folder, "answers/one.toml", answer);
    let talk = refusal(&["gap", "check", "--set", set.to_str().unwrap()]);
    assert!(talk.contains("one.toml:4: `ArmDealy` is no effect"), "{talk}");
    assert!(talk.contains("did you mean `arm-delay`?"), "{talk}");
    let talk = refusal(&["gap", "check", "--set", "no/such"]);
    assert!(talk.contains("no/such: cannot read"), "{talk}");
}

#[test]
fn scores_are_not_written_over_a_case() {
    let folder = tempfile::tempdir().unwrap();
    let set = folder.path().join("set");
    fs::create_dir_all(set.join("one")).unwrap();
    fs::create_dir(folder.path().join("answers")).unwrap();
    let about = file(&folder, "set/one/about.toml", "case = \"one\"\nrun = []\n");
    let answer = file(&folder, "answers/one.toml", "case = \"one\"\nkind = \"null\"\n");
    let set = set.to_str().unwrap();
    for (option, kept) in [("--json", &about), ("--curve", &answer)] {
        let talk = refusal(&["gap", "check", "--set", set, option, kept]);
        assert!(talk.contains(&format!("reads that file; give {option} another")), "{talk}");
    }
    let one = folder.path().join("one").to_str().unwrap().to_owned();
    let talk = refusal(&["gap", "check", "--set", set, "--json", &one, "--curve", &one]);
    assert!(talk.contains("--json and --curve would write the same file"), "{talk}");
}

#[test]
fn a_file_that_cannot_be_written_is_refused_before_the_work() {
    let folder = tempfile::tempdir().unwrap();
    let log = file(&folder, "a.log", "no log at all");
    for option in ["--json", "--report", "--overlay", "--next"] {
        let talk = refusal(&["gap", "diagnose", &log, "--dbc", FIELD_DBC, option, "no/such/out"]);
        assert!(talk.contains("no/such/out: cannot write"), "{talk}");
    }
    let talk = refusal(&["gap", "check", "--json", "no/such/out"]);
    assert!(talk.contains("no/such/out: cannot write"), "{talk}");
    let talk =
        refusal(&["replay", &file(&folder, "b.log", LINE), "--dbc", FIELD_DBC, "--plot", "/"]);
    assert!(talk.contains("/: cannot write"), "{talk}");
}

const LINE: &str = "(1.500000) can0 0CFF4027#5555555555551299\n";

#[test]
fn what_a_command_reads_or_did_not_write_is_not_replaced() {
    let folder = tempfile::tempdir().unwrap();
    let log = file(&folder, "a.log", LINE);
    let about = file(&folder, "about.toml", "case = \"mine\"");
    let talk = refusal(&["replay", &log, "--dbc", FIELD_DBC, "--plot", &about]);
    assert!(talk.contains("about.toml: this command reads that file"), "{talk}");
    let scenario = file(&folder, "s.toml", SCENARIO);
    let talk = refusal(&["run", &scenario, "--record", &scenario]);
    assert!(talk.contains("s.toml: this command reads that file; give --record"), "{talk}");
    assert_eq!(fs::read_to_string(&scenario).unwrap(), SCENARIO);
    let mine = file(&folder, "mine.script.toml", "# mine\n");
    let out = folder.path().join("mine.toml");
    let talk = refusal(&["gap", "drive", "single-arm", "--out", out.to_str().unwrap()]);
    assert!(talk.contains("mine.script.toml is there and is not the script of a drive"), "{talk}");
    assert_eq!(fs::read_to_string(&mine).unwrap(), "# mine\n");
    assert_eq!(fs::read_to_string(&about).unwrap(), "case = \"mine\"");
    // Its own it writes again.
    for _ in 0..2 {
        let out = folder.path().join("drive.toml");
        let output = xt28(&["gap", "drive", "straight", "--out", out.to_str().unwrap()]);
        assert!(output.status.success());
    }
}

#[test]
fn a_reader_that_goes_away_is_no_failure() {
    let mut child = Command::new(env!("CARGO_BIN_EXE_xt28"))
        .args(["config", "show"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success() && output.stderr.is_empty(), "{output:?}");
}
