//! A second of a field log with its database, for tests to damage.
#![allow(dead_code, unreachable_pub)] // each test uses a part

use std::path::Path;

use xt28_gap::{Decoder, FieldLog, GapError, Mapping};

pub const DBC: &str = include_str!("../field.dbc");

/// The message `PosFront` in [`DBC`].
pub const POS_FRONT: &str = "BO_ 2566787110 PosFront: 4 SMS
 SG_ FR : 0|16@1+ (1,0) [0|0] \"mm\" gateway
 SG_ FL : 16|16@1+ (1,0) [0|0] \"mm\" gateway
";

pub fn decoder() -> Decoder {
    decode(DBC).unwrap()
}

/// A decoder for another database, with the built-in names.
pub fn decode(dbc: &str) -> Result<Decoder, GapError> {
    Decoder::parse(dbc, Path::new("field.dbc"), &Mapping::default())
}

/// What is said of another database.
pub fn refused(dbc: &str) -> String {
    assert_ne!(dbc, DBC);
    let error = decode(dbc).unwrap_err().to_string();
    assert_eq!(error.lines().count(), 1, "{error}");
    error
}

/// One period of every message a replay needs: microseconds and frame.
pub const PERIOD: [(u32, &str); 9] = [
    (0, "0CFF4027#5555555555551299"),
    (130, "0CFF4127#00000000780201A6"),
    (260, "18FE1025#2800280028002900"),
    (390, "18FE1026#2A002B00"),
    (520, "18FE2020#F505F5050C030C03"),
    (650, "18FE202A#2C0F2C0F"),
    (780, "18FE202B#28000000FAFF0A00"),
    (910, "18FE1012#00000000640038FF"),
    (1040, "0CFF5229#FE0310C0FF020080"),
];

/// Microseconds and frames of a second.
pub fn frames() -> Vec<(u32, &'static str)> {
    (0..100).flat_map(|tick| PERIOD.map(|(us, frame)| (tick * 10_000 + us, frame))).collect()
}

pub fn line(us: u32, interface: &str, frame: &str) -> String {
    format!("({}.{:06}) {interface} {frame}\n", 10 + us / 1_000_000, us % 1_000_000)
}

pub fn log() -> String {
    frames().into_iter().map(|(us, frame)| line(us, "can0", frame)).collect()
}

pub fn read(text: &str) -> Result<FieldLog, GapError> {
    FieldLog::read(text.as_bytes(), "a.log", &decoder(), false)
}
