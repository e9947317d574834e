//! `rolling-resistance`: the ground holds the wheels back more than the machine file says.

use crate::effects::{Block, Effect, Parameter, Slot};

/// What a wheel's rolling resistance has beyond the nominal coefficient.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RollingResistance {
    /// Coefficient added to the nominal one.
    pub added: f64,
}

/// Drag torque = coefficient x normal force x radius.
pub(in crate::effects) const EFFECT: Effect = Effect {
    name: "rolling-resistance",
    block: Block::Drive,
    meaning: "higher coefficient of rolling resistance",
    source: "textbook values: 0.02 on hard ground, 0.05 to 0.3 on soil, mire and snow",
    parameters: &[Parameter {
        name: "added",
        neutral: 0.0,
        tolerance: 0.01,
        range: [-0.02, 0.5],
        acts_alone: true,
        slot: Slot::PerWheel(|effects, wheel| &mut effects.wheels[wheel].rolling_resistance.added),
    }],
};
