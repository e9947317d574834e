//! The two ECUs, sans-IO: frames and electrical signals in and out, time as an argument.
//!
//! [`ArmEcu`] ("SMS") controls the pendulum arms, [`DriveEcu`] ("DMS") transmission and steering.
//! Both know millivolts, hertz, milliamperes and frames only; [`pins`] has the sensors' and
//! solenoids' laws for those who wire them to something. The numbers come from the machine file,
//! the laws from the paper and the public firmware. [`firmware_2016`] has both ECUs as that firmware
//! has them.
#![forbid(unsafe_code)]

mod arm;
mod command_stream;
pub mod diagnostics;
mod drive;
pub mod firmware_2016;
mod input_check;
mod life;
pub mod pins;
mod port;
pub mod power;
mod profile;
mod refusal;
mod send;

pub use arm::{ArmEcu, ArmOutputs, ArmPins, PositionGains};
pub use drive::{DriveEcu, DriveOutputs, DrivePins, SteeringGains};
pub use life::State;
pub use port::Port;
pub use profile::{Profile, UnknownProfile};
pub use refusal::Refusal;
