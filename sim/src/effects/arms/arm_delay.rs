//! `arm-delay`: transport delay between the valve command and the spool.

use crate::effects::{Block, Effect, Parameter, Slot};

/// The delay of one arm's valve.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ArmDelay {
    /// Command to spool, s.
    pub delay_s: f64,
}

/// Bus, task and pilot stage add up before a spool moves.
pub(in crate::effects) const EFFECT: Effect = Effect {
    name: "arm-delay",
    block: Block::Arms,
    meaning: "transport delay from the valve command to the spool",
    source: "assumed: one task period nominal; pilot stages of mobile valves take 20 to 100 ms",
    parameters: &[Parameter {
        name: "delay_s",
        neutral: 0.0,
        tolerance: 0.02,
        range: [0.0, 1.0],
        acts_alone: true,
        slot: Slot::PerWheel(|effects, wheel| &mut effects.arms[wheel].delay.delay_s),
    }],
};
