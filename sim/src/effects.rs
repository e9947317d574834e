//! What the nominal machine leaves out: every effect's parameters, neutral unless set.
//!
//! One file an effect: what it is, where it acts, its parameters with unit, tolerance and range, its
//! law and a source. Blocks read [`Effects`] when they are built; an effect at its neutral values
//! changes no bit of what the plant does. [`CATALOGUE`] lists them all, so that an overlay file, a
//! trainer and a diagnoser reach every parameter by name.

mod arm_delay;
mod catalogue;
mod delay_line;
mod effect;
mod overlay;
mod scope;
mod values;

pub use arm_delay::ArmDelay;
pub use catalogue::{CATALOGUE, find};
pub use delay_line::DelayLine;
pub use effect::{Block, Effect, Parameter, Slot};
pub use overlay::{Entry, Overlay, OverlayError};
pub use scope::{Scope, UnknownScope};
pub use values::{ArmEffects, Effects};
