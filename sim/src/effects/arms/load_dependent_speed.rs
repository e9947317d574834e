//! `load-dependent-speed`: the speed at an opening depends on the cylinder's load.

use crate::effects::{Block, Effect, Parameter, Slot};

/// Pressure drop that the compensator is set to hold over the spool, Pa (facts 1.2: 8 bar).
const COMPENSATOR_DROP_PA: f64 = 8.0e5;
/// The drop never falls below this share of the setting: a fifth of the speed is left (assumed).
const DROP_SHARE_MIN: f64 = 0.04;

/// How far one arm's pressure compensator is off its setting under load.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LoadDependentSpeed {
    /// Drop lost over the spool per load pressure, Pa/Pa.
    pub droop: f64,
}

impl LoadDependentSpeed {
    /// Speed over nominal speed: the flow through an orifice goes with the root of its drop. A load
    /// slows what works against it and hurries what goes along with it.
    #[must_use]
    pub fn factor(&self, opening: f64, load_pressure_pa: f64) -> f64 {
        if self.droop == 0.0 {
            return 1.0;
        }
        let lost = self.droop * load_pressure_pa / COMPENSATOR_DROP_PA;
        (1.0 - lost * opening.signum()).max(DROP_SHARE_MIN).sqrt()
    }
}

/// Flow forces and a soft spring let the compensator give way; without one, this is all there is.
pub(in crate::effects) const EFFECT: Effect = Effect {
    name: "load-dependent-speed",
    block: Block::Arms,
    meaning: "speed depends on cylinder load",
    source: "orifice equation, Merritt (1967) 3; assumed: a bare orifice under 350 bar is at 0.023",
    parameters: &[Parameter {
        name: "droop",
        neutral: 0.0,
        tolerance: 0.01,
        range: [0.0, 0.05],
        slot: Slot::PerWheel(|effects, wheel| &mut effects.arms[wheel].load_dependence.droop),
    }],
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_load_slows_extension_and_hurries_contraction() {
        let valve = LoadDependentSpeed { droop: 0.02 };
        // 100 bar take 2 bar off 8 bar.
        assert!((valve.factor(0.3, 1.0e7) - 0.75_f64.sqrt()).abs() < 1e-12);
        assert!((valve.factor(-0.3, 1.0e7) - 1.25_f64.sqrt()).abs() < 1e-12);
        assert!((valve.factor(0.3, -1.0e7) - 1.25_f64.sqrt()).abs() < 1e-12);
        assert!((valve.factor(-0.3, -1.0e7) - 0.75_f64.sqrt()).abs() < 1e-12);
        assert!((valve.factor(0.3, 1.0e9) - 0.2).abs() < 1e-12);
    }

    #[test]
    fn a_perfect_compensator_does_not_know_the_load() {
        assert_eq!(LoadDependentSpeed::default().factor(0.3, 1.0e7), 1.0);
    }
}
