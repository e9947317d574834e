//! `pressure-scale`: the pressure sensors of a cylinder are off in proportion.

use crate::effects::{Block, Effect, Parameter, Slot};

/// The scale error of one cylinder's two pressure sensors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PressureScale {
    /// Reading over true pressure in the bore chamber.
    pub factor: f64,
    /// Share of that error that the rod chamber's sensor has too, 0 to 1.
    pub rod_share: f64,
}

impl PressureScale {
    /// Reading over true pressure in the rod chamber; `factor` itself where the error is shared.
    #[must_use]
    pub fn rod_factor(&self) -> f64 {
        self.factor + (1.0 - self.rod_share) * (1.0 - self.factor)
    }
}

impl Default for PressureScale {
    fn default() -> Self {
        Self { factor: 1.0, rod_share: 1.0 }
    }
}

/// Sensors of another range than the scaling table says: every load shows scaled. A supply or a table that
/// is off scales both chambers alike, a worn sensor its own alone.
pub(in crate::effects) const EFFECT: Effect = Effect {
    name: "pressure-scale",
    block: Block::Sensor,
    meaning: "pressure sensors are off in proportion to what they read",
    source: "assumed: pressure transmitters are within 1 %, and both of a cylinder alike",
    parameters: &[
        Parameter {
            name: "factor",
            neutral: 1.0,
            tolerance: 0.01,
            range: [0.5, 1.5],
            acts_alone: true,
            slot: Slot::PerWheel(|effects, wheel| &mut effects.wheels[wheel].pressure_scale.factor),
        },
        Parameter {
            name: "rod_share",
            neutral: 1.0,
            tolerance: 0.1,
            range: [0.0, 1.0],
            acts_alone: false,
            slot: Slot::PerWheel(|effects, wheel| {
                &mut effects.wheels[wheel].pressure_scale.rod_share
            }),
        },
    ],
};
