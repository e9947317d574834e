//! `steer-backlash`: play between the steering cylinders and the articulation joint.

use crate::effects::{Block, Effect, Parameter, Slot};

/// The play of either joint.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SteerBacklash {
    /// Whole width of the play, rad.
    pub width_rad: f64,
}

impl SteerBacklash {
    /// Where the joint is held: it stays until the oil has crossed the play, then goes along.
    #[must_use]
    pub fn held_rad(&self, held_rad: f64, oil_rad: f64) -> f64 {
        let half = 0.5 * self.width_rad;
        held_rad.max(oil_rad - half).min(oil_rad + half)
    }
}

/// Worn pins: after each change of direction the cylinder runs empty through the play.
pub(in crate::effects) const EFFECT: Effect = Effect {
    name: "steer-backlash",
    block: Block::Steering,
    meaning: "play between steering cylinders and joint",
    source: "play operator; assumed: pin wear of a millimetre at a lever of 0.2 m is 0.3 degrees",
    parameters: &[Parameter {
        name: "width_rad",
        neutral: 0.0,
        tolerance: 0.005,
        range: [0.0, 0.2],
        acts_alone: true,
        slot: Slot::Whole(|effects| &mut effects.steering.backlash.width_rad),
    }],
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_play_is_crossed_at_each_turn() {
        let play = SteerBacklash { width_rad: 0.04 };
        let mut held = 0.0;
        for oil in [0.01, 0.02, 0.05] {
            held = play.held_rad(held, oil);
        }
        assert!((held - 0.03).abs() < 1e-12);
        for oil in [0.04, 0.02, 0.0] {
            held = play.held_rad(held, oil);
        }
        assert!((held - 0.02).abs() < 1e-12);
    }

    #[test]
    fn without_play_the_joint_is_where_the_oil_is() {
        assert_eq!(SteerBacklash::default().held_rad(0.3, 0.123), 0.123);
    }
}
