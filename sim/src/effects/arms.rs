//! What may be true of the arms' hydraulics.

pub(super) mod arm_delay;

pub use arm_delay::ArmDelay;

/// What is true of one arm's hydraulics.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ArmEffects {
    /// Command to spool.
    pub delay: ArmDelay,
}
