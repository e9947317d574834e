//! `valve-gain`: all speeds of an arm scaled.

use crate::effects::{Block, Effect, Parameter, Slot};

/// The scale of one arm's speed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ValveGain {
    /// Speed over nominal speed, both ways.
    pub factor: f64,
}

impl Default for ValveGain {
    fn default() -> Self {
        Self { factor: 1.0 }
    }
}

/// Another flow setting, spool or compensator than the one assumed.
pub(in crate::effects) const EFFECT: Effect = Effect {
    name: "valve-gain",
    block: Block::Arms,
    meaning: "all speeds scaled",
    source: "assumed: flow settings are within a tenth of what is written",
    parameters: &[Parameter {
        name: "factor",
        neutral: 1.0,
        tolerance: 0.1,
        range: [0.1, 3.0],
        acts_alone: true,
        slot: Slot::PerWheel(|effects, wheel| &mut effects.arms[wheel].valve_gain.factor),
    }],
};
