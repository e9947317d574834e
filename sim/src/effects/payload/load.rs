//! `payload`: timber in the bunk.

use crate::effects::{Block, Effect, Parameter, Slot};

/// A load on the rear frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Payload {
    /// Mass, kg.
    pub mass_kg: f64,
    /// Its centre ahead of the empty rear frame's centre of mass, m.
    pub longitudinal_m: f64,
    /// Its centre to the left of the centre line, m.
    pub lateral_m: f64,
    /// Its centre above the ground, machine at stroke 0.25 m, m.
    pub height_m: f64,
}

impl Default for Payload {
    fn default() -> Self {
        Self { mass_kg: 0.0, longitudinal_m: 0.0, lateral_m: 0.0, height_m: 1.8 }
    }
}

/// A rigid box of logs that moves with the rear frame, by mass and inertia.
pub(in crate::effects) const EFFECT: Effect = Effect {
    name: "payload",
    block: Block::Payload,
    meaning: "load in the bunk",
    source: "load capacity 14 t of the paper's table; where it lies in the bunk is assumed, as are the \
             200 kg of mud, fuel and tools in a bunk that is called empty",
    parameters: &[
        Parameter {
            name: "mass_kg",
            neutral: 0.0,
            tolerance: 200.0,
            range: [0.0, 14_000.0],
            acts_alone: true,
            slot: Slot::Whole(|effects| &mut effects.masses.payload.mass_kg),
        },
        Parameter {
            name: "longitudinal_m",
            neutral: 0.0,
            tolerance: 0.3,
            range: [-1.5, 1.5],
            acts_alone: false,
            slot: Slot::Whole(|effects| &mut effects.masses.payload.longitudinal_m),
        },
        Parameter {
            name: "lateral_m",
            neutral: 0.0,
            tolerance: 0.15,
            range: [-0.8, 0.8],
            acts_alone: false,
            slot: Slot::Whole(|effects| &mut effects.masses.payload.lateral_m),
        },
        Parameter {
            name: "height_m",
            neutral: 1.8,
            tolerance: 0.3,
            range: [0.8, 3.0],
            acts_alone: false,
            slot: Slot::Whole(|effects| &mut effects.masses.payload.height_m),
        },
    ],
};
