//! `lock-stiffness`: how stiff one arm's closed oil is; a tolerance of sound machines, no fault.

use crate::effects::{Block, Effect, Parameter, Slot};

/// The scale of one arm's lock.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LockStiffness {
    /// Stiffness over nominal.
    pub factor: f64,
}

impl Default for LockStiffness {
    fn default() -> Self {
        Self { factor: 1.0 }
    }
}

/// Hoses, air in the oil and the accumulator's fill differ from arm to arm. It is not in the
/// catalogue: nothing is wrong with such an arm, but what is wrong shows only beside it.
pub static LOCK_STIFFNESS: Effect = Effect {
    name: "lock-stiffness",
    block: Block::Arms,
    meaning: "a closed cylinder gives way more or less than nominal",
    source: "assumed: a twentieth from arm to arm",
    parameters: &[Parameter {
        name: "factor",
        neutral: 1.0,
        tolerance: 0.05,
        range: [0.5, 2.0],
        acts_alone: true,
        slot: Slot::PerWheel(|effects, wheel| &mut effects.arms[wheel].lock_stiffness.factor),
    }],
};
