//! The pump that arms and steering share, on measured inputs: what it gives of what all valves ask.

use xt28_machine::{Machine, PerWheel, Wheel};
use xt28_sim::effects::PumpFlowLimit;
use xt28_sim::{Effects, FlowSharing, Steering};

use super::arm_drive::ArmDrive;
use crate::diagnosis::signals::{DT_S, Samples, Signals};

/// Share of its speed that every consumer gets, 0 to 1, by sample; none for a pump that never runs
/// short.
pub(super) fn flow_share(signals: &Signals, machine: &Machine, effects: &Effects) -> Samples {
    if effects.pump_flow == PumpFlowLimit::default() {
        return Samples::new();
    }
    let flow = FlowSharing::new(machine, effects.pump_flow);
    let steering = Steering::new(machine, &effects.steering);
    let mut joints = [steering.straight(DT_S), steering.straight(DT_S)];
    let asked = |w| ArmDrive::new(signals, machine, effects, w).speeds_asked_m_s();
    let arms = PerWheel::from_fn(asked);
    let share = |i: usize| {
        let arms_m3_s: f64 = Wheel::ALL.iter().map(|&w| flow.cylinder_m3_s(arms[w][i])).sum();
        let joint = |j: usize| {
            let opening = signals.steer_opening[j][i];
            flow.joint_m3_s(steering.open(&mut joints[j], opening, DT_S))
        };
        let joints_m3_s: f64 = [0, 1].map(joint).iter().sum();
        flow.share(arms_m3_s + joints_m3_s)
    };
    (0..signals.len).map(share).collect()
}
