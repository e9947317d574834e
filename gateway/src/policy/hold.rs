//! `hold`: armed, and nothing moves.

use xt28_safety::Command;

use super::{Outcome, Pace, Policy, held};
use crate::Observation;

/// Throttle at zero, every arm and the joint held where they are.
#[derive(Clone, Copy, Debug, Default)]
pub struct Hold;

impl Policy for Hold {
    fn pace(&self) -> Pace {
        Pace::Tick
    }

    fn act(&mut self, observation: &Observation) -> Option<Command> {
        Some(held(observation.front_joint_rad, false))
    }

    fn outcome(&self) -> Outcome {
        Outcome::Endless
    }
}
