//! `command-jitter`: frames reach the ECU late, each by its own time.

use crate::effects::{Block, Effect, Parameter, Slot};

/// How late frames come; who wires the bus draws it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CommandJitter {
    /// Latest, s; each frame is late by a share of it, all shares alike likely, order kept.
    pub latest_s: f64,
}

/// A sender that shares its processor, or a gateway between two buses.
pub(in crate::effects) const EFFECT: Effect = Effect {
    name: "command-jitter",
    block: Block::Bus,
    meaning: "frames reach the ECU late, each by its own time",
    source: "assumed: a sender without a real-time kernel is late by milliseconds",
    parameters: &[Parameter {
        name: "latest_s",
        neutral: 0.0,
        tolerance: 0.003,
        range: [0.0, 1.0],
        acts_alone: true,
        slot: Slot::Whole(|effects| &mut effects.bus.command_jitter.latest_s),
    }],
};
