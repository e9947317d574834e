//! Policy actions to CAN frames and back, under the safety kernel.
#![forbid(unsafe_code)]

mod action;
mod observation;
pub mod policy;
mod pose;

pub use action::{Action, ActionMap};
pub use observation::{Located, Observation};
pub use policy::{Outcome, Pace, Policy};
pub use pose::{Attitude, Pose};
