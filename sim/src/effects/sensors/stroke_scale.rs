//! `stroke-scale`: a position sensor is off in proportion.

use crate::effects::{Block, Effect, Parameter, Slot};

/// The scale error of one cylinder's position sensor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StrokeScale {
    /// Reading over true stroke.
    pub factor: f64,
}

impl Default for StrokeScale {
    fn default() -> Self {
        Self { factor: 1.0 }
    }
}

/// A sensor of another length than the scaling table says, or a supply that is off.
pub(in crate::effects) const EFFECT: Effect = Effect {
    name: "stroke-scale",
    block: Block::Sensor,
    meaning: "a position sensor is off in proportion to what it reads",
    source: "assumed: linear position sensors are within half a percent",
    parameters: &[Parameter {
        name: "factor",
        neutral: 1.0,
        tolerance: 0.005,
        range: [0.5, 1.5],
        acts_alone: true,
        slot: Slot::PerWheel(|effects, wheel| &mut effects.wheels[wheel].stroke_scale.factor),
    }],
};
