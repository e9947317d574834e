//! `load-dependent-speed`: the speed at an opening depends on the cylinder's load.

use crate::effects::{Block, Effect, Parameter, Slot};

/// Pressure drop that the compensator is set to hold over the spool, Pa (facts 1.2: 8 bar).
const COMPENSATOR_DROP_PA: f64 = 8.0e5;
/// The drop never falls below this share of the setting: a fifth of the speed is left (assumed).
const DROP_SHARE_MIN: f64 = 0.04;

/// How far one arm's pressure compensator is off its setting under load.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoadDependentSpeed {
    /// Drop lost over the spool per load pressure, Pa/Pa.
    pub droop: f64,
    /// Load pressure at which the valve was set, and is as fast as it should be, Pa.
    pub set_at_pa: f64,
    /// How many times as much drop a load gives to contraction as it takes of extension: a spool
    /// between load and tank has less over it than one between pump and load.
    pub contraction_factor: f64,
}

impl Default for LoadDependentSpeed {
    fn default() -> Self {
        Self { droop: 0.0, set_at_pa: 0.0, contraction_factor: 1.0 }
    }
}

impl LoadDependentSpeed {
    /// Speed over nominal speed: the flow through an orifice goes with the root of its drop. A load
    /// slows what works against it and hurries what goes along with it.
    #[must_use]
    pub fn factor(&self, opening: f64, load_pressure_pa: f64) -> f64 {
        if self.droop == 0.0 {
            return 1.0;
        }
        let lost = self.droop * (load_pressure_pa - self.set_at_pa) / COMPENSATOR_DROP_PA;
        let drop = if opening < 0.0 { 1.0 + self.contraction_factor * lost } else { 1.0 - lost };
        drop.max(DROP_SHARE_MIN).sqrt()
    }
}

/// Flow forces and a soft spring let the compensator give way; without one, this is all there is.
pub(in crate::effects) const EFFECT: Effect = Effect {
    name: "load-dependent-speed",
    block: Block::Arms,
    meaning: "speed depends on cylinder load",
    source: "orifice equation, Merritt (1967) 3; assumed: a bare orifice under 350 bar is at 0.023",
    parameters: &[
        Parameter {
            name: "droop",
            neutral: 0.0,
            tolerance: 0.01,
            range: [0.0, 0.15],
            acts_alone: true,
            slot: Slot::PerWheel(|effects, wheel| &mut effects.arms[wheel].load_dependence.droop),
        },
        Parameter {
            name: "set_at_pa",
            neutral: 0.0,
            tolerance: 2.0e6,
            range: [0.0, 2.0e7],
            acts_alone: false,
            slot: Slot::PerWheel(|effects, wheel| {
                &mut effects.arms[wheel].load_dependence.set_at_pa
            }),
        },
        Parameter {
            name: "contraction_factor",
            neutral: 1.0,
            tolerance: 0.3,
            range: [0.0, 4.0],
            acts_alone: false,
            slot: Slot::PerWheel(|effects, wheel| {
                &mut effects.arms[wheel].load_dependence.contraction_factor
            }),
        },
    ],
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_load_slows_extension_and_hurries_contraction() {
        let valve = LoadDependentSpeed { droop: 0.02, ..LoadDependentSpeed::default() };
        // 100 bar take 2 bar off 8 bar.
        assert!((valve.factor(0.3, 1.0e7) - 0.75_f64.sqrt()).abs() < 1e-12);
        assert!((valve.factor(-0.3, 1.0e7) - 1.25_f64.sqrt()).abs() < 1e-12);
        assert!((valve.factor(0.3, -1.0e7) - 1.25_f64.sqrt()).abs() < 1e-12);
        assert!((valve.factor(-0.3, -1.0e7) - 0.75_f64.sqrt()).abs() < 1e-12);
        assert!((valve.factor(0.3, 1.0e9) - 0.2).abs() < 1e-12);
    }

    #[test]
    fn set_under_a_load_it_is_right_there_and_a_load_hurries_contraction_by_more() {
        let valve = LoadDependentSpeed { droop: 0.02, set_at_pa: 1.0e7, contraction_factor: 2.0 };
        assert_eq!([valve.factor(0.3, 1.0e7), valve.factor(-0.3, 1.0e7)], [1.0, 1.0]);
        assert!((valve.factor(0.3, 2.0e7) - 0.75_f64.sqrt()).abs() < 1e-12);
        assert!((valve.factor(-0.3, 2.0e7) - 1.5_f64.sqrt()).abs() < 1e-12);
    }

    #[test]
    fn a_perfect_compensator_does_not_know_the_load() {
        assert_eq!(LoadDependentSpeed::default().factor(0.3, 1.0e7), 1.0);
    }
}
