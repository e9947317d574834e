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

/// A plant that can be led along what was measured of a machine, and goes on from there by itself.
pub trait Track: Plant {
    /// Puts the machine where `measured` has it, and lets what no sensor shows go on by a step under
    /// `actuation`: delays, lags, spools, play, seals. The oil and the drive's integral are made to
    /// explain what is measured; [`crate::Vehicle::from_measured`] says how.
    fn track(&mut self, measured: &VehicleState, actuation: &Actuation);

    /// Puts the machine where `measured` has it, as [`Self::track`] does, at the end of a step rather
    /// than through one: nothing goes on.
    fn place(&mut self, measured: &VehicleState, actuation: &Actuation);

    /// Makes the blocks of `held` put out what was measured, whatever is asked of them, until the
    /// next step: their oil is where `measured` needs it.
    fn hold(&mut self, measured: &VehicleState, actuation: &Actuation, held: Held);

    /// The same plant once more; stepped alike, it goes on bit for bit like this one.
    fn snapshot(&self) -> Box<dyn Track + Send>;
}

/// Blocks whose output is taken from a measurement.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Held {
    /// Strokes, by the oil of the cylinders.
    pub arms: bool,
    /// Joint angles, by the oil of the joints.
    pub joints: bool,
    /// Mean wheel speed, by the torque of the motors.
    pub drive: bool,
}

impl Held {
    /// Every block.
    pub const ALL: Self = Self { arms: true, joints: true, drive: true };
}
