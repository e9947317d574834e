//! A test rig: one arm's hydraulics under a mass that slides along the cylinder, without a vehicle.

use xt28_machine::Machine;
use xt28_sim::{Arm, ArmInput, ArmState, CylinderMotion, Effects, FlowSharing};

/// Step of the rig, s.
pub(crate) const DT_S: f64 = 0.005;

/// The front right arm of a machine, its pump, and what rests on its rod.
pub(crate) struct ArmRig {
    pub(crate) arm: Arm,
    pub(crate) state: ArmState,
    pub(crate) motion: CylinderMotion,
    pub(crate) mass_kg: f64,
    flow: FlowSharing,
}

impl ArmRig {
    /// At rest at `stroke_m` under `load_n`.
    pub(crate) fn new(effects: &Effects, mass_kg: f64, stroke_m: f64, load_n: f64) -> Self {
        let machine = Machine::xt28();
        let arm = Arm::new(&machine, &effects.arms.0[0]);
        Self {
            state: arm.settled(stroke_m, load_n, DT_S),
            arm,
            motion: CylinderMotion { stroke_m, stroke_rate_m_s: 0.0 },
            mass_kg,
            flow: FlowSharing::new(&machine, effects.pump_flow),
        }
    }

    /// A step under a commanded opening and an outer load; the cylinder's law taken implicitly, as
    /// a solver of the vehicle takes it.
    pub(crate) fn step(&mut self, command: f64, load_n: f64) {
        let input = ArmInput { command, load_n: self.oil_force_n(), motion: self.motion };
        let speed_m_s = self.arm.open(&mut self.state, &input, DT_S);
        let share = self.flow.share(self.flow.cylinder_m3_s(speed_m_s));
        let force = self.arm.fill(&mut self.state, &input, share * speed_m_s, DT_S);
        let push_n = force.force_n - load_n - force.stiffness_n_m * self.rate_m_s() * DT_S;
        let heavy_kg = self.mass_kg + DT_S * (force.damping_n_s_m + DT_S * force.stiffness_n_m);
        self.motion.stroke_rate_m_s += DT_S * push_n / heavy_kg;
        self.motion.stroke_m += DT_S * self.rate_m_s();
    }

    pub(crate) fn rate_m_s(&self) -> f64 {
        self.motion.stroke_rate_m_s
    }

    pub(crate) fn oil_force_n(&self) -> f64 {
        self.arm.oil_force_n(&self.state, &self.motion)
    }
}
