//! CAN buses behind one trait: virtual and SocketCAN, with a candump recorder.
//!
//! | Module | What |
//! |---|---|
//! | [`Bus`] | one node's view of a bus: send, receive with timestamps, error state |
//! | [`VirtualBus`] | a bit-timed bus in lockstep: stuffing, arbitration, load |
//! | [`socket_can`] | a bus of the Linux kernel: `vcan0`, `can0` |
//! | [`candump`] | the text log of can-utils, written and read |
//! | [`Recorder`] | any bus, with all that passes written to a log |
//! | [`embedded`] | the `embedded-can` traits, both ways |
//!
//! Nothing here reads a clock: time is an argument ([`xt28_machine::SimTime`]). A fault of the
//! bus is data ([`BusState`], counters); an `Err` is a fault of the host.
#![forbid(unsafe_code)]

mod bus;
pub mod candump;
pub mod embedded;
mod recorder;
pub mod socket_can;
pub mod virtual_bus;

pub use bus::{Bus, BusState, Received};
pub use recorder::{RecordError, Recorder};
pub use socket_can::SocketCan;
pub use virtual_bus::{Bitrate, NodeId, Port, VirtualBus};
