//! What a policy sees.

use xt28_machine::{PerWheel, SimTime};

use crate::{Action, Attitude, Pose};

/// The machine at one instant, each sensor averaged since the last observation (paper 5.3).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Observation {
    /// When it was put together.
    pub at: SimTime,
    /// When what it is about was sensed: the fix that it was put together for, or for a policy that is asked at
    /// each tick the oldest of its sensors.
    pub sensed_at: SimTime,
    /// Time since arming, s; `None` while nothing the policy says reaches the machine.
    pub since_arming_s: Option<f64>,
    /// Where the machine is; `None` before the first usable fix, and once the last one is older than the safety kernel
    /// lets an observation be.
    pub located: Option<Located>,
    /// Roll and pitch of the front frame.
    pub attitude: Attitude,
    /// Strokes, m.
    pub stroke_m: PerWheel<f64>,
    /// Cylinder loads, N, weight > 0.
    pub load_n: PerWheel<f64>,
    /// Wheel speeds, rad/s, forward > 0.
    pub wheel_speed_rad_s: PerWheel<f64>,
    /// Ground speed by the mean of the wheels, m/s, forward > 0.
    pub wheel_speed_m_s: f64,
    /// Front joint, rad, left > 0.
    pub front_joint_rad: f64,
    /// Rear joint, rad, left > 0.
    pub rear_joint_rad: f64,
    /// What the policy asked for last, mapped to -1..1 whatever its form was.
    pub previous_action: Action,
}

/// What a GNSS fix says of the machine.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Located {
    /// When its last byte came in.
    pub at: SimTime,
    /// Pose of the front axle.
    pub pose: Pose,
    /// Velocity of the antenna east, north and up, m/s.
    pub velocity_m_s: [f64; 3],
}
