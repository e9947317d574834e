//! `pump-flow-limit`: one pump shared by arms and steering runs short.

use xt28_machine::Machine;

use crate::FlowSharing;
use crate::effects::{Block, Effect, Parameter, Slot};

/// Stands for a pump that never runs short, whatever the machine's valves take: beside `valve-gain` above
/// some 1.2, valves take more than this many m³/s, and a pump just below it begins with that much of a step.
const AMPLE_M3_S: f64 = 0.012;
/// What such a pump delivers at the least over what all valves of a machine take (assumed).
const AMPLE_FACTOR: f64 = 1.1;

/// The most that the load-sensing pump delivers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PumpFlowLimit {
    /// Largest flow, m³/s.
    pub flow_m3_s: f64,
}

impl Default for PumpFlowLimit {
    fn default() -> Self {
        Self { flow_m3_s: AMPLE_M3_S }
    }
}

impl PumpFlowLimit {
    /// Where limits begin on this machine: above what six arms and both joints take at once.
    #[must_use]
    pub(in crate::effects) const fn least_ample_on(machine: &Machine) -> Self {
        let joint_rad_s = machine.articulation.rate_max_deg_s.to_radians();
        let joint_m3_s = joint_rad_s * FlowSharing::joint_m3_rad(machine);
        let all_m3_s = 6.0 * machine.hydraulics.flow_full_m3_s + 2.0 * joint_m3_s;
        Self { flow_m3_s: AMPLE_M3_S.max(AMPLE_FACTOR * all_m3_s) }
    }

    /// The most that it delivers on this machine, m³/s; `None` of a pump that never runs short. One that
    /// has just what limits begin with is none yet: nobody has set it.
    #[must_use]
    pub const fn on(self, machine: &Machine) -> Option<f64> {
        let is_ample = self.flow_m3_s == AMPLE_M3_S
            || self.flow_m3_s >= Self::least_ample_on(machine).flow_m3_s;
        if is_ample { None } else { Some(self.flow_m3_s) }
    }

    /// Share of `demand_m3_s` that a pump with this limit delivers, 0 to 1.
    ///
    /// Valves that share flow whatever their loads (the compensator behind the spool) close alike
    /// when the pump runs short: every consumer gets this share.
    #[must_use]
    pub fn share(limit_m3_s: Option<f64>, demand_m3_s: f64) -> f64 {
        let short = limit_m3_s.filter(|limit_m3_s| demand_m3_s > *limit_m3_s);
        short.map_or(1.0, |limit_m3_s| limit_m3_s / demand_m3_s)
    }
}

/// Six arms at 30 % take 180 L/min, which is what a pump of 150 cm³ gives at 1200 rpm.
pub(in crate::effects) const EFFECT: Effect = Effect {
    name: "pump-flow-limit",
    block: Block::Arms,
    meaning: "one pump shared by arms and steering runs short",
    source: "flow sharing as in load-sensing systems with downstream compensators; pump size assumed",
    parameters: &[Parameter {
        name: "flow_m3_s",
        neutral: AMPLE_M3_S,
        tolerance: 0.004,
        range: [0.000_3, AMPLE_M3_S],
        acts_alone: true,
        slot: Slot::Whole(|effects| &mut effects.pump_flow.flow_m3_s),
    }],
};

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::effects::{Effects, Overlay, find};

    #[test]
    fn a_short_pump_is_shared_and_an_ample_one_is_not() {
        let machine = Machine::xt28();
        let pump = PumpFlowLimit { flow_m3_s: 0.002 }.on(&machine);
        assert_eq!(PumpFlowLimit::share(pump, 0.0), 1.0);
        assert_eq!(PumpFlowLimit::share(pump, 0.002), 1.0);
        assert!((PumpFlowLimit::share(pump, 0.005) - 0.4).abs() < 1e-12);
        let ample = PumpFlowLimit::default().on(&machine);
        assert_eq!((ample, PumpFlowLimit::share(ample, 0.05)), (None, 1.0));
    }

    /// Neither no effect nor where limits begin is one, so that larger valves get what they take.
    #[test]
    fn a_pump_that_nobody_limits_is_ample_on_any_machine() {
        let mut machine = Machine::xt28();
        for _ in 0..3 {
            for pump in [Effects::none_on(&machine).pump_flow, PumpFlowLimit::default()] {
                assert_eq!(pump.on(&machine), None);
                assert_eq!(FlowSharing::new(&machine, pump).share(1.0), 1.0);
            }
            let [own] = find("pump-flow-limit").unwrap().on(&machine).parameters else { panic!() };
            assert_eq!(PumpFlowLimit { flow_m3_s: own.neutral }.on(&machine), None);
            machine.hydraulics.flow_full_m3_s *= 2.0;
            machine.arms.area_bore_m2 *= 2.0;
        }
    }

    /// The pump of a machine with valves twice as large runs short where theirs begin to, not at a jump.
    #[test]
    fn a_larger_machines_pump_runs_short_from_what_its_valves_take() {
        let mut machine = Machine::xt28();
        machine.hydraulics.flow_full_m3_s *= 2.0;
        machine.arms.area_bore_m2 *= 2.0;
        let share = |severity: f64| {
            let text = "[[effect]]\nname = \"pump-flow-limit\"\nflow_m3_s = 0.001\nseverity =";
            let overlay = Overlay::parse(&format!("{text} {severity}"), Path::new("o.toml"));
            let pump = overlay.unwrap().effects(&machine).unwrap().pump_flow;
            FlowSharing::new(&machine, pump).share(6.0 * machine.hydraulics.flow_full_m3_s)
        };
        assert_eq!([share(0.0), share(1e-6)], [1.0, 1.0]);
        assert!((share(1.0) - 0.05).abs() < 1e-4, "{}", share(1.0));
        let half_m3_s = 0.5 * (PumpFlowLimit::least_ample_on(&machine).flow_m3_s + 0.001);
        assert!((share(0.5) - half_m3_s / 0.02).abs() < 1e-4, "{}", share(0.5));
    }
}
