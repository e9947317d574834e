//! Logs as loggers really write them: of several sources, a little out of order, with frames that are
//! padded, spoiled or of other kinds. What is left out is counted, and told where it is all there was.

mod field;

use field::{DBC, POS_FRONT, decode, frames, line, log, read};
use proptest::prelude::*;
use xt28_gap::{Channel, FaultKind, FieldLog, GapError};
use xt28_machine::Wheel;

/// What the frames for the front strokes are read as.
const STROKE: Channel = Channel::Stroke(Wheel::Fr);

/// Lines in order of how late each was written: frame `i` by `late_us[i]`.
fn written_late(late_us: &[u32]) -> String {
    let mut lines: Vec<(u32, String)> = frames()
        .into_iter()
        .zip(late_us.iter().cycle())
        .enumerate()
        .map(|(i, ((us, frame), late_us))| (us + late_us, line(us, ["can0", "can1"][i % 2], frame)))
        .collect();
    lines.sort_by_key(|(written_us, _)| *written_us);
    lines.into_iter().map(|(_, line)| line).collect()
}

#[test]
fn two_interfaces_a_few_microseconds_apart_lose_no_frame() {
    let log_of_two = read(&written_late(&[0, 300, 7])).unwrap();
    assert_eq!(log_of_two.faults(), []);
    assert_eq!(log_of_two.all_series(), read(&log()).unwrap().all_series());
}

#[test]
fn two_machines_on_two_interfaces_are_told_and_none_is_taken() {
    let others =
        [("18FE1025#28", "18FE1025#38"), ("18FE1026#2A", "18FE1026#3A"), ("202B#28", "202B#38")];
    let both = |differ: usize| -> String {
        let pair = |(us, frame): (u32, &'static str)| {
            let other = others[..differ].iter().fold(frame.to_owned(), |f, (a, b)| f.replace(a, b));
            line(us, "can0", frame) + &line(us + 60, "can1", &other)
        };
        frames().into_iter().map(pair).collect()
    };
    let bridged = read(&both(0)).unwrap();
    // Of the first two nothing tells yet how often the message comes.
    assert_eq!(bridged.series(STROKE).unwrap().len(), 101);
    // One of them an ECU may have copied from another tick: it is read, and told.
    let one = read(&both(1)).unwrap();
    let told: Vec<String> = one.faults().iter().map(ToString::to_string).collect();
    let says = "PosMidRear says one thing on can0 and another on can1";
    assert!(told.iter().any(|told| told.contains(says)), "{told:?}");
    let refused = read(&both(3)).unwrap_err().to_string();
    let wanted = "a.log:6: PosMidRear comes on can0 and on can1, and says different things there";
    assert!(refused.starts_with(wanted) && refused.contains("grep ' can0 '"), "{refused}");
}

/// Several seconds of the log's frames, and 5 ms behind each the same frame with each of `others` in it.
fn said_in_turn(others: &[(&str, &str)]) -> String {
    let mut lines = Vec::new();
    for (round, (us, frame)) in (0..3).flat_map(|k| frames().into_iter().map(move |f| (k, f))) {
        let us = us + round * 1_010_000;
        let other = others.iter().fold(frame.to_owned(), |f, (a, b)| f.replace(a, b));
        lines.extend([(us, frame.to_owned()), (us + 5_000, other)]);
    }
    lines.sort_by_key(|(us, _)| *us);
    lines.iter().map(|(us, frame)| line(*us, "can0", frame)).collect()
}

#[test]
fn two_senders_on_one_interface_are_told_and_three_messages_of_theirs_are_two_machines() {
    let others = [
        ("18FE1025#28", "18FE1025#38"),
        ("18FE1026#2A", "18FE1026#3A"),
        ("5229#FE03", "5229#9E03"),
    ];
    let told = |text: &str| -> Vec<String> {
        read(text).unwrap().faults().iter().map(ToString::to_string).collect()
    };
    let says = "PosMidRear says two things in turn from here on, as two senders do";
    assert!(!told(&said_in_turn(&[])).iter().any(|told| told.contains("in turn")));
    let one = told(&said_in_turn(&others[..1]));
    assert!(one.iter().any(|told| told.contains(says)), "{one:?}");
    let refused = read(&said_in_turn(&others)).unwrap_err().to_string();
    let wanted = "comes from two senders from here on, which say different things in turn";
    assert!(refused.contains(wanted) && refused.contains("record with one"), "{refused}");
}

