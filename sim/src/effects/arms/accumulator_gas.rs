//! `accumulator-gas`: a polytropic gas spring instead of the linear lock.

use crate::effects::{Block, Effect, Parameter, Slot};

/// The gas of one arm's accumulator; its law is [`crate::Accumulator`]'s. The size assumed is as stiff
/// as the linear lock where an arm carries a sixth of the weight, and is never empty under it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AccumulatorGas {
    /// Share of the force that the gas makes while weight presses on the bore side, where it is piped to
    /// (facts 1.2); the rest, and what draws a hanging arm in, is the linear lock's.
    pub share: f64,
    /// Pressure of the gas before oil comes in, Pa over the atmosphere's.
    pub precharge_pa: f64,
    /// Volume of the gas before oil comes in, m³.
    pub volume_m3: f64,
    /// Polytropic exponent: 1 isothermal, 1.4 adiabatic, more for nitrogen at high pressure.
    pub exponent: f64,
}

impl Default for AccumulatorGas {
    fn default() -> Self {
        Self { share: 0.0, precharge_pa: 1.5e6, volume_m3: 1.0e-3, exponent: 1.3 }
    }
}

/// The nominal stiffness is this gas at one load; lighter arms are softer, heavier ones stiffer.
pub(in crate::effects) const EFFECT: Effect = Effect {
    name: "accumulator-gas",
    block: Block::Arms,
    meaning: "polytropic gas spring instead of the linear lock",
    source: "p V^n constant; assumed: small precharged accumulators (facts 1.2) of 0.3 to 2 L",
    parameters: &[
        Parameter {
            name: "share",
            neutral: 0.0,
            tolerance: 0.3,
            range: [0.0, 1.0],
            acts_alone: true,
            slot: Slot::PerWheel(|effects, wheel| &mut effects.arms[wheel].gas.share),
        },
        Parameter {
            name: "precharge_pa",
            neutral: 1.5e6,
            tolerance: 0.5e6,
            range: [0.5e6, 15.0e6],
            acts_alone: false,
            slot: Slot::PerWheel(|effects, wheel| &mut effects.arms[wheel].gas.precharge_pa),
        },
        Parameter {
            name: "volume_m3",
            neutral: 1.0e-3,
            tolerance: 0.3e-3,
            range: [0.1e-3, 5.0e-3],
            acts_alone: false,
            slot: Slot::PerWheel(|effects, wheel| &mut effects.arms[wheel].gas.volume_m3),
        },
        Parameter {
            name: "exponent",
            neutral: 1.3,
            tolerance: 0.15,
            range: [1.0, 1.8],
            acts_alone: false,
            slot: Slot::PerWheel(|effects, wheel| &mut effects.arms[wheel].gas.exponent),
        },
    ],
};
