//! `lock-damping`: the passive damping of a closed cylinder is not as assumed.

use crate::effects::{Block, Effect, Parameter, Slot};

/// The scale of one arm's damping.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LockDamping {
    /// Damping over nominal.
    pub factor: f64,
}

impl Default for LockDamping {
    fn default() -> Self {
        Self { factor: 1.0 }
    }
}

/// The throttle at the accumulator, the oil's temperature: the number is assumed to begin with.
pub(in crate::effects) const EFFECT: Effect = Effect {
    name: "lock-damping",
    block: Block::Arms,
    meaning: "passive damping not as assumed",
    source: "assumed: a throttle's damping is known to a third before it is measured",
    parameters: &[Parameter {
        name: "factor",
        neutral: 1.0,
        tolerance: 0.3,
        range: [0.1, 5.0],
        acts_alone: true,
        slot: Slot::PerWheel(|effects, wheel| &mut effects.arms[wheel].lock_damping.factor),
    }],
};
