//! Closed-loop scenarios: what to run, what must hold, the runner in lockstep, and the picture.
//!
//! A [`Scenario`] is a TOML file. [`Lockstep`] runs it on a virtual bus; a recorded candump log of
//! any other run reads as the same [`Trace`]. Each [`Expectation`] is physical and is judged on
//! the trace, so it holds on a real bus too. [`Report`] and [`Picture`] show what came of it.
#![forbid(unsafe_code)]

mod builtin;
mod cab_script;
mod conditions;
mod controller;
mod decode;
mod digest;
mod driven;
mod driver;
mod error;
mod event;
pub mod expect;
mod finding;
mod frame_check;
mod ground;
mod lockstep;
mod mishap_times;
mod picture;
mod places;
mod recording;
mod report;
mod scenario;
mod series;
mod setup;
pub mod trace;
mod trouble;
mod truth;

pub use builtin::{BUILTIN, files_of};
pub use cab_script::CabScript;
pub use conditions::Conditions;
pub use controller::{Controller, Hearer, Terms};
pub use decode::Decoder;
pub use digest::sha256;
pub use driven::{Driven, SafetyStop};
pub use driver::Script;
pub use ecu_emu::Quirks;
pub use error::{ScenarioError, SetupError};
pub use event::{Event, GatewayOrder, Incident, Node};
pub use expect::{Evidence, Expectation};
pub use finding::{Bound, Finding};
pub use ground::Ground;
pub use lockstep::{INTERFACE, Lockstep, RunError, STEPS_PER_TICK, TickCost};
pub use picture::Picture;
pub use recording::Recording;
pub use report::{Cost, Report};
pub use scenario::Scenario;
pub use series::{Sample, Series};
pub use setup::Setup;
pub use trace::Trace;
pub use trouble::Trouble;
pub use truth::{Truth, TruthError};
