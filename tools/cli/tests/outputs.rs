//! What a command writes: never over what it reads or what it wrote before, and nothing is lost for the sake of it.

mod command;

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

use command::xt28;

/// What is said of a command that could not be done.
fn refusal(arguments: &[&str]) -> String {
    let output = xt28(arguments);
    let talk = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{talk}");
    talk
}

/// A folder, and files in it by name.
fn folder_with(files: &[(&str, &str)]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        fs::write(folder.path().join(name), text).unwrap();
    }
    folder
}

fn path(folder: &tempfile::TempDir, name: &str) -> String {
    folder.path().join(name).to_str().unwrap().to_owned()
}

const SCENARIO: &str = "title = \"t\"\npolicy = \"hold\"\nduration_s = 0.5\n";
const FLIES: &str = "[[expect]]\nreaches-pose = { x_m = 9, y_m = 0, heading_deg = 0, within_m = 1, within_deg = 9 }\n";

/// A log of an earlier run, and one of a machine.
const OLD: &str = "(0.000137) vcan0 001#\n";
const FIELD: &str = "(1758184151.281373) can0 001#\n";

#[test]
fn a_run_that_is_refused_leaves_the_log_of_an_earlier_one() {
    let heavy = "[[effect]]\nname = \"payload\"\nmass_kg = 14000.0\n";
    let builtin = String::from_utf8(xt28(&["config", "show"]).stdout).unwrap();
    let folder = folder_with(&[
        ("s.toml", SCENARIO),
        ("bad.toml", &SCENARIO.replace("hold", "nosuch")),
        ("heavy.toml", heavy),
        ("weak.toml", &builtin.replace("load_max_kg = 14000.0", "load_max_kg = 9000.0")),
        ("old.log", OLD),
        ("field.log", FIELD),
    ]);
    let names = ["s.toml", "bad.toml", "heavy.toml", "weak.toml", "old.log"];
    let [s, bad, heavy, weak, log] = names.map(|name| path(&folder, name));
    let talk = refusal(&["run", &bad, "--record", &log]);
    assert!(talk.contains("bad.toml:2: no policy"), "{talk}");
    let talk = refusal(&["run", &s, "--machine", &weak, "--effects", &heavy, "--record", &log]);
    assert!(talk.contains("more than this machine carries"), "{talk}");
    assert_eq!(fs::read_to_string(&log).unwrap(), OLD);
    assert!(xt28(&["run", &s, "--record", &log]).status.success());
    assert_ne!(fs::read_to_string(&log).unwrap(), OLD);
    let field = path(&folder, "field.log");
    let talk = refusal(&["run", &s, "--record", &field]);
    assert!(talk.contains("is no log of the bench in simulated time"), "{talk}");
    assert!(talk.contains("give --record another"), "{talk}");
    assert_eq!(fs::read_to_string(&field).unwrap(), FIELD);
}

#[test]
fn a_log_of_a_machine_is_kept_though_its_times_begin_at_zero() {
    let unset = "(0.000137) can0 001#\n(0.010137) can0 001#\n";
    let others = [
        unset,
        "(0.000137) vcan0 001#",
        "(0.000137) vcan00 001#\n",
        "(0.000137) vcan0 notes\n",
        "(0.5, 0.5) is where it stood\n",
        "(17.000137) vcan0 001#\n",
    ];
    for kept in others {
        let folder = folder_with(&[("s.toml", SCENARIO), ("field.log", kept)]);
        let [s, field] = ["s.toml", "field.log"].map(|name| path(&folder, name));
        let talk = refusal(&["run", &s, "--record", &field]);
        assert!(talk.contains("field.log: it is there, and is no log of the bench"), "{talk}");
        assert!(talk.contains("vcan0"), "{talk}");
        assert_eq!(fs::read_to_string(&field).unwrap(), kept);
    }
}

#[test]
fn a_run_writes_over_nothing_that_it_reads() {
    let action = "[[action]]\nat_s = 0.1\nleft_button = 18\n";
    let kerb = "kind = \"step\"\nx_m = 6\nheight_m = 0.15\n";
    let map = "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 9\n0 0\n0 0\n";
    let of_map = "[terrain.height_map]\nfile = \"map.asc\"\n";
    let folder = folder_with(&[
        ("op.toml", action),
        ("cab.toml", &format!("profile = \"2016\"\noperator = \"op.toml\"\n{SCENARIO}")),
        ("kerb.toml", kerb),
        ("ground.toml", &format!("terrain = \"kerb.toml\"\n{SCENARIO}")),
        ("map.asc", map),
        ("mapped.toml", &format!("{SCENARIO}{of_map}")),
    ]);
    for (scenario, input, text) in [
        ("cab.toml", "op.toml", action),
        ("ground.toml", "kerb.toml", kerb),
        ("mapped.toml", "map.asc", map),
    ] {
        let (scenario, input) = (path(&folder, scenario), path(&folder, input));
        let talk = refusal(&["run", &scenario, "--record", &input]);
        assert!(talk.contains("this command reads that file; give --record another"), "{talk}");
        assert_eq!(fs::read_to_string(input).unwrap(), text);
    }
}

