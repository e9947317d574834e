//! `steer-delay`: transport delay between the steering command and the steering valves' spools.

use crate::effects::{Block, Effect, Parameter, Slot};

/// The delay of both steering valves.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SteerDelay {
    /// Command to spool, s.
    pub delay_s: f64,
}

/// A dead time in the loop around the joint: it overshoots and swings where the nominal one settles.
pub(in crate::effects) const EFFECT: Effect = Effect {
    name: "steer-delay",
    block: Block::Steering,
    meaning: "transport delay from the steering command to the spools",
    source: "assumed, as arm-delay: pilot stages of mobile valves take 20 to 100 ms",
    parameters: &[Parameter {
        name: "delay_s",
        neutral: 0.0,
        tolerance: 0.02,
        range: [0.0, 1.0],
        acts_alone: true,
        slot: Slot::Whole(|effects| &mut effects.steering.delay.delay_s),
    }],
};
