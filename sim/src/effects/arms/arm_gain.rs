//! `arm-gain`: the ECU's position controller has other gains than the ones written down.

use crate::effects::{Block, Effect, Parameter, Slot};

/// Scales of one arm's position PI; the law itself is the ECU's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ArmGain {
    /// Proportional gain over nominal.
    pub kp_factor: f64,
    /// Integral gain over nominal.
    pub ki_factor: f64,
}

impl Default for ArmGain {
    fn default() -> Self {
        Self { kp_factor: 1.0, ki_factor: 1.0 }
    }
}

/// A parameter set of another machine.
pub(in crate::effects) const EFFECT: Effect = Effect {
    name: "arm-gain",
    block: Block::Arms,
    meaning: "the ECU's position PI has other gains",
    source: "assumed: gains in a file are exact; a twentieth allows for rounding",
    parameters: &[
        Parameter {
            name: "kp_factor",
            neutral: 1.0,
            tolerance: 0.05,
            range: [0.1, 5.0],
            acts_alone: true,
            slot: Slot::PerWheel(|effects, wheel| &mut effects.arms[wheel].gain.kp_factor),
        },
        Parameter {
            name: "ki_factor",
            neutral: 1.0,
            tolerance: 0.05,
            range: [0.0, 5.0],
            acts_alone: true,
            slot: Slot::PerWheel(|effects, wheel| &mut effects.arms[wheel].gain.ki_factor),
        },
    ],
};
