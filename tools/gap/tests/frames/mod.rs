//! One frame of every message that a replay needs, as candump writes them, with the DBC that they are of.
#![allow(dead_code)] // each test uses a part

use std::path::Path;

use xt28_gap::{Decoder, Mapping};

/// The DBC of [`FRAMES`].
pub(crate) const DBC: &str = include_str!("../field.dbc");

/// A frame of every message, without its time.
pub(crate) const FRAMES: [&str; 9] = [
    "0CFF4027#5555555555551299",
    "0CFF4127#00000000780201A6",
    "18FE1025#2800280028002900",
    "18FE1026#2A002B00",
    "18FE2020#F505F5050C030C03",
    "18FE202A#2C0F2C0F",
    "18FE202B#28000000FAFF0A00",
    "18FE1012#00000000640038FF",
    "0CFF5229#FE0310C0FF020080",
];

pub(crate) fn decoder() -> Decoder {
    Decoder::parse(DBC, Path::new("field.dbc"), &Mapping::default()).unwrap()
}

/// Every frame once, at `at_s`, as it stands in the log: `1.000000`.
pub(crate) fn once(at_s: &str) -> String {
    FRAMES.iter().map(|frame| format!("({at_s}) can0 {frame}\n")).collect()
}
