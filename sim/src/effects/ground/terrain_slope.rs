//! `terrain-slope`: the ground as a whole is not as level as the map says.

use crate::effects::{Block, Effect, Parameter, Slot};

/// How the whole ground leans against the level.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TerrainSlope {
    /// Rising forward (east), rad.
    pub grade_x_rad: f64,
    /// Rising to the left (north), rad.
    pub grade_y_rad: f64,
}

/// The ground turns about the origin as one. Every sensor sees what it sees on a real slope: the
/// IMU the lean, the receiver the climb; maps go on showing the ground without it.
pub(in crate::effects) const EFFECT: Effect = Effect {
    name: "terrain-slope",
    block: Block::Ground,
    meaning: "the ground is not as level as assumed",
    source: "assumed: a yard that is called level is so within a quarter of a degree",
    parameters: &[
        Parameter {
            name: "grade_x_rad",
            neutral: 0.0,
            tolerance: 0.004,
            range: [-0.5, 0.5],
            acts_alone: true,
            slot: Slot::Whole(|effects| &mut effects.slope.grade_x_rad),
        },
        Parameter {
            name: "grade_y_rad",
            neutral: 0.0,
            tolerance: 0.004,
            range: [-0.5, 0.5],
            acts_alone: true,
            slot: Slot::Whole(|effects| &mut effects.slope.grade_y_rad),
        },
    ],
};
