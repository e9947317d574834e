//! A reading that freezes while its part moves is said to; one that stands with its part is not.

mod own_logs;

use std::path::Path;

use own_logs::text;
use xt28_dbc::XT28_DBC;
use xt28_gap::{Decoder, FaultKind, FieldLog, LogFault, Mapping};
use xt28_sim::Effects;

/// When readings freeze, s of the log.
const FROM_S: f64 = 2.0;

/// `log` with the bits of `mask` in every frame `id` from [`FROM_S`] on as they were before.
fn frozen(log: &str, id: &str, mask: u64) -> String {
    let mut held = None;
    let freeze = |line: &str| {
        let (head, data) = line.split_once('#').unwrap();
        let at_s: f64 = head[1..].split_once(')').unwrap().0.parse().unwrap();
        if !head.ends_with(id) {
            return format!("{line}\n");
        }
        let bytes = (0..data.len()).step_by(2).map(|k| u8::from_str_radix(&data[k..k + 2], 16));
        let mut bytes: Vec<u8> = bytes.map(Result::unwrap).collect();
        let len = bytes.len();
        bytes.resize(8, 0);
        let word = u64::from_le_bytes(bytes.try_into().unwrap());
        let reading = held.filter(|_| at_s >= 1.0 + FROM_S).unwrap_or(word & mask);
        held = Some(reading);
        let word = (word & !mask | reading).to_le_bytes();
        let data: String = word[..len].iter().map(|byte| format!("{byte:02X}")).collect();
        format!("{head}#{data}\n")
    };
    log.lines().map(freeze).collect()
}

fn read(text: &str) -> FieldLog {
    let decoder = Decoder::parse(XT28_DBC, Path::new("xt28.dbc"), &Mapping::default()).unwrap();
    FieldLog::read(text.as_bytes(), "a.log", &decoder, false).unwrap()
}

#[test]
fn a_reading_that_stands_still_while_its_part_moves_is_told() {
    for (manoeuvre, id, mask, wanted, why) in [
        ("arms", "18FE1026", 0xFFFF, "stroke.FR", "its valve opened and closed by up to"),
        ("drive", "0CFF5229", 0x3FF, "wheel_speed.FR", "the other wheels' speed changed by"),
        (
            "drive",
            "18FE1012",
            0xFFFF_0000_0000,
            "joint.front",
            "its valve opened and closed by up to",
        ),
    ] {
        let sound = text(manoeuvre, &Effects::default());
        assert_eq!(read(&sound).faults(), [], "{manoeuvre}");
        let log = read(&frozen(&sound, id, mask));
        let [fault] = log.faults() else { panic!("{wanted}: {:?}", log.faults()) };
        let FaultKind::Frozen { channel, from_s, to_s, times, .. } = &fault.kind else {
            panic!("{fault}")
        };
        assert_eq!((channel.as_str(), *times), (wanted, 1));
        assert!(*from_s <= FROM_S && *to_s > 11.9, "{fault}");
        assert!(fault.to_string().contains(why), "{fault}");
    }
}

/// The first `seconds` of a log.
fn first(log: &str, seconds: f64) -> String {
    let at_s = |line: &str| line[1..].split_once(')').unwrap().0.parse::<f64>().unwrap();
    log.lines()
        .take_while(|line| at_s(line) < 1.0 + seconds)
        .map(|line| format!("{line}\n"))
        .collect()
}

/// Joints that nobody steers, wheels of a machine that stands, arms that have come to rest.
#[test]
fn a_reading_that_stands_with_its_part_is_not_told() {
    let [arms, drive] = ["arms", "drive"].map(|manoeuvre| text(manoeuvre, &Effects::default()));
    for (log, id, mask) in [
        (arms.clone(), "18FE1012", 0xFFFF_FFFF_0000_0000),
        (first(&arms, 5.0), "0CFF5229", 0x0FFF_FFFF_FFFF_FFFF),
        (drive[first(&drive, 8.0).len()..].to_owned(), "18FE1026", 0xFFFF_FFFF),
    ] {
        assert_eq!(read(&frozen(&log, id, mask)).faults().iter().find(is_frozen), None, "{id}");
    }
}

fn is_frozen(fault: &&LogFault) -> bool {
    matches!(fault.kind, FaultKind::Frozen { .. })
}
