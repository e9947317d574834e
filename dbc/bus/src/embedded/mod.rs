//! The `embedded-can` traits at the edge: other people's drivers as a [`crate::Bus`], and a
//! [`crate::Bus`] for other people's code.
//!
//! | From | To | |
//! |---|---|---|
//! | any [`crate::Bus`] | [`embedded_can::nb::Can`] | [`Controller`] |
//! | any [`crate::Bus`] | [`embedded_can::blocking::Can`] | [`BlockingController`] |
//! | any [`embedded_can::nb::Can`] | [`crate::Bus`] | [`Driver`] |
//!
//! These traits know neither time nor error states: both are set from outside. A driver with
//! only the blocking trait is no [`crate::Bus`], since receiving would wait.

mod controller;
mod driver;
mod frame;

pub use controller::{BlockingController, Controller, ControllerError};
pub use driver::{Driver, DriverError};
pub use frame::{CanFrame, from_embedded_id, to_embedded_id};
