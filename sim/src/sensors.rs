//! What the machine's sensors make of its state.

mod gnss;
mod height_map;
mod imu;
mod past;
mod readings;

pub use gnss::{GnssFix, GnssReceiver};
pub use height_map::HeightMapReader;
pub use imu::{Imu, ImuSample};
pub use readings::{Readings, Sensors};
