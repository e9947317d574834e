//! The blocks of the plant: pure steps that can be driven alone on measured inputs.

mod accumulator;
mod arm;
mod curve;
mod cylinder;
mod drive;
mod flow_sharing;
mod lock;
mod slip_trim;
mod steering;
mod tyre;
mod valve;

pub use accumulator::{Accumulator, Pressed};
pub use arm::{Arm, ArmInput, ArmState};
pub use cylinder::{Cylinder, CylinderForce, CylinderMotion, CylinderState};
pub use drive::{Drive, DriveInput, DriveOutput, DriveState};
pub use flow_sharing::FlowSharing;
pub use lock::Lock;
pub use slip_trim::slip_trim_nm;
pub use steering::{Steering, SteeringInput, SteeringState};
pub use tyre::{PATCHES_MAX, PatchInput, PatchState, Patches, Tyre};
pub use valve::{Valve, ValveState};
