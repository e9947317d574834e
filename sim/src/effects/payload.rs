//! What may be true of the machine's masses.

pub(super) mod com_shift;
pub(super) mod load;

pub use com_shift::ComShift;
pub use load::Payload;

/// What is true of the machine's masses.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MassEffects {
    /// In the bunk.
    pub payload: Payload,
    /// Of the front frame.
    pub com_shift: ComShift,
}
