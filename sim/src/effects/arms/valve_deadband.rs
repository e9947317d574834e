//! `valve-deadband`: opening below which nothing flows.

use crate::effects::{Block, Effect, Parameter, Slot};

/// The overlap of one arm's spool that the ECU's starting current does not cover.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ValveDeadband {
    /// Commanded opening at which oil begins to flow, share of full opening.
    pub deadband: f64,
}

impl ValveDeadband {
    /// The opening that lets oil flow: the spool's, less the overlap on either side of the centre.
    ///
    /// The slope beyond is the nominal one, since it is the spool's curve that is shifted, not bent.
    #[must_use]
    pub fn opening(&self, spool: f64) -> f64 {
        spool - spool.clamp(-self.deadband, self.deadband)
    }
}

/// The current that first lets oil through differs from valve to valve; the ECU knows but one.
pub(in crate::effects) const EFFECT: Effect = Effect {
    name: "valve-deadband",
    block: Block::Arms,
    meaning: "opening below which nothing flows",
    source: "Merritt, Hydraulic Control Systems (1967), 5: overlapped spools; size assumed",
    parameters: &[Parameter {
        name: "deadband",
        neutral: 0.0,
        tolerance: 0.02,
        range: [0.0, 0.5],
        acts_alone: true,
        slot: Slot::PerWheel(|effects, wheel| &mut effects.arms[wheel].deadband.deadband),
    }],
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_flows_below_and_the_slope_beyond_is_one() {
        let valve = ValveDeadband { deadband: 0.04 };
        assert_eq!(valve.opening(0.04), 0.0);
        assert_eq!(valve.opening(-0.039), 0.0);
        assert!((valve.opening(0.3) - 0.26).abs() < 1e-12);
        assert!((valve.opening(-0.3) + 0.26).abs() < 1e-12);
    }

    #[test]
    fn without_a_deadband_the_opening_is_the_spool() {
        for spool in [-1.0, -1e-9, 0.0, 0.123] {
            assert_eq!(ValveDeadband::default().opening(spool), spool);
        }
    }
}
