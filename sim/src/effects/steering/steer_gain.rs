//! `steer-gain`: the ECU's steering controller has other gains than the ones written down.

use crate::effects::{Block, Effect, Parameter, Slot};

/// Scales of the controller's gains; the law itself is the ECU's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SteerGain {
    /// Proportional gain over nominal.
    pub kp_factor: f64,
    /// Integral gain over nominal.
    pub ki_factor: f64,
}

impl Default for SteerGain {
    fn default() -> Self {
        Self { kp_factor: 1.0, ki_factor: 1.0 }
    }
}

/// A parameter set of another machine; both joints have the same controller.
pub(in crate::effects) const EFFECT: Effect = Effect {
    name: "steer-gain",
    block: Block::Steering,
    meaning: "the ECU's steering PI has other gains",
    source: "assumed: gains in a file are exact; a twentieth allows for rounding",
    parameters: &[
        Parameter {
            name: "kp_factor",
            neutral: 1.0,
            tolerance: 0.05,
            range: [0.1, 5.0],
            acts_alone: true,
            slot: Slot::Whole(|effects| &mut effects.steering.gain.kp_factor),
        },
        Parameter {
            name: "ki_factor",
            neutral: 1.0,
            tolerance: 0.05,
            range: [0.0, 5.0],
            acts_alone: true,
            slot: Slot::Whole(|effects| &mut effects.steering.gain.ki_factor),
        },
    ],
};
