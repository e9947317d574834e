//! `valve-lag`: the spool follows its command through a first-order lag.

use crate::effects::{Block, Effect, Parameter, Slot};

/// The lag of one arm's valve; its law is [`crate::effects::Lag`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ValveLag {
    /// Time constant, s.
    pub time_constant_s: f64,
}

/// The spool's own dynamics, which the nominal machine takes as immediate (paper 3.2).
pub(in crate::effects) const EFFECT: Effect = Effect {
    name: "valve-lag",
    block: Block::Arms,
    meaning: "first-order lag of the valve",
    source: "assumed: proportional mobile valves reach 90 % within 0.1 to 0.3 s",
    parameters: &[Parameter {
        name: "time_constant_s",
        neutral: 0.0,
        tolerance: 0.03,
        range: [0.0, 2.0],
        acts_alone: true,
        slot: Slot::PerWheel(|effects, wheel| &mut effects.arms[wheel].lag.time_constant_s),
    }],
};