#[test]
fn a_frame_of_nothing_but_ones_is_no_reading() {
    let mut tick = -1;
    let blank = |line: &str| {
        tick += i32::from(line.contains("18FE1026"));
        let is_blank = (20..23).contains(&tick);
        let ones = "18FE1026#FFFFFFFF";
        (if is_blank { line.replace("18FE1026#2A002B00", ones) } else { line.to_owned() }) + "\n"
    };
    let text: String = log().lines().map(blank).collect();
    let log = read(&text).unwrap();
    assert_eq!(log.series(STROKE).unwrap().len(), 97);
    let told = log.faults().iter().map(ToString::to_string).find(|told| told.contains("available"));
    let wanted = "PosFront says of all its signals that they are not available, in 3 frames";
    assert!(told.as_ref().is_some_and(|told| told.contains(wanted)), "{told:?}");
}

#[test]
fn a_source_that_is_far_behind_is_put_in_order_and_said() {
    let late = read(&written_late(&[0, 0, 0, 40_000])).unwrap();
    assert_eq!(late.all_series(), read(&log()).unwrap().all_series());
    let [fault] = late.faults() else { panic!("{:?}", late.faults()) };
    assert!(matches!(fault.kind, FaultKind::OutOfOrder { by_s, .. } if by_s > 0.03), "{fault}");
    assert!(fault.to_string().contains("are put in order"), "{fault}");
}

/// The same database with the CRC of the arms' command, which the log's frames bear.
fn protected() -> String {
    let mode = " SG_ Mode : 48|4@1+ (1,0) [0|0] \"\" SMS\n";
    let crc = format!("{mode} SG_ Crc : 56|8@1+ (1,0) [0|255] \"\" SMS\n");
    let attribute = "BA_DEF_ BO_ \"E2eDataId\" INT 0 65535;\nBA_DEF_DEF_ \"E2eDataId\" 0;\n\
                     BA_ \"E2eDataId\" BO_ 2365538343 16423;\n";
    DBC.replacen(mode, &crc, 1) + attribute
}

fn read_protected(text: &str) -> Result<FieldLog, GapError> {
    FieldLog::read(text.as_bytes(), "a.log", &decode(&protected()).unwrap(), false)
}

#[test]
fn a_command_with_a_wrong_crc_is_left_out_and_counted() {
    assert_eq!(read_protected(&log()).unwrap().faults(), []);
    // Another stroke for one wheel under the CRC of the old one, from 0.2 s on.
    let mut tick = -1;
    let spoil = |line: &str| {
        tick += i32::from(line.contains("0CFF4027"));
        let bad = (20..23).contains(&tick);
        (if bad { line.replace("4027#55", "4027#54") } else { line.to_owned() }) + "\n"
    };
    let text: String = log().lines().map(spoil).collect();
    let log = read_protected(&text).unwrap();
    let targets = log.series(Channel::TargetStroke(Wheel::Fr)).unwrap();
    assert_eq!(targets.len(), 97);
    assert!(targets.iter().all(|(_, stroke_m)| (stroke_m - 0.17).abs() < 1e-12));
    let [fault] = log.faults() else { panic!("{:?}", log.faults()) };
    assert_eq!(fault.line, 20 * 9 + 1);
    let FaultKind::BadCrc { message, at_s, frames } = &fault.kind else { panic!("{fault}") };
    assert_eq!((message.as_str(), *frames), ("ArmTarget", 3));
    assert!((at_s - 0.2).abs() < 1e-9, "{at_s}");
}

