//! The load-sensing pump that arms and steering share: oil for all, or the same share for each.

use xt28_machine::Machine;

use crate::effects::PumpFlowLimit;

/// Oil that cylinders and joints take for their speeds, and how much of it the pump delivers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlowSharing {
    /// The most that the pump delivers, m³/s; `None` where it never runs short.
    limit_m3_s: Option<f64>,
    area_bore_m2: f64,
    area_rod_m2: f64,
    joint_m3_rad: f64,
}

impl FlowSharing {
    /// The pump of this machine. Nominal: it always delivers enough (paper 3.2).
    #[must_use]
    pub const fn new(machine: &Machine, pump: PumpFlowLimit) -> Self {
        Self {
            limit_m3_s: pump.on(machine),
            area_bore_m2: machine.arms.area_bore_m2,
            area_rod_m2: machine.arms.area_rod_m2,
            joint_m3_rad: Self::joint_m3_rad(machine),
        }
    }

    /// Oil that the cylinders of a joint take for its turning, m³/rad.
    pub(crate) const fn joint_m3_rad(machine: &Machine) -> f64 {
        // Assumed: the pressure that gives a cylinder its largest force gives a joint its torque.
        let pressure_max_pa = machine.arms.force_max_n / machine.arms.area_bore_m2;
        machine.articulation.torque_max_nm / pressure_max_pa
    }

    /// Flow into a cylinder that extends at `speed_m_s`, or into its rod side where negative, m³/s.
    #[must_use]
    pub fn cylinder_m3_s(&self, speed_m_s: f64) -> f64 {
        if speed_m_s < 0.0 { -speed_m_s * self.area_rod_m2 } else { speed_m_s * self.area_bore_m2 }
    }

    /// Flow into the cylinders of a joint that turns at `rate_rad_s`, m³/s.
    #[must_use]
    pub fn joint_m3_s(&self, rate_rad_s: f64) -> f64 {
        rate_rad_s.abs() * self.joint_m3_rad
    }

    /// Share of its speed that every consumer gets while `demand_m3_s` is asked, 0 to 1.
    #[must_use]
    pub fn share(&self, demand_m3_s: f64) -> f64 {
        PumpFlowLimit::share(self.limit_m3_s, demand_m3_s)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_full_valve_takes_a_hundred_litres_a_minute() {
        let machine = Machine::xt28();
        let flow = FlowSharing::new(&machine, PumpFlowLimit::default());
        let full_m3_s = flow.cylinder_m3_s(machine.hydraulics.speed_full_m_s);
        assert!((full_m3_s / machine.hydraulics.flow_full_m3_s - 1.0).abs() < 2e-3, "{full_m3_s}");
        let back = flow.cylinder_m3_s(-0.1) / flow.cylinder_m3_s(0.1);
        assert!((back - 0.00589 / 0.00785).abs() < 1e-12);
    }

    #[test]
    fn the_nominal_pump_feeds_everything_fully_open() {
        let machine = Machine::xt28();
        let flow = FlowSharing::new(&machine, PumpFlowLimit::default());
        let rate_rad_s = machine.articulation.rate_max_deg_s.to_radians();
        let all_m3_s = 6.0 * flow.cylinder_m3_s(machine.hydraulics.speed_full_m_s)
            + 2.0 * flow.joint_m3_s(rate_rad_s);
        let least = PumpFlowLimit { flow_m3_s: PumpFlowLimit::default().flow_m3_s * (1.0 - 1e-9) };
        assert_eq!(flow.share(all_m3_s), 1.0);
        assert_eq!(FlowSharing::new(&machine, least).share(all_m3_s), 1.0);
    }

    /// Both ends of the balance: what is delivered is what the pump gives.
    #[test]
    fn a_short_pump_delivers_all_it_has() {
        let machine = Machine::xt28();
        let flow = FlowSharing::new(&machine, PumpFlowLimit { flow_m3_s: 0.001 });
        let speeds_m_s = [0.06, 0.06, -0.04, -0.05, 0.02, 0.01];
        let demand_m3_s: f64 = speeds_m_s.map(|v| flow.cylinder_m3_s(v)).iter().sum();
        let share = flow.share(demand_m3_s);
        let given_m3_s: f64 = speeds_m_s.map(|v| flow.cylinder_m3_s(share * v)).iter().sum();
        assert!(share < 1.0 && (given_m3_s - 0.001).abs() < 1e-15);
    }
}