#[test]
fn the_log_is_none_of_the_other_files_of_a_run() {
    let folder = folder_with(&[("s.toml", SCENARIO), ("s.json", "{}")]);
    let (scenario, out) = (path(&folder, "s.toml"), folder.path().to_str().unwrap());
    for name in ["s.json", "s.svg"] {
        let talk = refusal(&["run", &scenario, "--record", &path(&folder, name), "--out", out]);
        assert!(talk.contains("--record and --out would write the same file"), "{talk}");
    }
    let log = path(&folder, "s.log");
    assert!(xt28(&["run", &scenario, "--record", &log, "--out", out]).status.success());
    // A scenario may have any name.
    fs::copy(&scenario, path(&folder, "s.json")).unwrap();
    let talk = refusal(&["run", &path(&folder, "s.json"), "--out", out]);
    assert!(talk.contains("reads that file; give --out another"), "{talk}");
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_named_with_the_file_and_costs_no_report() {
    let folder = folder_with(&[("s.toml", SCENARIO)]);
    let (scenario, out) = (path(&folder, "s.toml"), folder.path().to_str().unwrap());
    let talk = refusal(&["run", &scenario, "--record", "/dev/full"]);
    assert!(talk.starts_with("xt28: /dev/full: cannot write"), "{talk}");
    std::os::unix::fs::symlink("/dev/full", path(&folder, "s.svg")).unwrap();
    let output = xt28(&["run", &scenario, "--out", out]);
    assert_eq!(output.status.code(), Some(2));
    let talk = String::from_utf8(output.stderr).unwrap();
    assert!(talk.contains("s.svg: cannot write: No space left"), "{talk}");
    assert!(String::from_utf8(output.stdout).unwrap().contains("s passed"), "the report was made");
}

#[test]
fn a_reader_that_goes_away_takes_no_verdict_with_it() {
    let folder = folder_with(&[("s.toml", &format!("{SCENARIO}{FLIES}"))]);
    let out = folder.path().join("out");
    let mut child = Command::new(env!("CARGO_BIN_EXE_xt28"))
        .args(["run", &path(&folder, "s.toml"), "--out", out.to_str().unwrap()])
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    assert_eq!(child.wait().unwrap().code(), Some(1));
    assert!(out.join("s.json").is_file() && out.join("s.svg").is_file());
}

#[cfg(target_os = "linux")]
fn full() -> Stdio {
    fs::OpenOptions::new().write(true).open("/dev/full").unwrap().into()
}

/// The exit status of a command whose talk goes to `talk`, which nobody reads.
#[cfg(target_os = "linux")]
fn unheard(arguments: &[&str], data: Stdio, talk: Stdio) -> Option<i32> {
    let mut command = Command::new(env!("CARGO_BIN_EXE_xt28"));
    let mut child = command.args(arguments).stdout(data).stderr(talk).spawn().unwrap();
    drop(child.stderr.take());
    child.wait().unwrap().code()
}

#[cfg(target_os = "linux")]
#[test]
fn talk_that_cannot_be_written_takes_neither_files_nor_verdict_with_it() {
    for talk in [full, Stdio::piped] {
        let folder = folder_with(&[("s.toml", SCENARIO)]);
        let [scenario, out, drive] = ["s.toml", "out", "d.toml"].map(|name| path(&folder, name));
        let run = ["run", &scenario, "--out", &out];
        assert_eq!(unheard(&run, Stdio::null(), talk()), Some(0));
        let drive = ["gap", "drive", "straight", "--out", &drive];
        assert_eq!(unheard(&drive, Stdio::null(), talk()), Some(0));
        for name in ["out/s.log", "out/s.svg", "out/s.json", "d.toml", "d.script.toml"] {
            assert!(folder.path().join(name).is_file(), "{name}");
        }
        assert_eq!(unheard(&["run", "no/such.toml"], Stdio::null(), talk()), Some(2));
        // Data without room ends a program, with a word on it.
        assert_eq!(unheard(&["config", "show"], full(), talk()), Some(2));
    }
}

/// The headers of the sections that `xt28 config show` prints of a machine file, in order.
fn sections(machine: &Path) -> (Vec<String>, String) {
    let output = xt28(&["config", "show", "--machine", machine.to_str().unwrap()]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).unwrap();
    let headers = text.lines().filter(|line| line.starts_with('['));
    (headers.map(|line| line[..=line.find(']').unwrap()].to_owned()).collect(), text)
}

#[test]
fn every_section_in_force_is_shown_once_and_what_is_shown_is_a_machine_file() {
    let whole = String::from_utf8(xt28(&["config", "show"]).stdout).unwrap();
    let (vehicle, levelling) =
        (whole.find("[vehicle]").unwrap(), whole.find("[levelling]").unwrap());
    assert!(vehicle < levelling);
    for text in [
        whole.clone(),
        whole[..levelling].to_owned(),
        whole[..vehicle].to_owned(),
        whole[..vehicle].to_owned() + &whole[levelling..],
    ] {
        let folder = folder_with(&[("m.toml", &text)]);
        let (mut headers, shown) = sections(&folder.path().join("m.toml"));
        headers.sort();
        let of = |name: &str| headers.iter().filter(|header| *header == name).count();
        assert_eq!((of("[masses]"), of("[vehicle]"), of("[levelling]")), (1, 1, 1), "{headers:?}");
        fs::write(folder.path().join("shown.toml"), shown).unwrap();
        sections(&folder.path().join("shown.toml"));
    }
}

#[test]
fn a_drive_is_not_written_over_a_file_in_another_encoding() {
    let folder = folder_with(&[]);
    let latin = b"# f\xFCr mich\n";
    fs::write(folder.path().join("straight.toml"), latin).unwrap();
    fs::write(folder.path().join("mine.script.toml"), latin).unwrap();
    let output = Command::new(env!("CARGO_BIN_EXE_xt28"))
        .args(["gap", "drive", "straight"])
        .current_dir(folder.path())
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(2));
    refusal(&["gap", "drive", "straight", "--out", &path(&folder, "mine.toml")]);
    for name in ["straight.toml", "mine.script.toml"] {
        assert_eq!(fs::read(folder.path().join(name)).unwrap(), latin);
    }
    // Nor is half a drive left where the other half cannot be written.
    fs::create_dir(folder.path().join("taken.toml")).unwrap();
    refusal(&["gap", "drive", "straight", "--out", &path(&folder, "taken.toml")]);
    assert!(!folder.path().join("taken.script.toml").exists());
}

