//! Logs as they come from the field: whole, cut, thinned, shuffled, with another DBC, or no logs at
//! all. Each is read or refused in one line that says where and what to do.

mod frames;

use std::io::Write as _;
use std::path::Path;

use frames::{DBC, decoder, once};
use proptest::prelude::*;
use xt28_gap::{Channel, Decoder, FaultKind, FieldLog, GapError, Mapping, Replay, Terrain};
use xt28_machine::{Machine, Wheel};
use xt28_sim::{Effects, Solver};

/// One period of every message a replay needs, at `ms`.
fn period(ms: u32) -> String {
    once(&format!("10.{ms:03}000"))
}

fn log() -> String {
    (0..100).map(|tick| period(tick * 10)).collect()
}

fn read(text: &str) -> Result<FieldLog, GapError> {
    FieldLog::read(text.as_bytes(), "a.log", &decoder(), false)
}

fn value(log: &FieldLog, channel: Channel) -> f64 {
    log.series(channel).unwrap().at(0.5).unwrap()
}

#[test]
fn a_whole_log_reads_in_si_and_has_no_fault() {
    let log = read(&log()).unwrap();
    assert_eq!(log.faults(), []);
    assert_eq!((log.frames(), log.duration_s()), (900, 0.99));
    assert!((value(&log, Channel::Stroke(Wheel::Fl)) - 0.043).abs() < 1e-12);
    assert!((value(&log, Channel::Stroke(Wheel::Bl)) - 0.041).abs() < 1e-12);
    assert!((value(&log, Channel::TargetStroke(Wheel::Mr)) - 0.170).abs() < 1e-12);
    assert_eq!(value(&log, Channel::ArmMode), 2.0);
    assert_eq!(value(&log, Channel::Enable), 1.0);
    assert_eq!(value(&log, Channel::WheelLoad(Wheel::Fr)), 38_840.0);
    assert!((value(&log, Channel::Pitch) - (-0.06_f64).to_radians()).abs() < 1e-12);
    assert!((value(&log, Channel::RearJoint) - (-2.0_f64).to_radians()).abs() < 1e-12);
    assert!((value(&log, Channel::WheelSpeed(Wheel::Fr)) + 0.2 * 0.104_719_755).abs() < 1e-9);
    assert!(log.series(Channel::East).is_none());
}

#[test]
fn gzip_is_known_by_its_content() {
    let folder = tempfile::tempdir().unwrap();
    let (plain, zipped) = (folder.path().join("a.log.gz"), folder.path().join("b.log"));
    std::fs::write(&plain, log()).unwrap();
    let file = std::fs::File::create(&zipped).unwrap();
    let mut gzip = flate2::write::GzEncoder::new(file, flate2::Compression::fast());
    gzip.write_all(log().as_bytes()).unwrap();
    gzip.finish().unwrap();
    let load = |path: &Path| FieldLog::load(path, &decoder(), false).unwrap();
    assert_eq!(load(&plain).all_series(), load(&zipped).all_series());
}

#[test]
fn a_missing_log_is_said_to_be_missing() {
    let error = FieldLog::load(Path::new("no/such.log"), &decoder(), false).unwrap_err();
    assert!(error.to_string().starts_with("no/such.log: cannot read"), "{error}");
}

#[test]
fn a_cut_tail_is_an_error_with_its_line_unless_accepted() {
    let text = log();
    let cut = &text[..text.len() - 5];
    let error = read(cut).unwrap_err().to_string();
    assert!(error.starts_with("a.log:900: log is cut in the middle"), "{error}");
    let log = FieldLog::read(cut.as_bytes(), "a.log", &decoder(), true).unwrap();
    assert_eq!(log.faults()[0].kind, FaultKind::Cut);
    assert_eq!((log.faults()[0].line, log.frames()), (900, 899));
}

#[test]
fn a_log_cut_inside_its_gzip_stream_is_an_error_with_its_line_unless_accepted() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("cut.log.gz");
    let mut gzip = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::none());
    gzip.write_all(log().as_bytes()).unwrap();
    let bytes = gzip.finish().unwrap();
    std::fs::write(&path, &bytes[..bytes.len() / 2]).unwrap();
    let error = FieldLog::load(&path, &decoder(), false).unwrap_err().to_string();
    assert!(error.contains("cut.log.gz:") && error.lines().count() == 1, "{error}");
    let log = FieldLog::load(&path, &decoder(), true).unwrap();
    assert!((400..500).contains(&log.frames()), "{}", log.frames());
    assert!(log.faults().iter().any(|fault| fault.kind == FaultKind::Cut), "{:?}", log.faults());
}

