//! The safety kernel: allow, clamp or block what a policy asks for. No allocation, no clock, no I/O.
//!
//! [`step`] is a pure function of limits, state, input and time, total over every bit pattern: what
//! it lets through is finite and inside [`Limits`], and while it isn't armed nothing gets through.
//! Numbers are plain SI floats and time is integer nanoseconds, so the crate stands alone.
//!
//! A life: disarmed (silence) → an arm order with all streams alive → handshake (neutral frames go
//! out, both ECUs must accept them in step) → armed → blocked on the first hazard, until re-armed.
#![no_std]
#![forbid(unsafe_code)]

mod command;
mod hazard;
mod input;
mod limit;
mod limits;
mod state;
mod steady;
mod step;
mod verdict;

pub use command::{Arms, Command, WHEELS};
pub use input::{Input, Link, Measured, Order, Stamps};
pub use limits::{Deadline, Limits};
pub use state::{Phase, State};
pub use step::step;
pub use verdict::{Clamps, Reason, Stream, Verdict};
