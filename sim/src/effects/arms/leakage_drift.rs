//! `leakage-drift`: a loaded cylinder creeps.

use crate::effects::{Block, Effect, Parameter, Slot};

/// The leak of one arm's cylinder, past the piston and through the valve.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LeakageDrift {
    /// Speed of creep under the nominal load, m/s.
    pub rate_m_s: f64,
}

impl LeakageDrift {
    /// Extending speed of the creep. A thin gap leaks in proportion to the pressure over it, for which the
    /// cylinder's load stands: weight makes it sink and a hanging wheel draws it out.
    #[must_use]
    pub fn speed_m_s(&self, load_n: f64, nominal_load_n: f64) -> f64 {
        -self.rate_m_s * (load_n / nominal_load_n)
    }
}

/// Worn piston seals or a spool that does not close; the nominal cylinder is tight.
pub(in crate::effects) const EFFECT: Effect = Effect {
    name: "leakage-drift",
    block: Block::Arms,
    meaning: "a loaded cylinder creeps, in proportion to its load",
    source: "laminar leakage, Merritt (1967) 3; nominal load is a sixth of the weight; size assumed",
    parameters: &[Parameter {
        name: "rate_m_s",
        neutral: 0.0,
        tolerance: 5.0e-4,
        range: [0.0, 0.05],
        acts_alone: true,
        slot: Slot::PerWheel(|effects, wheel| &mut effects.arms[wheel].leakage.rate_m_s),
    }],
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_creep_goes_with_the_load() {
        let leak = LeakageDrift { rate_m_s: 0.004 };
        assert!((leak.speed_m_s(55e3, 55e3) + 0.004).abs() < 1e-15);
        assert!((leak.speed_m_s(-11e3, 55e3) - 0.0008).abs() < 1e-15);
        assert_eq!(LeakageDrift::default().speed_m_s(55e3, 55e3), 0.0);
    }
}
