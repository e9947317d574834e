//! Steering: a PI in degrees for each joint, the rear one after the front one.

use xt28_machine::Articulation;

use super::TICK_S;
use crate::truth::EcuTruth;

/// Limit of the error's integral, deg s.
const LIMIT_DEG_S: f64 = 40.0;

/// Both joints' controllers.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Steering {
    sum_deg_s: [f64; 2],
    followed_deg: f64,
}

impl Steering {
    /// One tick; openings of the front and the rear valve, left > 0.
    pub(super) fn step(
        &mut self,
        law: &Articulation,
        truth: &EcuTruth,
        target_deg: f64,
        joint_deg: [f64; 2],
        speed_m_s: f64,
    ) -> [f64; 2] {
        let keep = (-TICK_S / truth.rear_filter_s.max(1e-9)).exp();
        self.followed_deg = joint_deg[0] + keep * (self.followed_deg - joint_deg[0]);
        if speed_m_s.abs() <= law.speed_threshold_m_s {
            self.sum_deg_s = [0.0; 2];
            return [0.0; 2];
        }
        let rear_deg = law.rear_ratio * truth.rear_ratio * self.followed_deg;
        let error = [target_deg - joint_deg[0], rear_deg - joint_deg[1]];
        core::array::from_fn(|i| {
            let sum = self.sum_deg_s[i] + error[i] * TICK_S;
            self.sum_deg_s[i] = sum.clamp(-LIMIT_DEG_S, LIMIT_DEG_S);
            let integral = truth.steer_ki * law.ki_per_s * self.sum_deg_s[i];
            (truth.steer_kp * law.kp_per_deg * (error[i] + integral)).clamp(-1.0, 1.0)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::truth::Truth;

    #[test]
    fn it_holds_at_a_stand_and_steers_both_joints_on_the_move() {
        let truth = Truth::nominal();
        let (law, ecu) = (&truth.machine.articulation, &truth.ecu);
        let mut steering = Steering::default();
        assert_eq!(steering.step(law, ecu, 10.0, [0.0; 2], 0.05), [0.0; 2]);
        let [front, rear] = steering.step(law, ecu, 10.0, [5.0, 0.0], 0.5);
        assert!((front - 0.025 * (5.0 + 0.2 * 0.05)).abs() < 1e-12);
        assert!((rear - 0.025 * (2.8 + 0.2 * 0.028)).abs() < 1e-12);
    }

    #[test]
    fn a_filtered_follower_is_late() {
        let truth = Truth::nominal();
        let ecu = EcuTruth { rear_filter_s: 1.0, ..truth.ecu };
        let mut steering = Steering::default();
        let [_, rear] = steering.step(&truth.machine.articulation, &ecu, 10.0, [10.0, 0.0], 0.5);
        assert!(rear < 0.01 * 0.025 * 5.6 * 2.0, "{rear}");
    }
}
