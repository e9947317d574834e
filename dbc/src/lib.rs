//! Frames and typed messages of the Xt28 bus, with end-to-end protection.
#![forbid(unsafe_code)]

mod frame;

pub use frame::{CanId, Frame, Outbox};
