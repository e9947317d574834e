//! The two ECUs as the public firmware of 2016 has them, beside the profile of the paper.
//!
//! An operator drives: armrest pads on CAN and pedals on pins, no remote commands. Whole numbers are
//! cut off where the firmware stores them, so that a log decodes to the same counts. What the firmware
//! does that its authors can hardly have meant is a switch of [`Quirks`], on by default. What differs
//! from the published facts is in one table, `docs/firmware-2016.md`.

mod arm;
mod cab;
mod drive;
mod flow;
mod input_watch;
pub mod pads;
mod quirks;
mod toggle;
mod whole;

pub use arm::ArmEcu2016;
pub use cab::CabPins;
pub use drive::DriveEcu2016;
pub use flow::flow_to_current_ma;
pub use quirks::{Quirks, UnknownQuirk};
