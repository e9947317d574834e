//! The values of all effects, block by block.

use xt28_machine::PerWheel;

use super::ArmDelay;

/// What is true of this plant beyond the nominal machine. The default is nothing.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Effects {
    /// Of each arm's hydraulics.
    pub arms: PerWheel<ArmEffects>,
}

/// What is true of one arm's hydraulics.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ArmEffects {
    /// Command to spool.
    pub delay: ArmDelay,
}
