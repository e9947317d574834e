//! One arm's proportional valve: from the commanded opening to the opening that lets oil flow.

use crate::effects::{ArmEffects, DelayLine};

/// Parameters of a valve. Nominal: the spool is where the command is (paper 3.2).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Valve {
    effects: ArmEffects,
}

/// What a valve remembers.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ValveState {
    commands: DelayLine,
}

impl Valve {
    /// A valve with these effects.
    #[must_use]
    pub const fn new(effects: ArmEffects) -> Self {
        Self { effects }
    }

    /// A closed valve that is stepped every `dt_s` s.
    #[must_use]
    pub fn closed(&self, dt_s: f64) -> ValveState {
        ValveState { commands: DelayLine::new(self.effects.delay.delay_s, dt_s, 0.0) }
    }

    /// Opening after `dt_s` s more under `command`, both -1 (retract) to 1 (extend).
    pub fn step(&self, state: &mut ValveState, command: f64, dt_s: f64) -> f64 {
        state.commands.step(command.clamp(-1.0, 1.0), self.effects.delay.delay_s, dt_s)
    }
}
