//! Policy actions to CAN frames and back, under the safety kernel.
//!
//! One path to the bus: observe → policy → safety kernel → frames. The core, [`Gateway`], is
//! sans-IO: frames and receiver bytes go in with the time they came, frames come out at ticks of
//! 10 ms. The same core runs in lockstep with the emulator and, in the binary, on the machine.
//!
//! | Module | What |
//! |---|---|
//! | [`Observation`] | sensors averaged between fixes, pose of the front axle |
//! | [`policy`] | the trait, and the policies that think here, learnt ones among them |
//! | [`Remote`] | a controller elsewhere, over rosbridge |
//! | [`Action`] | eight numbers in -1..1 and what they mean |
//! | `xt28_safety` | what may leave |
#![forbid(unsafe_code)]

mod action;
mod config;
mod epoch;
mod frames;
mod gateway;
mod heights;
mod observation;
mod peer;
pub mod policy;
mod pose;
mod remote;
mod running;
mod sensors;
mod status;
mod trust;

pub use action::{Action, ActionMap};
pub use config::GatewayConfig;
pub use epoch::{Fix, Quality};
pub use gateway::Gateway;
pub use observation::{Located, Observation};
pub use peer::{EcuReport, PeerState};
pub use policy::{Outcome, Pace, Policy};
pub use pose::{Attitude, Pose};
pub use remote::{Listen, Remote, Waited, Wanted, listen_advice};
pub use status::{Status, Stops, Tally};
pub use xt28_machine::SimTime;
pub use xt28_safety::{Order, Phase, Reason};
pub use xt28_ubx::Geodetic;
