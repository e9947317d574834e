//! `pressure-bias`: the bore chamber's pressure sensor is off by a constant.

use crate::effects::{Block, Effect, Parameter, Slot};

/// The offset of one cylinder's bore pressure sensor.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PressureBias {
    /// Reading less true pressure, Pa.
    pub bias_pa: f64,
}

/// Zero drift. It shows as a wheel force that is not there: 1 bar is 0.8 kN in the cylinder.
pub(in crate::effects) const EFFECT: Effect = Effect {
    name: "pressure-bias",
    block: Block::Sensor,
    meaning: "a bore pressure sensor is off by a constant",
    source: "assumed: transmitters of 400 bar whose zero is trimmed keep it within half a bar",
    parameters: &[Parameter {
        name: "bias_pa",
        neutral: 0.0,
        tolerance: 5.0e4,
        range: [-5.0e6, 5.0e6],
        acts_alone: true,
        slot: Slot::PerWheel(|effects, wheel| &mut effects.wheels[wheel].pressure_bias.bias_pa),
    }],
};