#[test]
fn a_clock_that_jumps_back_is_a_fault_with_its_line() {
    let mut lines: Vec<String> = log().lines().map(str::to_owned).collect();
    for line in &mut lines[450..459] {
        *line = line.replace("(10.500000)", "(10.200000)");
    }
    let log = read(&(lines.join("\n") + "\n")).unwrap();
    let back = &log.faults()[0];
    assert_eq!(back.line, 451);
    assert!(
        matches!(back.kind, FaultKind::ClockBack { by_s, frames: 9 } if (by_s - 0.29).abs() < 1e-9),
        "{back}"
    );
    assert!(back.to_string().starts_with("a.log:451: clock jumps back by 0.290000 s"), "{back}");
}

#[test]
fn a_log_whose_first_line_is_of_another_clock_is_refused_with_the_line_after_it() {
    let late = format!("(9999999999.000000) can0 123#00\n{}", log());
    let error = read(&late).unwrap_err().to_string();
    assert!(error.starts_with("a.log:2: clock steps by -9999999989."), "{error}");
}

#[test]
fn a_leap_ahead_is_refused_before_it_is_replayed() {
    let mut lines: Vec<String> = log().lines().map(str::to_owned).collect();
    lines.insert(450, "(9999999999.000000) can0 123#00".to_owned());
    lines.truncate(451);
    let log = read(&(lines.join("\n") + "\n")).unwrap();
    let replay =
        Replay::run(&log, &Machine::xt28(), &Effects::default(), Solver::Reduced, &Terrain::Flat);
    let error = replay.unwrap_err().to_string();
    assert!(error.starts_with("a.log:451: no frames for 9999999988."), "{error}");
}

#[test]
fn of_two_jumps_back_the_larger_is_told_with_its_own_line() {
    let mut lines: Vec<String> = log().lines().map(str::to_owned).collect();
    lines[450] = lines[450].replace("(10.500000)", "(10.480000)");
    for line in &mut lines[600..] {
        *line = line.replace("(1", "(0");
    }
    let log = read(&(lines.join("\n") + "\n")).unwrap();
    let mut faults = log.faults().iter();
    let back = faults.find(|fault| matches!(fault.kind, FaultKind::ClockBack { .. })).unwrap();
    assert_eq!(back.line, 601, "{back}");
}

#[test]
fn lost_frames_are_counted_by_message() {
    let mut tick = 0;
    let kept: String = log()
        .lines()
        .filter(|line| {
            tick += usize::from(line.contains("#2800280028002900"));
            !(line.contains("18FE1025") && [20, 50, 51].contains(&tick))
        })
        .map(|line| format!("{line}\n"))
        .collect();
    let log = read(&kept).unwrap();
    assert_eq!(log.faults().len(), 1, "{:?}", log.faults());
    let FaultKind::Dropped { message, gaps, due, is_held } = &log.faults()[0].kind else {
        panic!("{:?}", log.faults());
    };
    let frames: Vec<u64> = gaps.iter().map(|gap| gap.frames).collect();
    assert_eq!(
        (message.as_str(), &frames[..], *due, *is_held),
        ("PosMidRear", &[1, 2][..], 100, true)
    );
    assert!((gaps[1].length_s() - 0.03).abs() < 1e-9);
    let told = log.faults()[0].to_string();
    assert!(told.contains("the longest 30.0 ms, from 0.48 to 0.51 s; the value"), "{told}");
}

#[test]
fn frames_of_a_message_without_a_stated_period_are_missed_too() {
    let stated = "BA_DEF_DEF_ \"GenMsgCycleTime\" 10;";
    assert!(DBC.contains(stated));
    let dbc = DBC.replace(stated, "BA_DEF_DEF_ \"GenMsgCycleTime\" 0;");
    let decoder = Decoder::parse(&dbc, Path::new("x.dbc"), &Mapping::default()).unwrap();
    let mut tick = 0;
    let kept: String = log()
        .lines()
        .filter(|line| {
            tick += usize::from(line.contains("#2800280028002900"));
            !(line.contains("18FE1025") && tick == 20)
        })
        .map(|line| format!("{line}\n"))
        .collect();
    let log = FieldLog::read(kept.as_bytes(), "a.log", &decoder, false).unwrap();
    let [fault] = log.faults() else { panic!("{:?}", log.faults()) };
    assert!(fault.to_string().contains("PosMidRear"), "{fault}");
}

#[test]
fn a_frame_of_another_length_is_left_out_and_said() {
    let text = log().replacen("18FE1026#2A002B00", "18FE1026#2A00", 3);
    let log = read(&text).unwrap();
    assert_eq!(log.series(Channel::Stroke(Wheel::Fr)).unwrap().len(), 97);
    let fault = log.faults()[0].to_string();
    assert!(fault.starts_with("a.log:4: PosFront has 2 bytes where the DBC says 4; 3"), "{fault}");
}

