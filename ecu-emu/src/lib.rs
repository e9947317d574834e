//! The emulator: the two ECUs on their bus, their pins wired to the plant's sensors and valves.
//!
//! The only place where ECUs and plant meet. The ECUs know volts and milliamperes, the plant knows
//! metres and newtons; `wiring` is the harness between them.
#![forbid(unsafe_code)]

mod ecu_effects;
mod emulator;
mod engine;
mod inbox;
mod receiver;
mod truth;
mod wiring;

pub use emulator::{Emulator, EmulatorConfig, TICK};
pub use truth::{TRUTH_HEADER, write_truth_row};