#[test]
fn a_frame_that_is_padded_is_read_and_said() {
    let padded = read(&log().replace("18FE1026#2A002B00", "18FE1026#2A002B00FFFFFFFF")).unwrap();
    assert_eq!(padded.all_series(), read(&log()).unwrap().all_series());
    let [fault] = padded.faults() else { panic!("{:?}", padded.faults()) };
    let wanted = "a.log:4: PosFront has 8 bytes where the DBC says 4; in 100 such frames the rest";
    assert!(fault.to_string().starts_with(wanted), "{fault}");
}

/// The log with a counter in the arms' command, each frame `k` again where `again_us` says how much later.
fn with_repeats(again_us: impl Fn(usize) -> Option<u32>) -> String {
    let mut lines = String::new();
    for (k, (us, frame)) in frames().into_iter().enumerate() {
        let counted = format!("4027#555555555555{:X}2", us / 10_000 % 15);
        let frame = frame.replace("4027#55555555555512", &counted);
        lines += &line(us, "can0", &frame);
        lines += &again_us(k).map_or_else(String::new, |later| line(us + later, "can0", &frame));
    }
    lines
}

/// The database with that counter.
fn counted() -> String {
    let mode = " SG_ Mode : 48|4@1+ (1,0) [0|0] \"\" SMS\n";
    DBC.replacen(mode, &format!("{mode} SG_ Counter : 52|4@1+ (1,0) [0|0] \"\" SMS\n"), 1)
}

fn read_counted(text: &str) -> FieldLog {
    FieldLog::read(text.as_bytes(), "a.log", &decode(&counted()).unwrap(), false).unwrap()
}

#[test]
fn frames_that_are_there_twice_are_left_out_once_and_told_in_one_line() {
    let sound = read_counted(&with_repeats(|_| None));
    assert_eq!(sound.faults(), []);
    // Whichever message it is, a little later; the arms' command, as its counter tells, much later too.
    for again_us in [0, 3, 300, 2_000, 7_000] {
        let is_seen = |k: usize| k.is_multiple_of(9) || again_us < 2_500;
        let repeats =
            |k: usize| (k >= 27 && k.is_multiple_of(20) && is_seen(k)).then_some(again_us);
        let log = read_counted(&with_repeats(repeats));
        assert_eq!(log.all_series(), sound.all_series(), "{again_us} us later");
        let count = |is: fn(usize) -> bool| {
            (0..900).filter(|&k| is(k) && repeats(k).is_some()).count() as u64
        };
        let of_arms = log.faults().iter().find_map(|fault| match &fault.kind {
            FaultKind::Repeated { message, frames, of } if message == "ArmTarget" => {
                Some((*frames, *of))
            }
            FaultKind::Repeated { .. } => None,
            _ => panic!("{fault}"),
        });
        let arms = count(|k| k.is_multiple_of(9));
        assert_eq!(of_arms, Some((arms, 100 + arms)), "{again_us} us later");
        let [told] = &log.told_faults()[..] else { panic!("{:?}", log.told_faults()) };
        let all = count(|_| true);
        assert!(told.contains(&format!("{all} of ")) && told.contains("twice"), "{told}");
    }
}

#[test]
fn what_a_logger_writes_two_at_a_time_is_not_there_twice() {
    let two_at_a_time = |us: u32| us / 20_000 * 20_000 + us % 10_000;
    let text: String =
        frames().iter().map(|(us, frame)| line(two_at_a_time(*us), "can0", frame)).collect();
    let log = read(&text).unwrap();
    let is_repeat = |fault: &&xt28_gap::LogFault| matches!(fault.kind, FaultKind::Repeated { .. });
    assert_eq!(log.faults().iter().find(is_repeat), None);
    assert_eq!(log.series(Channel::Roll).unwrap().len(), 100);
}

