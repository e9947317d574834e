//! What every room may know of the machine: its numbers, its wheels, its arm linkage, and time.
//!
//! This crate sits at the bottom of the house. It knows neither frames nor physics engines.
#![forbid(unsafe_code)]

mod levelling;
mod linkage;
mod numbers;
mod range;
mod time;
mod wheel;

pub use levelling::Levelling;
pub use linkage::{ArmPose, Linkage};
pub use numbers::{
    Arms, Articulation, Drive, Frames, Hydraulics, Machine, MachineError, Masses, Pointing,
    Sensors, TyreModel, Vehicle, Wheels,
};
pub use time::SimTime;
pub use wheel::{Axle, PerWheel, Side, Wheel};

/// Standard gravity, m/s².
pub const GRAVITY_M_S2: f64 = 9.81;
