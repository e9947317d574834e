//! `wheel-speed-scale`: a wheel's speed is read in proportion too large or too small.

use crate::effects::{Block, Effect, Parameter, Slot};

/// The scale error of one wheel's speed sensor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WheelSpeedScale {
    /// Reading over true speed.
    pub factor: f64,
}

impl Default for WheelSpeedScale {
    fn default() -> Self {
        Self { factor: 1.0 }
    }
}

/// Another ratio of the final drive, or another rolling radius, than the table's: the reading is off, not the
/// speed.
pub(in crate::effects) const EFFECT: Effect = Effect {
    name: "wheel-speed-scale",
    block: Block::Sensor,
    meaning: "a wheel speed sensor is off in proportion to what it reads",
    source: "assumed: pulse counts are exact, the rolling radius is known to 1 %",
    parameters: &[Parameter {
        name: "factor",
        neutral: 1.0,
        tolerance: 0.01,
        range: [0.5, 1.5],
        acts_alone: true,
        slot: Slot::PerWheel(|effects, wheel| &mut effects.wheels[wheel].wheel_speed_scale.factor),
    }],
};
