//! What may be true of the readings and not of the machine.

pub(super) mod gnss_latency;
pub(super) mod gnss_lever_arm;
pub(super) mod imu_offset;
pub(super) mod pressure_bias;
pub(super) mod pressure_scale;
pub(super) mod stroke_bias;
pub(super) mod stroke_scale;
pub(super) mod wheel_speed_scale;

pub use gnss_latency::GnssLatency;
pub use gnss_lever_arm::GnssLeverArm;
pub use imu_offset::ImuOffset;
pub use pressure_bias::PressureBias;
pub use pressure_scale::PressureScale;
pub use stroke_bias::StrokeBias;
pub use stroke_scale::StrokeScale;
pub use wheel_speed_scale::WheelSpeedScale;

/// What is true of the sensors of which the machine has one.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SensorEffects {
    /// Of the inertial unit.
    pub imu_offset: ImuOffset,
    /// Of the receiver.
    pub gnss_latency: GnssLatency,
    /// Of the antenna.
    pub gnss_lever_arm: GnssLeverArm,
}
