//! The pump that arms and steering share, on measured inputs: what it gives of what all valves ask.

use xt28_machine::{Machine, PerWheel, Wheel};
use xt28_sim::effects::PumpFlowLimit;
use xt28_sim::{Effects, FlowSharing, Steering};

use super::arm_drive::ArmDrive;
use crate::diagnosis::signals::{DT_S, Samples, Signals};

/// What a pump has to give. Machines differ in it, and no log says it: steering may have a pump of its own, and a
/// cylinder that retracts may be counted by what it lets go instead of what it takes.
struct Law {
    steers: bool,
    counts_by_bore: bool,
}

/// The laws that there may be, ours first.
const LAWS: [Law; 4] = [
    Law { steers: true, counts_by_bore: false },
    Law { steers: true, counts_by_bore: true },
    Law { steers: false, counts_by_bore: false },
    Law { steers: false, counts_by_bore: true },
];

/// Share of its speed that every consumer gets, 0 to 1, by sample, under each law of what a pump has to give; one
/// without samples for a pump that never runs short.
pub(super) fn flow_shares(signals: &Signals, machine: &Machine, effects: &Effects) -> Vec<Samples> {
    if effects.pump_flow == PumpFlowLimit::default() {
        return vec![Samples::new()];
    }
    let flow = FlowSharing::new(machine, effects.pump_flow);
    let asked = |w| ArmDrive::new(signals, machine, effects, w).speeds_asked_m_s(None);
    let arms_m_s = PerWheel::from_fn(asked);
    let joints_m3_s = joints_m3_s(signals, machine, effects, &flow);
    let under = |law: &Law| {
        let share = |i: usize| {
            let arm_m3_s = |w: Wheel| {
                let m_s = arms_m_s[w][i];
                flow.cylinder_m3_s(if law.counts_by_bore { m_s.abs() } else { m_s })
            };
            let steers_m3_s = if law.steers { joints_m3_s[i] } else { 0.0 };
            flow.share(Wheel::ALL.into_iter().map(arm_m3_s).sum::<f64>() + steers_m3_s)
        };
        (0..signals.len).map(share).collect()
    };
    LAWS.iter().map(under).collect()
}

/// What both joints ask, m³/s, by sample.
fn joints_m3_s(
    signals: &Signals,
    machine: &Machine,
    effects: &Effects,
    flow: &FlowSharing,
) -> Samples {
    let steering = Steering::both(machine, &effects.steering);
    let mut joints = steering.each_ref().map(|joint| joint.straight(DT_S));
    let asked = |i: usize| {
        let joint = |j: usize| {
            let opening = signals.steer_opening[j][i];
            flow.joint_m3_s(steering[j].open(&mut joints[j], opening, DT_S))
        };
        [0, 1].map(joint).iter().sum()
    };
    (0..signals.len).map(asked).collect()
}

#[cfg(test)]
mod tests {
    use super::super::still::still;
    use super::*;

    #[test]
    fn what_else_a_pump_feeds_leaves_less_for_the_arms() {
        let (machine, mut s, mut effects) = (Machine::xt28(), still(10), Effects::default());
        for w in Wheel::ALL {
            s.opening[w].fill(if w == Wheel::Fl { 0.5 } else { -0.5 });
        }
        s.steer_opening[0].fill(0.8);
        assert!(flow_shares(&s, &machine, &effects)[0].is_empty());
        effects.pump_flow.flow_m3_s = 1.0e-3;
        let [ours, by_bore, no_joints, neither] =
            flow_shares(&s, &machine, &effects).try_into().unwrap();
        let last = s.len - 1;
        assert!(neither[last] < no_joints[last] && by_bore[last] < ours[last]);
        assert!(by_bore[last] < neither[last] && neither[last] < 1.0, "{by_bore:?}");
    }
}
