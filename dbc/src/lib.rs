//! Frames and typed messages of the Xt28 bus, with end-to-end protection.
//!
//! [`messages`] is generated from `xt28.dbc` when this crate is built; [`database`] is the same
//! file read at run time.
#![forbid(unsafe_code)]

mod codec;
pub mod e2e;
mod frame;
pub mod messages;

pub use codec::{DecodeError, EncodeError};
pub use frame::{CanId, Frame, Outbox};
pub use xt28_dbc_model as model;

/// The text of our own database.
pub const XT28_DBC: &str = include_str!("../xt28.dbc");

/// Our own database, for decoding by name.
///
/// # Panics
/// Never: the same text was read when this crate was built.
#[must_use]
pub fn database() -> model::Database {
    model::Database::parse(XT28_DBC, "xt28.dbc").expect("checked when built")
}
