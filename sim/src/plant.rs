//! What stands behind the ECUs, whoever solves it: takes actuation, shows a state.

use core::time::Duration;

use crate::{Actuation, VehicleState};

/// Time a plant advances in one step, unless it was built for another.
pub const STEP: Duration = Duration::from_millis(5);

/// Anything that can stand behind the ECUs: takes what their output stages do, shows what their
/// sensors feel.
pub trait Plant {
    /// Advances by one step (see [`STEP`]) under constant actuation.
    fn step(&mut self, actuation: &Actuation);

    /// The state after the last step.
    fn state(&self) -> &VehicleState;
}
