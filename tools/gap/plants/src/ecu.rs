//! The two ECUs of the foreign machine, from the published laws alone: frames' numbers in and out.
//!
//! Written for these plants only. Nothing of the emulated ECUs is used, so that a mistake in a law
//! is not made twice.

pub(crate) mod arm;
mod attitude;
mod channels;
pub(crate) mod drive;
mod position;
mod steering;

pub(crate) use attitude::Inertial;

/// Period of both ECUs' task, s.
pub(crate) const TICK_S: f64 = 0.01;
