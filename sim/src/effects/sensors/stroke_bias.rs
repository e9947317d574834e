//! `stroke-bias`: a position sensor is off by a constant.

use crate::effects::{Block, Effect, Parameter, Slot};

/// The offset of one cylinder's position sensor.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StrokeBias {
    /// Reading less true stroke, m.
    pub bias_m: f64,
}

/// A sensor mounted or calibrated a little off. The ECU then holds the arm off by as much.
pub(in crate::effects) const EFFECT: Effect = Effect {
    name: "stroke-bias",
    block: Block::Sensor,
    meaning: "a position sensor is off by a constant",
    source: "assumed: zero points are set by hand to a millimetre",
    parameters: &[Parameter {
        name: "bias_m",
        neutral: 0.0,
        tolerance: 0.001,
        range: [-0.1, 0.1],
        acts_alone: true,
        slot: Slot::PerWheel(|effects, wheel| &mut effects.wheels[wheel].stroke_bias.bias_m),
    }],
};
