//! What the motors of a run turn its wheels with.

use xt28_machine::PerWheel;

/// Torques of the motors by their circuits' pressures and the trim of each wheel; none where no pressures are known.
/// They need of a machine only its circuits, what torque their pressure makes and how its wheels are built.
#[derive(Clone, Debug)]
pub(super) struct WheelTorques {
    /// As they are, Nm.
    pub(super) torque_nm: PerWheel<Vec<f64>>,
    /// As smooth as wheel speeds, less what spins each wheel up, Nm: what pushes the ground.
    pub(super) pushes_nm: PerWheel<Vec<f64>>,
    /// Which way each wheel turns, as smooth: 1 forward, -1 back, none at rest. What resists its rolling is smooth so
    /// too.
    pub(super) ways: PerWheel<Vec<f64>>,
}
