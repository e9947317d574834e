//! What is on an ECU's pins, both ways: SI to signal for the harness, signal to SI for the ECU.
//!
//! Sensor outputs are clamped to 300..4700 mV, inside the window of the input diagnosis (200..4800
//! mV, facts 3.2): a sensor that saturates is not a broken wire. (The firmware of 2016 wants 450 mV of the
//! strokes FR and FL: there a rod some 6 mm below its stop is one.) A voltage or current that is not a
//! number reads as the lower end of its range, so nothing behind the pins ever sees NaN.

mod calibration;
mod hydraulic;
mod imu;
mod sensor;

pub use calibration::Calibration;
pub use hydraulic::{
    motor_displacement, motor_ma, pump_displacement, pump_ma, steer_ma, steer_opening, valve_ma,
    valve_opening,
};
pub use imu::imu_frames;
pub(crate) use imu::{ImuReading, read_imu};
pub use sensor::{
    joint_front_mv, joint_front_rad, joint_rear_mv, joint_rear_rad, pressure_mv, pressure_pa,
    pump_mv, pump_pa, stroke_m, stroke_mv, wheel_hz, wheel_rad_s,
};
