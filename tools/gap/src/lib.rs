//! Field logs against the simulator: a log's commands through our ECUs and plant, and how far that
//! is from what the log measured.
//!
//! | Step | Where |
//! |---|---|
//! | which signal is which channel | [`Mapping`], [`Decoder`] over the log's own DBC |
//! | the log as time series | [`FieldLog`], what is wrong with it as [`LogFault`]s |
//! | the ground it was driven on | [`About`], or any terrain of the simulator |
//! | the same commands on our machine | [`Replay`] |
//! | how far that is from the log | [`Errors`] of each signal, in a [`Report`] with the bounds |
//!
//! Nothing here knows an identifier or a layout: a log is read by the names in its own DBC.
#![forbid(unsafe_code)]

mod about;
mod channel;
mod commands;
mod comparison;
mod decoder;
pub mod diagnosis;
mod dimension;
mod ecu_watch;
mod error;
mod errors_between;
mod field_log;
mod log_fault;
mod mapping;
mod overlay;
pub mod page;
mod recorded;
mod replay;
mod report;
mod runs;
mod series;
mod toml_error;
mod voices;

pub use about::{About, Ground, Run};
pub use channel::{Channel, Need, PumpSide, SteerSide};
pub use comparison::SignalComparison;
pub use decoder::Decoder;
pub use dimension::Dimension;
pub use error::{Disagreement, GapError};
pub use errors_between::Errors;
pub use field_log::{FieldLog, Gap};
pub use log_fault::{FaultKind, LogFault};
pub use mapping::{Mapping, Source};
pub use replay::Replay;
pub use report::Report;
pub use runs::{Choice, Known, KnownRun, RunSet, Use};
pub use series::Series;
pub use voices::Voices;
pub use xt28_sim::Terrain;
