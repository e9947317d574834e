//! An articulation joint: oil shut in behind a spool turns it, pins with clearance pass it on.

use xt28_machine::Machine;
use xt28_sim::{HingeMotion, HingeSpring};

use crate::history::History;
use crate::hydraulics::spool::Spool;
use crate::truth::SteeringTruth;

/// Oil drawn by a joint, m³/rad (assumed: two cylinders of 0.12 m bore at a lever of 0.25 m).
const OIL_M3_RAD: f64 = 0.0057;
/// Time in which the relief valves bring an overloaded joint's oil back to their setting, s.
const RELIEF_S: f64 = 0.004;
/// Share of the damping that is left while a pin crosses its clearance (bearing friction).
const LOOSE_DAMPING: f64 = 0.05;

/// What a joint remembers.
#[derive(Clone, Debug)]
pub(crate) struct Joint {
    commands: History,
    pilot: f64,
    spool: Spool,
    /// Angle at which the oil holds the joint without torque, rad.
    oil_rad: f64,
}

impl Joint {
    /// Straight, stepped every `dt_s` s.
    pub(crate) fn straight(dt_s: f64) -> Self {
        let commands = History::new(dt_s, 0.0);
        Self { commands, pilot: 0.0, spool: Spool::default(), oil_rad: 0.0 }
    }

    /// Moves pilot and spool; rate at the pump's full margin, rad/s, and oil for it, m³/s.
    pub(crate) fn open(
        &mut self,
        truth: &SteeringTruth,
        machine: &Machine,
        command: f64,
        dt_s: f64,
    ) -> [f64; 2] {
        self.commands.note(command);
        let arrived = self.commands.back(truth.delay_s);
        let keep = ((truth.pilot_s - 0.5 * dt_s) / (truth.pilot_s + 0.5 * dt_s)).max(0.0);
        self.pilot = arrived + keep * (self.pilot - arrived);
        let opening = self.spool.step(&truth.spool, self.pilot, dt_s);
        let rate = opening * truth.flow * machine.articulation.rate_max_deg_s.to_radians();
        [rate, rate.abs() * OIL_M3_RAD]
    }

    /// Turns the oil at `rate_rad_s` over `dt_s` s; what it then does to the joint.
    pub(crate) fn turn(
        &mut self,
        truth: &SteeringTruth,
        machine: &Machine,
        joint: HingeMotion,
        rate_rad_s: f64,
        dt_s: f64,
    ) -> HingeSpring {
        let stop = machine.articulation.angle_max_deg.to_radians();
        self.oil_rad += (rate_rad_s + truth.creep_rad_s) * dt_s;
        self.oil_rad = self.oil_rad.clamp(-stop, stop);
        let half = 0.5 * truth.clearance_rad;
        let reach = half + machine.articulation.torque_max_nm / truth.stiffness_nm;
        let angle = joint.angle_rad + joint.rate_rad_s * dt_s;
        let within = self.oil_rad.clamp(angle - reach, angle + reach);
        self.oil_rad = within + (self.oil_rad - within) * (-dt_s / RELIEF_S).exp();
        // The pin lies against one side of its hole, or against none.
        let gap = self.oil_rad - joint.angle_rad;
        if gap.abs() < half {
            let damping_nms = LOOSE_DAMPING * truth.damping_nms;
            return HingeSpring { stiffness_nm: 0.0, damping_nms, rest_rad: joint.angle_rad };
        }
        HingeSpring {
            stiffness_nm: truth.stiffness_nm,
            damping_nms: truth.damping_nms,
            rest_rad: self.oil_rad - half * gap.signum(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::truth::Truth;

    const DT_S: f64 = 0.002;

    fn oil_after(change: impl Fn(&mut SteeringTruth), seconds: f64, command: f64) -> Joint {
        let mut truth = Truth::nominal();
        change(&mut truth.steering);
        let mut joint = Joint::straight(DT_S);
        let mut at = HingeMotion::default();
        let mut time_s = 0.0;
        while time_s < seconds {
            let (law, machine) = (&truth.steering, &truth.machine);
            let [rate, _] = joint.open(law, machine, command, DT_S);
            joint.turn(law, machine, at, rate, DT_S);
            at.angle_rad = joint.oil_rad;
            time_s += DT_S;
        }
        joint
    }

    #[test]
    fn full_valve_turns_ten_degrees_a_second_up_to_the_stop() {
        let turned = oil_after(|_| (), 1.0, 1.0).oil_rad.to_degrees();
        assert!((turned - 9.9).abs() < 0.05, "{turned}");
        assert!((oil_after(|_| (), 4.0, -1.0).oil_rad.to_degrees() + 25.0).abs() < 1e-9);
        let slow = oil_after(|s| s.flow = 0.5, 1.0, 1.0).oil_rad.to_degrees();
        assert!((slow - turned / 2.0).abs() < 0.05);
    }

    #[test]
    fn delay_and_creep_do_as_they_say() {
        assert_eq!(oil_after(|s| s.delay_s = 0.3, 0.29, 1.0).oil_rad, 0.0);
        assert!((oil_after(|s| s.creep_rad_s = 0.01, 1.0, 0.0).oil_rad - 0.01).abs() < 1e-4);
    }

    #[test]
    fn clearance_lets_go_and_relief_bounds_the_torque() {
        let truth = Truth::nominal();
        let loose = SteeringTruth { clearance_rad: 0.04, ..truth.steering };
        let mut joint = Joint::straight(DT_S);
        let at = |angle_rad| HingeMotion { angle_rad, rate_rad_s: 0.0 };
        let mut torque = |law: &SteeringTruth, angle_rad: f64, oil_rad: f64| {
            joint.oil_rad = oil_rad;
            let spring = joint.turn(law, &truth.machine, at(angle_rad), 0.0, DT_S);
            spring.stiffness_nm * (spring.rest_rad - angle_rad)
        };
        assert_eq!(torque(&loose, 0.0, 0.019), 0.0);
        assert!((torque(&loose, 0.0, 0.03) - 0.01 * loose.stiffness_nm).abs() < 1.0);
        assert!((torque(&truth.steering, 0.0, 0.01) - 0.01 * 2.5e6).abs() < 1.0);
        assert!(torque(&truth.steering, 0.0, 0.1) < 0.1 * 2.5e6 * 0.7);
    }
}