#[test]
fn a_dbc_without_a_needed_message_is_refused_by_name() {
    let dbc = DBC.replace(" PosFront:", " FrontPos:");
    let parse = |dbc: &str, mapping: &Mapping| Decoder::parse(dbc, Path::new("x.dbc"), mapping);
    let error = parse(&dbc, &Mapping::default()).unwrap_err().to_string();
    let wanted = "x.dbc: no message `PosFront`, which stroke.FR, stroke.FL should come from; ";
    assert!(error.starts_with(wanted), "{error}");
    let mapping = "[signals]\n\"stroke.FR\" = \"FrontPos.FR\"\n\"stroke.FL\" = \"FrontPos.FL\"\n";
    let mapping = Mapping::parse(mapping, Path::new("m.toml")).unwrap();
    assert!(parse(&dbc, &mapping).is_ok());

    let dbc = DBC.replace("SG_ Roll ", "SG_ Bank ");
    let error = parse(&dbc, &Mapping::default()).unwrap_err().to_string();
    assert!(error.contains("no signal `Roll` in message `Attitude`"), "{error}");
}

#[test]
fn a_unit_that_is_none_of_the_channel_is_refused() {
    let dbc = DBC.replace(
        "SG_ Roll : 48|16@1- (0.01,0) [0|0] \"deg\"",
        "SG_ Roll : 48|16@1- (0.01,0) [0|0] \"mm\"",
    );
    let error = Decoder::parse(&dbc, Path::new("x.dbc"), &Mapping::default()).unwrap_err();
    assert!(error.to_string().contains("`Attitude.Roll` is in `mm`"), "{error}");
}

#[test]
fn a_text_that_is_no_dbc_is_refused_with_its_line() {
    let error = Decoder::parse("BO_ what", Path::new("x.dbc"), &Mapping::default()).unwrap_err();
    assert!(error.to_string().starts_with("x.dbc:1"), "{error}");
    assert_eq!(error.to_string().lines().count(), 1, "{error}");
}

#[test]
fn a_log_that_never_says_what_is_needed_is_refused() {
    let text: String =
        log().lines().filter(|line| !line.contains("18FE202B")).map(|l| format!("{l}\n")).collect();
    let error = read(&text).unwrap_err().to_string();
    assert!(error.starts_with("a.log: no frame `Attitude` in the log"), "{error}");
    assert_eq!(
        read("").unwrap_err().to_string(),
        "a.log: is empty: no classic CAN data frame in it"
    );
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, ..ProptestConfig::default() })]

    #[test]
    fn any_bytes_are_read_or_refused_in_one_line(bytes: Vec<u8>) {
        let result = FieldLog::read(bytes.as_slice(), "a.log", &decoder(), true);
        if let Err(error) = result {
            prop_assert_eq!(error.to_string().lines().count(), 1);
        }
    }

    #[test]
    fn any_damage_to_a_log_is_read_or_refused_in_one_line(
        at in 0_usize..40_000,
        bytes in proptest::collection::vec(any::<u8>(), 0..40),
        accept in any::<bool>(),
    ) {
        let mut text = log().into_bytes();
        let at = at.min(text.len() - 1);
        let end = (at + bytes.len()).min(text.len());
        text[at..end].copy_from_slice(&bytes[..end - at]);
        match FieldLog::read(text.as_slice(), "a.log", &decoder(), accept) {
            Ok(log) => prop_assert!(log.frames() <= 900),
            Err(error) => prop_assert_eq!(error.to_string().lines().count(), 1),
        }
    }
}

#[test]
fn a_bus_that_falls_silent_is_a_fault_with_its_line() {
    let late = |tick: u32| if tick < 50 { tick * 10 } else { tick * 10 + 400 };
    let text: String = (0..60).map(late).map(period).collect();
    let log = read(&text).unwrap();
    let pause = log.faults().iter().find(|f| matches!(f.kind, FaultKind::ClockAhead { .. }));
    let pause = pause.expect("a pause is seen");
    assert_eq!(pause.line, 50 * 9 + 1);
    let FaultKind::ClockAhead { by_s, times, .. } = pause.kind else { unreachable!() };
    assert!((by_s - 0.41).abs() < 1e-9 && times == 1, "{by_s} {times}");
    let words = pause.to_string();
    assert!(words.contains("cut the log there if the clock jumped"), "{words}");
}

#[test]
fn a_log_of_another_bus_says_which_identifiers_it_has() {
    let error = read("(1.0) can0 123#55\n(1.1) can0 18FF0001#55\n").unwrap_err().to_string();
    assert!(error.contains("none of its 2 frames (123, 18FF0001 and the like)"), "{error}");
}
