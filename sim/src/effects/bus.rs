//! What may be true of the way from the bus to the ECUs.

pub(super) mod command_jitter;
pub(super) mod frame_loss;

pub use command_jitter::CommandJitter;
pub use frame_loss::FrameLoss;

/// What is true of the bus.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BusEffects {
    /// Frames that never come.
    pub frame_loss: FrameLoss,
    /// Frames that come late.
    pub command_jitter: CommandJitter,
}
