//! `steer-rate`: the joints turn faster or slower than the valve's opening says.

use crate::effects::{Block, Effect, Parameter, Slot};

/// The scale of both joints' rates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SteerRate {
    /// Rate over nominal rate.
    pub factor: f64,
}

impl Default for SteerRate {
    fn default() -> Self {
        Self { factor: 1.0 }
    }
}

/// Another pump, orifice or cylinder than the one assumed.
pub(in crate::effects) const EFFECT: Effect = Effect {
    name: "steer-rate",
    block: Block::Steering,
    meaning: "all rates of the joints scaled",
    source: "assumed: flow settings are within a tenth of what is written",
    parameters: &[Parameter {
        name: "factor",
        neutral: 1.0,
        tolerance: 0.1,
        range: [0.1, 3.0],
        acts_alone: true,
        slot: Slot::Whole(|effects| &mut effects.steering.rate.factor),
    }],
};