/// A log and a database are read long after the outputs were looked at.
#[test]
fn no_toml_file_of_somebody_is_replaced_by_an_overlay_or_a_drive() {
    let folder = folder_with(&[("s.toml", SCENARIO), ("a.log", OLD), ("a.dbc", "")]);
    let [mine, drive, log, dbc] =
        ["s.toml", "d.toml", "a.log", "a.dbc"].map(|name| path(&folder, name));
    let diagnose = |option, file| refusal(&["gap", "diagnose", &log, "--dbc", &dbc, option, file]);
    let other = "it is there already and is no test drive as it was written";
    let talk = diagnose("--overlay", &mine);
    assert!(talk.contains("is no overlay of effects to be replaced; give --overlay"), "{talk}");
    let talk = refusal(&["gap", "drive", "straight", "--out", &mine]);
    assert!(talk.contains(&format!("{mine}: {other}; give --out another")), "{talk}");
    let talk = diagnose("--next", &mine);
    assert!(talk.contains(&format!("{mine}: {other}; give --next another")), "{talk}");
    assert_eq!(fs::read_to_string(&mine).unwrap(), SCENARIO);
    // A drive as it was written gives way to any other.
    assert!(xt28(&["gap", "drive", "straight", "--out", &drive]).status.success());
    assert!(!diagnose("--next", &drive).contains(other));
    for name in ["mixed", "straight"] {
        assert!(xt28(&["gap", "drive", name, "--out", &drive]).status.success());
    }
    for name in ["d.toml", "d.script.toml"] {
        let written = fs::read_to_string(path(&folder, name)).unwrap();
        let edited = format!("{written}# mine\n");
        fs::write(path(&folder, name), &edited).unwrap();
        let talk = refusal(&["gap", "drive", "straight", "--out", &drive]);
        assert!(talk.contains(&format!("{name}: {other}; give --out another")), "{talk}");
        let talk = diagnose("--next", &drive);
        assert!(talk.contains(&format!("{name}: {other}; give --next another")), "{talk}");
        assert_eq!(fs::read_to_string(path(&folder, name)).unwrap(), edited);
        fs::write(path(&folder, name), written).unwrap();
    }
    assert!(xt28(&["gap", "drive", "straight", "--out", &drive]).status.success());
}

#[test]
fn a_setting_that_is_given_twice_or_is_no_number_is_refused() {
    let talk = refusal(&["effects", "arm-delay", "delay_s=0.1", "delay_s=0.2"]);
    assert!(talk.contains("delay_s is given twice"), "{talk}");
    let talk = refusal(&["effects", "arm-delay", "delay_s=nan"]);
    assert!(talk.contains("`nan` is no number"), "{talk}");
}
