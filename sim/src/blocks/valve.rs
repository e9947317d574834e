//! One arm's proportional valve: from the commanded opening to the speed it asks of the cylinder.

use xt28_machine::Machine;

use crate::effects::{
    ArmDelay, ArmEffects, DelayLine, Lag, LoadDependentSpeed, SpeedAsymmetry, ValveDeadband,
    ValveGain, ValveHysteresis, ValveLag,
};

/// Parameters of a valve. Nominal: the spool is where the command is, and the speed is proportional
/// to its opening whatever the load (paper 3.2).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Valve {
    speed_full_m_s: f64,
    area_bore_m2: f64,
    delay: ArmDelay,
    lag: ValveLag,
    hysteresis: ValveHysteresis,
    deadband: ValveDeadband,
    gain: ValveGain,
    asymmetry: SpeedAsymmetry,
    load_dependence: LoadDependentSpeed,
}

/// What a valve remembers.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ValveState {
    commands: DelayLine,
    pull: Lag,
    spool: f64,
}

impl ValveState {
    /// Puts the spool where it is pulled, whatever play it has: there it is as a play sets in.
    pub const fn release(&mut self) {
        self.spool = self.pull.value();
    }
}

impl Valve {
    /// A valve of this machine.
    #[must_use]
    pub const fn new(machine: &Machine, effects: &ArmEffects) -> Self {
        Self {
            speed_full_m_s: machine.hydraulics.speed_full_m_s,
            area_bore_m2: machine.arms.area_bore_m2,
            delay: effects.delay,
            lag: effects.lag,
            hysteresis: effects.hysteresis,
            deadband: effects.deadband,
            gain: effects.valve_gain,
            asymmetry: effects.asymmetry,
            load_dependence: effects.load_dependence,
        }
    }

    /// A valve that has stood under `command` for long and is stepped every `dt_s` s.
    #[must_use]
    pub fn held(&self, command: f64, dt_s: f64) -> ValveState {
        let command = command.clamp(-1.0, 1.0);
        ValveState {
            commands: DelayLine::new(self.delay.delay_s, dt_s, command),
            pull: Lag::new(command),
            spool: self.hysteresis.spool(0.0, command),
        }
    }

    /// The same of a valve whose spool rests elsewhere in its play: `share` of half of that, -1 to 1, off the command.
    #[must_use]
    pub fn held_off(&self, command: f64, share: f64, dt_s: f64) -> ValveState {
        let half = 0.5 * self.hysteresis.width;
        let held = self.held(command, dt_s);
        ValveState { spool: command.clamp(-1.0, 1.0) + share.clamp(-1.0, 1.0) * half, ..held }
    }

    /// Where the spool is after `dt_s` s more under `command`, both -1 (retract) to 1 (extend).
    pub fn step(&self, state: &mut ValveState, command: f64, dt_s: f64) -> f64 {
        let arrived = state.commands.step(command.clamp(-1.0, 1.0), self.delay.delay_s, dt_s);
        let pull = state.pull.step(arrived, self.lag.time_constant_s, dt_s);
        state.spool = self.hysteresis.spool(state.spool, pull);
        state.spool
    }

    /// Extending speed that the oil through the spool gives a cylinder under `load_n`, m/s, while
    /// the pump delivers what is asked.
    #[must_use]
    pub fn speed_m_s(&self, spool: f64, load_n: f64) -> f64 {
        let opening = self.deadband.opening(spool);
        let scale = self.gain.factor
            * self.asymmetry.factor(opening)
            * self.load_dependence.factor(opening, load_n / self.area_bore_m2);
        opening * self.speed_full_m_s * scale
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_spool_that_rests_off_its_command_stays_until_the_play_is_crossed() {
        let mut effects = ArmEffects::default();
        effects.hysteresis.width = 0.04;
        let valve = Valve::new(&Machine::xt28(), &effects);
        let mut state = valve.held_off(0.1, -0.5, 0.005);
        let at = [0.1, 0.105, 0.15].map(|command| valve.step(&mut state, command, 0.005));
        assert!((at[0] - 0.09).abs() < 1e-12 && at[1] == at[0], "{at:?}");
        assert!((at[2] - 0.13).abs() < 1e-12, "{at:?}");
    }

    #[test]
    fn the_nominal_valve_is_a_wire_with_a_speed() {
        let valve = Valve::new(&Machine::xt28(), &ArmEffects::default());
        let mut state = valve.held(0.0, 0.005);
        for command in [0.3, -0.123, 0.0, 1.0, 7.0] {
            let spool = valve.step(&mut state, command, 0.005);
            assert_eq!(spool, command.min(1.0));
            assert_eq!(valve.speed_m_s(spool, 55e3), spool * 0.212);
        }
    }

    #[test]
    fn a_held_valve_goes_on_as_one_that_was_stepped_for_long() {
        let mut effects = ArmEffects::default();
        effects.delay.delay_s = 0.123;
        effects.lag.time_constant_s = 0.05;
        effects.hysteresis.width = 0.04;
        let valve = Valve::new(&Machine::xt28(), &effects);
        let mut stepped = valve.held(0.0, 0.005);
        (0..1000).for_each(|_| {
            valve.step(&mut stepped, 0.2, 0.005);
        });
        let mut held = valve.held(0.2, 0.005);
        for _ in 0..100 {
            let [a, b] = [&mut stepped, &mut held].map(|s| valve.step(s, -0.1, 0.005));
            assert!((a - b).abs() < 1e-12, "{a} {b}");
        }
    }

    #[test]
    fn what_scales_the_speed_multiplies() {
        let mut effects = ArmEffects::default();
        effects.deadband.deadband = 0.05;
        effects.valve_gain.factor = 1.2;
        effects.asymmetry.contraction_factor = 1.5;
        effects.load_dependence.droop = 0.02;
        let valve = Valve::new(&Machine::xt28(), &effects);
        let hurry = (1.0 + 0.02 * 78.5e3 / 0.00785 / 8.0e5_f64).sqrt();
        let wanted_m_s = -(0.3 - 0.05) * 0.212 * 1.2 * 1.5 * hurry;
        assert!((valve.speed_m_s(-0.3, 78.5e3) - wanted_m_s).abs() < 1e-12);
    }
}
