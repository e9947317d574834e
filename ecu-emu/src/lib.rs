//! The emulator: the two ECUs on their bus, their pins wired to the plant's sensors and valves.
//!
//! The only place where ECUs and plant meet. The ECUs know volts and milliamperes, the plant knows
//! metres and newtons; `wiring` is the harness between them.
#![forbid(unsafe_code)]

mod cab;
mod ecu_effects;
mod ecus;
mod emulator;
mod engine;
mod inbox;
mod operator;
mod receiver;
mod truth;
mod wires;
mod wiring;

pub use cab::Cab;
pub use emulator::{Emulator, EmulatorConfig, TICK};
pub use operator::{Operator, OperatorError};
pub use truth::{TRUTH_HEADER, write_truth_row};
pub use wires::Wire;
pub use xt28_ecus::Profile;
pub use xt28_ecus::firmware_2016::Quirks;
