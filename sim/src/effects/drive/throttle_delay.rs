//! `throttle-delay`: transport delay between pump displacement and the speed the circuits are asked for.

use crate::effects::{Block, Effect, Parameter, Slot};

/// The delay of both circuits.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ThrottleDelay {
    /// Displacement to speed, s.
    pub delay_s: f64,
}

/// The pumps' servo pistons start late.
pub(in crate::effects) const EFFECT: Effect = Effect {
    name: "throttle-delay",
    block: Block::Drive,
    meaning: "transport delay from throttle to wheel speed",
    source: "assumed: pilot stages of pump controls take 20 to 100 ms",
    parameters: &[Parameter {
        name: "delay_s",
        neutral: 0.0,
        tolerance: 0.03,
        range: [0.0, 1.5],
        acts_alone: true,
        slot: Slot::Whole(|effects| &mut effects.drive.throttle_delay.delay_s),
    }],
};
