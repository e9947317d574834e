//! What the machine's sensors make of its state.

mod gnss;
mod imu;

pub use gnss::{GnssFix, GnssReceiver};
pub use imu::{Imu, ImuSample};