#[test]
fn frames_lost_of_many_messages_are_told_in_one_line() {
    let kept =
        frames().into_iter().enumerate().filter(|(k, _)| k % 10 != 7 || !(9..880).contains(k));
    let text: String = kept.map(|(_, (us, frame))| line(us, "can0", frame)).collect();
    let log = read(&text).unwrap();
    assert_eq!(log.faults().len(), 9);
    let [told] = &log.told_faults()[..] else { panic!("{:?}", log.told_faults()) };
    let wanted =
        "a.log:26: from here on 87 of 900 frames (9.7 %) of 9 messages are missing, the most of ";
    assert!(told.starts_with(wanted) && told.contains("the longest gap is 20.0 ms"), "{told}");
}

/// Frames of other kinds, as candump writes them: error, remote, CAN FD.
const OTHERS: [&str; 3] = ["20000004#0004000000000000", "123#R8", "18FE1026##12A002B00"];

#[test]
fn frames_of_other_kinds_are_counted() {
    let mut lines: Vec<String> = log().lines().map(str::to_owned).collect();
    for (at, i) in [(500, 0), (400, 1), (300, 2), (200, 0)] {
        lines.insert(at, line(0, "can0", OTHERS[i]).trim_end().to_owned());
    }
    let log = read(&(lines.join("\n") + "\n")).unwrap();
    let [fault] = log.faults() else { panic!("{:?}", log.faults()) };
    assert_eq!(fault.line, 201);
    assert_eq!(fault.kind, FaultKind::PassedOver { remote: 1, error: 2, fd: 1 });
}

#[test]
fn a_log_without_a_needed_message_says_what_became_of_its_frames() {
    let front = "18FE1026#2A002B00";
    let bounded = DBC.replacen(
        "SG_ FR : 0|16@1+ (1,0) [0|0] \"mm\" gateway\n SG_ FL",
        "SG_ FR : 0|16@1+ (1,0) [0|9] \"mm\" gateway\n SG_ FL",
        1,
    );
    assert!(bounded != DBC && DBC.contains(POS_FRONT));
    let refused = |dbc: &str, text: &str| {
        let decoder = decode(dbc).unwrap();
        let error = FieldLog::read(text.as_bytes(), "a.log", &decoder, false).unwrap_err();
        error.to_string()
    };
    for (dbc, text, wanted) in [
        (DBC, log().replace(front, "18FE1026#2A00"), "a.log:4: PosFront has 2 bytes where"),
        (&bounded, log(), "a.log:4: stroke.FR cannot be believed: 42 is outside 0 to 9"),
        (&protected(), log().replace("4027#55", "4027#54"), "a.log:1: ArmTarget has a wrong CRC"),
    ] {
        let error = refused(dbc, &text);
        assert!(error.starts_with(wanted) && error.contains("nothing is left of"), "{error}");
    }
    let error = refused(DBC, &log().replace(front, OTHERS[2]));
    assert!(error.starts_with("a.log: no frame `PosFront` in the log"), "{error}");
    assert!(error.ends_with("100 CAN FD frames; nothing is read from them"), "{error}");
}

#[test]
fn a_log_of_other_kinds_of_frames_only_is_empty_and_says_of_what() {
    assert_eq!(
        read("\n\n").unwrap_err().to_string(),
        "a.log: is empty: no classic CAN data frame in it"
    );
    let error = read(&line(0, "can0", OTHERS[0])).unwrap_err().to_string();
    assert!(
        error.starts_with("a.log: is empty: no classic CAN data frame in it; a.log:1: from"),
        "{error}"
    );
    assert!(error.contains("from here on 1 error frames; nothing"), "{error}");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 32, ..ProptestConfig::default() })]

    #[test]
    fn however_sources_within_the_window_are_merged_the_log_is_the_same(
        late_us in prop::collection::vec(0_u32..=100_000, 1..40),
    ) {
        let (merged, wanted) = (read(&written_late(&late_us)).unwrap(), read(&log()).unwrap());
        prop_assert_eq!(merged.all_series(), wanted.all_series());
        prop_assert_eq!(merged.duration_s(), wanted.duration_s());
        let sound = |kind: &FaultKind| matches!(kind, FaultKind::OutOfOrder { .. });
        prop_assert!(merged.faults().iter().all(|fault| sound(&fault.kind)));
    }
}
