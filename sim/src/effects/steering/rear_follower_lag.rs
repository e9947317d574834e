//! `rear-follower-lag`: the rear joint follows the front one late or weakly.

use crate::effects::{Block, Effect, Parameter, Slot};

/// How the rear joint's target comes from the front joint, which is the ECU's law, and how its valve follows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RearFollowerLag {
    /// Time constant of the front angle on its way to the rear target, s.
    pub time_constant_s: f64,
    /// Ratio over nominal ratio.
    pub ratio_factor: f64,
    /// Time constant of the rear valve's spool beyond that of both, s.
    pub valve_time_constant_s: f64,
}

impl Default for RearFollowerLag {
    fn default() -> Self {
        Self { time_constant_s: 0.0, ratio_factor: 1.0, valve_time_constant_s: 0.0 }
    }
}

/// A filter on the front angle or another ratio in the follower, or a rear valve that answers later than the front
/// one: within the loop that the follower closes, so that it overshoots where the filter only delays.
pub(in crate::effects) const EFFECT: Effect = Effect {
    name: "rear-follower-lag",
    block: Block::Steering,
    meaning: "the rear joint follows late or weakly",
    source: "facts 4: the follower works on a filtered front angle; sizes assumed",
    parameters: &[
        Parameter {
            name: "time_constant_s",
            neutral: 0.0,
            tolerance: 0.03,
            range: [0.0, 5.0],
            acts_alone: true,
            slot: Slot::Whole(|effects| &mut effects.steering.rear_follower.time_constant_s),
        },
        Parameter {
            name: "ratio_factor",
            neutral: 1.0,
            tolerance: 0.05,
            range: [0.0, 2.0],
            acts_alone: true,
            slot: Slot::Whole(|effects| &mut effects.steering.rear_follower.ratio_factor),
        },
        Parameter {
            name: "valve_time_constant_s",
            neutral: 0.0,
            tolerance: 0.03,
            range: [0.0, 2.0],
            acts_alone: true,
            slot: Slot::Whole(|effects| &mut effects.steering.rear_follower.valve_time_constant_s),
        },
    ],
};
