//! `speed-asymmetry`: an arm extends and contracts at different speeds.

use crate::effects::{Block, Effect, Parameter, Slot};

/// The scales of one arm's speed, by direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpeedAsymmetry {
    /// Extending speed over nominal.
    pub extension_factor: f64,
    /// Contracting speed over nominal.
    pub contraction_factor: f64,
}

impl Default for SpeedAsymmetry {
    fn default() -> Self {
        Self { extension_factor: 1.0, contraction_factor: 1.0 }
    }
}

impl SpeedAsymmetry {
    /// The scale for an opening of this sign.
    #[must_use]
    pub fn factor(&self, opening: f64) -> f64 {
        if opening < 0.0 { self.contraction_factor } else { self.extension_factor }
    }
}

/// The same flow moves the piston faster on its smaller side; spools may be cut to make up for it.
pub(in crate::effects) const EFFECT: Effect = Effect {
    name: "speed-asymmetry",
    block: Block::Arms,
    meaning: "extension and contraction speeds differ",
    source: "facts 1.2: bore over rod area is 1.33, which the nominal actuator leaves out",
    parameters: &[
        Parameter {
            name: "extension_factor",
            neutral: 1.0,
            tolerance: 0.1,
            range: [0.1, 3.0],
            acts_alone: true,
            slot: Slot::PerWheel(|effects, wheel| {
                &mut effects.arms[wheel].asymmetry.extension_factor
            }),
        },
        Parameter {
            name: "contraction_factor",
            neutral: 1.0,
            tolerance: 0.2,
            range: [0.1, 3.0],
            acts_alone: true,
            slot: Slot::PerWheel(|effects, wheel| {
                &mut effects.arms[wheel].asymmetry.contraction_factor
            }),
        },
    ],
};
