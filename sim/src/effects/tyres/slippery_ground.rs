//! `slippery-ground`: wheels turn faster than the machine travels.

use crate::effects::{Block, Effect, Parameter, Slot};

/// How one wheel's grip falls short of the nominal one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlipperyGround {
    /// Friction there is over nominal friction.
    pub friction_factor: f64,
    /// Share of a wheel's rolling that does not become travel, even where friction suffices.
    pub slip: f64,
    /// Speed at which the ground's top layer shears for every newton that a wheel pushes it with, m/s/N.
    pub creep_m_s_n: f64,
}

impl Default for SlipperyGround {
    fn default() -> Self {
        Self { friction_factor: 1.0, slip: 0.0, creep_m_s_n: 0.0 }
    }
}

/// Three things that slippery ground does: it carries less force sideways and along, its top layer gives way
/// under a rolling wheel, v = (1 - slip) w R, and shears under one that pushes, v = w R - creep F.
pub(in crate::effects) const EFFECT: Effect = Effect {
    name: "slippery-ground",
    block: Block::Drive,
    meaning: "wheels turn faster than the machine travels",
    source: "terramechanics (Wong): 2 to 5 % of slip at light pull on forest soil, 0.1 to 0.4 of \
             friction on mud and ice",
    parameters: &[
        Parameter {
            name: "friction_factor",
            neutral: 1.0,
            tolerance: 0.3,
            // Wet ice has some 0.03 to 0.05, where 0.7 is believed.
            range: [0.05, 2.0],
            acts_alone: true,
            slot: Slot::PerWheel(|effects, wheel| {
                &mut effects.wheels[wheel].slippery_ground.friction_factor
            }),
        },
        Parameter {
            name: "slip",
            neutral: 0.0,
            tolerance: 0.03,
            // Below nothing only as far as a wheel may be larger than believed: what travels further than its
            // wheels say by more does not slip.
            range: [-0.04, 0.9],
            acts_alone: true,
            slot: Slot::PerWheel(|effects, wheel| &mut effects.wheels[wheel].slippery_ground.slip),
        },
        Parameter {
            name: "creep_m_s_n",
            neutral: 0.0,
            tolerance: 1.0e-5,
            range: [0.0, 1.0e-3],
            acts_alone: true,
            slot: Slot::PerWheel(|effects, wheel| {
                &mut effects.wheels[wheel].slippery_ground.creep_m_s_n
            }),
        },
    ],
};
