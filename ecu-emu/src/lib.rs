//! The emulator: the two ECUs on their bus, their pins wired to the plant's sensors and valves.
//!
//! The only place where ECUs and plant meet. The ECUs know volts and milliamperes, the plant knows
//! metres and newtons; `wiring` is the harness between them.
#![forbid(unsafe_code)]

mod acquisition;
mod cab;
mod ecu_effects;
mod ecus;
mod emulator;
mod engine;
mod inbox;
mod mishaps;
mod operator;
mod power;
mod receiver;
mod sensor_faults;
mod truth;
mod unheard;
mod wires;
mod wiring;

pub use cab::Cab;
pub use emulator::{Emulator, EmulatorConfig, TICK};
pub use mishaps::{Mishaps, MishapsError};
pub use operator::{Operator, OperatorError};
pub use power::{EcuName, PowerEvent, PowerKind};
pub use sensor_faults::{FaultKind, Sensor, SensorFault, WheelName};
pub use truth::{TRUTH_HEADER, write_truth_row};
pub use unheard::UnheardEffect;
pub use wires::{UnknownWire, Wire};
pub use xt28_ecus::Profile;
pub use xt28_ecus::firmware_2016::Quirks;
