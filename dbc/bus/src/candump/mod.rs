//! The text log of can-utils (`candump -L`), written and read.
//!
//! ```text
//! (1758440579.175206) can0 0CFF4027#5555555555551299
//! ```
//!
//! Time in brackets, interface, identifier, `#`, data. Three hexadecimal digits are an 11-bit
//! identifier, eight a 29-bit one. After the data some writers say who sent it: ` T` this host,
//! ` R` another node (candump `-x`, python-can).
//!
//! Recognised, counted and passed over: remote frames
//! (`123#R`), error frames (bit 29 of an eight-digit identifier), CAN FD (`123##1..`), and what
//! candump `-d` says of frames that it dropped. Anything else is an error that names the line.

mod line;
mod reader;
mod writer;

use std::sync::Arc;

use xt28_dbc::Frame;
use xt28_machine::SimTime;

pub use line::BadLine;
pub use reader::{ReadError, Reader, Skipped};
pub use writer::{Precision, Writer};

/// One line of a log.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Record {
    /// The time in brackets: since the start of the run, or since 1970 if the log says so.
    pub at: SimTime,
    /// The interface, such as `can0`.
    pub interface: Arc<str>,
    /// The frame.
    pub frame: Frame,
    /// Who sent it, where the log says so.
    pub direction: Option<Direction>,
}

/// Who sent a frame, as seen by the host that wrote the log.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// ` R`: another node.
    Received,
    /// ` T`: the host itself.
    Transmitted,
}
