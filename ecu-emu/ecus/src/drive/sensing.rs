//! The drive ECU's sensors.

use xt28_machine::PerWheel;

use super::DrivePins;
use crate::pins::{self, Calibration};

/// What the sensors say.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct DriveReadings {
    /// Front and rear joint, deg; left > 0.
    pub(crate) joint_deg: [f64; 2],
    /// Wheel speeds, rad/s; forward > 0.
    pub(crate) wheel_rad_s: PerWheel<f64>,
    /// Rolling speed of the mean wheel, m/s; forward > 0.
    pub(crate) speed_m_s: f64,
    /// Pumps 1A 1B 2A 2B, Pa.
    pub(crate) pump_pa: [f64; 4],
}

/// Readings of a tick, with wheels of `radius_m`.
pub(crate) fn read(pins: &DrivePins, sensors: &Calibration, radius_m: f64) -> DriveReadings {
    let wheel_rad_s =
        PerWheel::from_fn(|w| pins::wheel_rad_s(pins.wheel_hz[w], pins.wheel_forward[w]));
    let joint_rad =
        [sensors.joint_front_rad(pins.joint_front_mv), sensors.joint_rear_rad(pins.joint_rear_mv)];
    DriveReadings {
        joint_deg: joint_rad.map(f64::to_degrees),
        wheel_rad_s,
        speed_m_s: wheel_rad_s.mean() * radius_m,
        pump_pa: pins.pump_mv.map(pins::pump_pa),
    }
}
