//! `pump-flow-limit`: one pump shared by arms and steering runs short.

use crate::effects::{Block, Effect, Parameter, Slot};

/// Flow at which the pump never runs short, m³/s: above what all valves take when fully open.
const AMPLE_M3_S: f64 = 0.012;

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
    /// Share of `demand_m3_s` that the pump delivers, 0 to 1.
    ///
    /// Valves that share flow whatever their loads (the compensator behind the spool) close alike
    /// when the pump runs short: every consumer gets this share.
    #[must_use]
    pub fn share(&self, demand_m3_s: f64) -> f64 {
        let short = self.flow_m3_s < AMPLE_M3_S && demand_m3_s > self.flow_m3_s;
        if short { self.flow_m3_s / demand_m3_s } else { 1.0 }
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
        slot: Slot::Whole(|effects| &mut effects.pump_flow.flow_m3_s),
    }],
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_short_pump_is_shared_and_an_ample_one_is_not() {
        let pump = PumpFlowLimit { flow_m3_s: 0.002 };
        assert_eq!(pump.share(0.0), 1.0);
        assert_eq!(pump.share(0.002), 1.0);
        assert!((pump.share(0.005) - 0.4).abs() < 1e-12);
        assert_eq!(PumpFlowLimit::default().share(0.05), 1.0);
    }
}
