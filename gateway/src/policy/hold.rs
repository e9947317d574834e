//! `hold`: armed, and nothing moves.

use xt28_safety::{Arms, Command};

use super::{Outcome, Pace, Policy};
use crate::Observation;

/// Throttle at zero, every arm and the joint held where they are.
#[derive(Clone, Copy, Debug, Default)]
pub struct Hold;

impl Policy for Hold {
    fn pace(&self) -> Pace {
        Pace::Tick
    }

    fn act(&mut self, observation: &Observation) -> Option<Command> {
        Some(Command {
            throttle: 0.0,
            front_angle_rad: observation.front_joint_rad,
            arms: Arms::Position([None; 6]),
            brake: false,
        })
    }

    fn outcome(&self) -> Outcome {
        Outcome::Endless
    }
}
