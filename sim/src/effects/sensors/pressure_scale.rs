//! `pressure-scale`: the pressure sensors of a cylinder read in proportion too much.

use crate::effects::{Block, Effect, Parameter, Slot};

/// The scale error of one cylinder's two pressure sensors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PressureScale {
    /// Reading over true pressure.
    pub factor: f64,
}

impl Default for PressureScale {
    fn default() -> Self {
        Self { factor: 1.0 }
    }
}

/// Sensors of another range than the scaling table says: every load shows scaled.
pub(in crate::effects) const EFFECT: Effect = Effect {
    name: "pressure-scale",
    block: Block::Sensor,
    meaning: "pressure sensors read in proportion too much",
    source: "assumed: pressure transmitters are within 1 %",
    parameters: &[Parameter {
        name: "factor",
        neutral: 1.0,
        tolerance: 0.01,
        range: [0.5, 1.5],
        slot: Slot::PerWheel(|effects, wheel| &mut effects.wheels[wheel].pressure_scale.factor),
    }],
};
