//! `drive-lag`: the circuits take up their speed through a further first-order lag.

use crate::effects::{Block, Effect, Parameter, Slot};

/// The lag of both circuits, beside the nominal machine's own.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DriveLag {
    /// Time constant, s.
    pub time_constant_s: f64,
}

/// The stroke of the pumps' swash plates, which takes its time with the pump's size.
pub(in crate::effects) const EFFECT: Effect = Effect {
    name: "drive-lag",
    block: Block::Drive,
    meaning: "further first-order lag from throttle to wheel speed",
    source: "assumed: stroke times of mobile pump controls are 0.3 to 1.5 s over the full range",
    parameters: &[Parameter {
        name: "time_constant_s",
        neutral: 0.0,
        tolerance: 0.05,
        range: [0.0, 3.0],
        slot: Slot::Whole(|effects| &mut effects.drive.lag.time_constant_s),
    }],
};
