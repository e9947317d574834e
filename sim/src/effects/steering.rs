//! What may be true of the articulation joints and of the ECU that turns them.

pub(super) mod rear_follower_lag;
pub(super) mod steer_backlash;
pub(super) mod steer_delay;
pub(super) mod steer_gain;
pub(super) mod steer_lag;
pub(super) mod steer_rate;

pub use rear_follower_lag::RearFollowerLag;
pub use steer_backlash::SteerBacklash;
pub use steer_delay::SteerDelay;
pub use steer_gain::SteerGain;
pub use steer_lag::SteerLag;
pub use steer_rate::SteerRate;

/// What is true of the steering.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SteeringEffects {
    /// Command to spool.
    pub delay: SteerDelay,
    /// Command to spool.
    pub lag: SteerLag,
    /// Oil to joint.
    pub backlash: SteerBacklash,
    /// Spool to joint rate.
    pub rate: SteerRate,
    /// In the ECU.
    pub gain: SteerGain,
    /// In the ECU.
    pub rear_follower: RearFollowerLag,
}
