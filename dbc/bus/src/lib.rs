//! CAN buses behind one trait: virtual and SocketCAN, with a candump recorder.
//!
//! | Module | What |
//! |---|---|
//! | [`Bus`] | one node's view of a bus: send, receive with timestamps, error state |
//! | [`VirtualBus`] | a bit-timed bus in lockstep: stuffing, arbitration, load |
//! | [`candump`] | the text log of can-utils, written and read |
//! | [`Recorder`] | any bus, with all that passes written to a log |
//!
//! Nothing here reads a clock: time is an argument ([`xt28_machine::SimTime`]). A fault of the
//! bus is data ([`BusState`], counters); an `Err` is a fault of the host.
#![forbid(unsafe_code)]

mod bus;
pub mod candump;
mod recorder;
pub mod virtual_bus;

pub use bus::{Bus, BusState, Received};
pub use recorder::{RecordError, Recorder};
pub use virtual_bus::{Bitrate, NodeId, Port, VirtualBus};
