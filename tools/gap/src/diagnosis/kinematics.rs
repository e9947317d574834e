//! How wheels move with their arms and frames at one instant: what of rolling no effect and no knob changes.

use xt28_machine::{ArmPose, PerWheel};

/// One instant of a run. It needs of a machine only where its axles and joints are and how its arms are built.
#[derive(Clone, Debug)]
pub(super) struct Kinematics {
    /// Where each arm is.
    pub(super) pose: PerWheel<ArmPose>,
    /// Rate at which each wheel turns forward with its arm, rad/s.
    pub(super) turns_rad_s: PerWheel<f64>,
    /// Speed at which each arm carries its wheel ahead of its frame, m/s.
    pub(super) carried_m_s: PerWheel<f64>,
    /// Speed at which each wheel's frame goes ahead there while the front axle stands, m/s.
    pub(super) standing_m_s: PerWheel<f64>,
    /// What that gains for each metre a second of the front axle.
    pub(super) by_ahead: PerWheel<f64>,
}
