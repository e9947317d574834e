//! One arm's hydraulics, from the commanded opening to the force on the arm: valve, oil, cylinder.

use xt28_machine::{GRAVITY_M_S2, Machine};

use super::{Cylinder, CylinderForce, CylinderMotion, CylinderState, Valve, ValveState};
use crate::REFERENCE_STROKE_M;
use crate::effects::{ArmEffects, LeakageDrift, UnsupportedSag};

/// Parameters of one arm's hydraulics.
#[derive(Clone, Debug, PartialEq)]
pub struct Arm {
    valve: Valve,
    cylinder: Cylinder,
    leakage: LeakageDrift,
    sag: UnsupportedSag,
    nominal_load_n: f64,
    hanging_load_n: f64,
}

/// What one arm's hydraulics remember.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ArmState {
    /// Of the valve.
    pub valve: ValveState,
    /// Of the cylinder.
    pub cylinder: CylinderState,
}

/// What acts on one arm's hydraulics.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ArmInput {
    /// Commanded opening, -1 (retract) to 1 (extend).
    pub command: f64,
    /// Force of the oil, N; positive under weight.
    pub load_n: f64,
    /// How the cylinder moves.
    pub motion: CylinderMotion,
}

impl Arm {
    /// An arm of this machine.
    #[must_use]
    pub fn new(machine: &Machine, effects: &ArmEffects) -> Self {
        let m = &machine.masses;
        let hanging_kg = m.wheel_kg + m.arm_kg * machine.vehicle.arm_com_share;
        let per_kg_n = GRAVITY_M_S2 / machine.linkage().at_stroke(REFERENCE_STROKE_M).force_ratio;
        Self {
            valve: Valve::new(machine, effects),
            cylinder: Cylinder::new(machine, effects),
            leakage: effects.leakage,
            sag: effects.sag,
            nominal_load_n: machine.mass_kg() / 6.0 * per_kg_n,
            hanging_load_n: hanging_kg * per_kg_n,
        }
    }

    /// The arm with its valve closed, carrying `load_n` at rest at `stroke_m`, to be stepped every
    /// `dt_s` s.
    #[must_use]
    pub fn settled(&self, stroke_m: f64, load_n: f64, dt_s: f64) -> ArmState {
        let motion = CylinderMotion { stroke_m, stroke_rate_m_s: 0.0 };
        self.resumed(&ArmInput { command: 0.0, load_n, motion }, dt_s)
    }

    /// The arm taken up in the middle of what was measured: its oil makes the load of this motion,
    /// its valve has stood under the command for long, its seals are slack.
    #[must_use]
    pub fn resumed(&self, input: &ArmInput, dt_s: f64) -> ArmState {
        ArmState {
            valve: self.valve.held(input.command, dt_s),
            cylinder: self.cylinder.carrying(input.load_n, &input.motion),
        }
    }

    /// The same with a spool that rests `share` of half its play, -1 to 1, off the command.
    #[must_use]
    pub fn resumed_off(&self, input: &ArmInput, share: f64, dt_s: f64) -> ArmState {
        let valve = self.valve.held_off(input.command, share, dt_s);
        ArmState { valve, ..self.resumed(input, dt_s) }
    }

    /// Lets the oil carry `load_n` in this motion; valve and seals stay as they are.
    pub(crate) fn refill(&self, state: &mut ArmState, load_n: f64, motion: &CylinderMotion) {
        state.cylinder.rest_m = self.rest_m(load_n, motion);
    }

    /// First half of a step: moves the spool; gives the extending speed that it asks for, m/s.
    pub fn open(&self, state: &mut ArmState, input: &ArmInput, dt_s: f64) -> f64 {
        let spool = self.valve.step(&mut state.valve, input.command, dt_s);
        self.valve.speed_m_s(spool, input.load_n)
    }

    /// Second half of a step: oil comes in for `speed_m_s` and leaks; gives the force on the arm.
    pub fn fill(
        &self,
        state: &mut ArmState,
        input: &ArmInput,
        speed_m_s: f64,
        dt_s: f64,
    ) -> CylinderForce {
        let speed_m_s = speed_m_s + self.creep_m_s(input.load_n);
        state.cylinder = self.cylinder.step(state.cylinder, &input.motion, speed_m_s, dt_s);
        self.cylinder.force(state.cylinder, &input.motion, dt_s)
    }

    /// As [`Self::fill`], of an arm whose load is measured, so that one sees its relief valve shut.
    pub fn fill_shut(&self, state: &mut ArmState, input: &ArmInput, speed_m_s: f64, dt_s: f64) {
        let speed_m_s = speed_m_s + self.creep_m_s(input.load_n);
        let rate_m_s = input.motion.stroke_rate_m_s;
        state.cylinder = self.cylinder.step_shut(state.cylinder, rate_m_s, speed_m_s, dt_s);
    }

    /// Speed at which oil finds another way than through the valve, extending > 0, m/s.
    fn creep_m_s(&self, load_n: f64) -> f64 {
        self.leakage.speed_m_s(load_n, self.nominal_load_n)
            + self.sag.speed_m_s(load_n, self.hanging_load_n)
    }

    /// A whole step of an arm alone, which gets `flow_share` of the oil it asks for.
    pub fn step(
        &self,
        state: &mut ArmState,
        input: &ArmInput,
        flow_share: f64,
        dt_s: f64,
    ) -> CylinderForce {
        let speed_m_s = self.open(state, input, dt_s);
        self.fill(state, input, flow_share * speed_m_s, dt_s)
    }

    /// Stroke at which the oil makes no force, m, where it carries `load_n` in this motion.
    #[must_use]
    pub fn rest_m(&self, load_n: f64, motion: &CylinderMotion) -> f64 {
        self.cylinder.carrying(load_n, motion).rest_m
    }

    /// Force of the oil in this motion, N; positive under weight.
    #[must_use]
    pub fn oil_force_n(&self, state: &ArmState, motion: &CylinderMotion) -> f64 {
        self.cylinder.oil_force_n(state.cylinder, motion)
    }

    /// Pressures of chambers A (bore) and B (rod), Pa, that make `oil_force_n`.
    #[must_use]
    pub fn pressures_pa(&self, oil_force_n: f64) -> [f64; 2] {
        self.cylinder.pressures_pa(oil_force_n)
    }
}
