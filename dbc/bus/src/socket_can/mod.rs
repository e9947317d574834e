//! A CAN interface of the Linux kernel: `vcan0`, `can0`.
//!
//! # Bus-off and restart
//!
//! The kernel's driver owns the controller. When it goes bus-off, [`SocketCan`] decodes the error
//! frame, [`crate::Bus::state`] says [`crate::BusState::BusOff`], and everything not yet handed
//! to the kernel, or sent until it is back, is thrown away and counted: a command from before the fault must not move a
//! machine after it. Restarting is a matter of configuration, not of this crate (it takes the
//! right to administer the network):
//!
//! ```text
//! ip link set can0 type can restart-ms 100   # by itself, 100 ms after bus-off
//! ip link set can0 type can restart          # once, by hand, where restart-ms is 0
//! ```
//!
//! After a restart the driver reports it and the state is error active again. Frames the kernel
//! itself had queued may then still leave.
//!
//! # Time
//!
//! Received frames carry the kernel's time stamp (`SO_TIMESTAMPNS`), a wall-clock time: right
//! for a log, but it steps when the clock is set. For deadlines use the time at which the frame
//! was taken, which the caller knows.
//!
//! On other systems the type exists, so that programs build, and [`SocketCan::open`] says no.

mod error;
#[cfg(target_os = "linux")]
mod error_frame;
#[cfg(target_os = "linux")]
mod linux;
#[cfg(target_os = "linux")]
mod open;
#[cfg(not(target_os = "linux"))]
mod unsupported;

pub use error::{OpenError, OpenReason, SocketError};
#[cfg(target_os = "linux")]
pub use linux::SocketCan;
#[cfg(not(target_os = "linux"))]
pub use unsupported::SocketCan;

/// Frames that wait in [`SocketCan`] for a full transmit queue of the kernel; beyond it sending
/// is an error. At 50 frames a tick of 10 ms, 50 ms.
pub const BACKLOG_FRAMES: usize = 256;

/// What a socket counts since it was opened. Nothing is lost without a count.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SocketCounters {
    /// Frames handed to the kernel.
    pub sent: u64,
    /// Data frames received.
    pub received: u64,
    /// Times the kernel's transmit queue was full (`ENOBUFS`, `EAGAIN`) and a frame had to wait.
    pub queue_full: u64,
    /// Frames refused because [`BACKLOG_FRAMES`] waited already.
    pub refused: u64,
    /// Frames thrown away because the controller was bus-off, or by who sent them ([`SocketCan::discard_backlog`]).
    pub discarded: u64,
    /// Remote frames received, and passed over.
    pub remote: u64,
    /// Error frames received, and taken into the state.
    pub error: u64,
}
