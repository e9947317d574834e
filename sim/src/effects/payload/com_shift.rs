//! `com-shift`: the centre of mass lies elsewhere than the drawings say.

use crate::effects::{Block, Effect, Parameter, Slot};

/// Where the front frame's centre of mass is, from where the machine file has it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ComShift {
    /// Forward, m.
    pub x_m: f64,
    /// To the left, m.
    pub y_m: f64,
    /// Up, m.
    pub z_m: f64,
}

/// On the front frame: engine, tanks and cab are the masses nobody has weighed, and what lies
/// behind is the payload's matter. A shift of 0.1 m moves the whole empty machine's by 0.043 m.
pub(in crate::effects) const EFFECT: Effect = Effect {
    name: "com-shift",
    block: Block::Payload,
    meaning: "the front frame's centre of mass is elsewhere",
    source: "assumed: positions in the machine file are estimates from the photo and the load split",
    parameters: &[
        Parameter {
            name: "x_m",
            neutral: 0.0,
            tolerance: 0.03,
            range: [-1.0, 1.0],
            acts_alone: true,
            slot: Slot::Whole(|effects| &mut effects.masses.com_shift.x_m),
        },
        Parameter {
            name: "y_m",
            neutral: 0.0,
            tolerance: 0.015,
            range: [-0.5, 0.5],
            acts_alone: true,
            slot: Slot::Whole(|effects| &mut effects.masses.com_shift.y_m),
        },
        Parameter {
            name: "z_m",
            neutral: 0.0,
            tolerance: 0.05,
            range: [-0.7, 0.7],
            acts_alone: true,
            slot: Slot::Whole(|effects| &mut effects.masses.com_shift.z_m),
        },
    ],
};
