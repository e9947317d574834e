//! `gnss-lever-arm`: the antenna is not where the machine file says.

use crate::effects::{Block, Effect, Parameter, Slot};

/// From where the antenna is believed to be to where it is, in the front frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GnssLeverArm {
    /// Forward, m.
    pub x_m: f64,
    /// Left, m.
    pub y_m: f64,
}

/// It shows when the machine turns or rolls: the antenna then goes where the frame does not.
pub(in crate::effects) const EFFECT: Effect = Effect {
    name: "gnss-lever-arm",
    block: Block::Sensor,
    meaning: "the antenna is not where the machine file says",
    source: "assumed: measured with a tape to 5 cm",
    parameters: &[
        Parameter {
            name: "x_m",
            neutral: 0.0,
            tolerance: 0.05,
            range: [-3.0, 3.0],
            acts_alone: true,
            slot: Slot::Whole(|effects| &mut effects.sensors.gnss_lever_arm.x_m),
        },
        Parameter {
            name: "y_m",
            neutral: 0.0,
            tolerance: 0.05,
            range: [-2.0, 2.0],
            acts_alone: true,
            slot: Slot::Whole(|effects| &mut effects.sensors.gnss_lever_arm.y_m),
        },
    ],
};
