//! `frame-loss`: some frames never reach the ECU.

use crate::effects::{Block, Effect, Parameter, Slot};

/// How many frames are lost on the way to the ECUs; who wires the bus draws them.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FrameLoss {
    /// Share of frames lost, each by itself.
    pub share: f64,
}

/// A worn connector, or an ECU whose mailbox is overwritten before its task reads it.
pub(in crate::effects) const EFFECT: Effect = Effect {
    name: "frame-loss",
    block: Block::Bus,
    meaning: "some frames never reach the ECU",
    source: "assumed: a sound bus loses none; a thousandth would be noticed",
    parameters: &[Parameter {
        name: "share",
        neutral: 0.0,
        tolerance: 0.001,
        range: [0.0, 0.9],
        acts_alone: true,
        slot: Slot::Whole(|effects| &mut effects.bus.frame_loss.share),
    }],
};
