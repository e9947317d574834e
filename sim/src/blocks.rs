//! The blocks of the plant: pure steps that can be driven alone on measured inputs.

mod cylinder;
mod drive;
mod steering;
mod valve;

pub use cylinder::{Cylinder, CylinderForce, CylinderInput, CylinderState};
pub use drive::{Drive, DriveInput, DriveOutput, DriveState};
pub use steering::{Steering, SteeringInput, SteeringState};
pub use valve::{Valve, ValveState};
