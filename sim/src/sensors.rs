//! What the machine's sensors make of its state.

mod gnss;
mod imu;
mod readings;

pub use gnss::{GnssFix, GnssReceiver};
pub use imu::{Imu, ImuSample};
pub use readings::{Readings, Sensors};
