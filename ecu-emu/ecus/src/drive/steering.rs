//! Steering: a PI per joint, the rear one towards a share of the front one.

use xt28_machine::Articulation;

use crate::life::PERIOD_S;

/// Limit of the error integral, deg s: 20 % of full opening with the nominal gains. No public source has
/// one; the logged machine's currents do not fit another (`docs/second-opinion.md`).
const WINDUP_DEG_S: f64 = 40.0;

/// The controller of one joint: opening = kp (e + ki * integral of e). The gains multiply: read as
/// parallel ones they would leave the joint at a damping ratio of 0.09.
#[derive(Clone, Copy, Debug, Default)]
struct JointControl {
    integral_deg_s: f64,
}

impl JointControl {
    fn step(&mut self, gains: &SteeringGains, error_deg: f64) -> f64 {
        let integral_deg_s = self.integral_deg_s + error_deg * PERIOD_S;
        self.integral_deg_s = integral_deg_s.clamp(-WINDUP_DEG_S, WINDUP_DEG_S);
        let opening = gains.kp_per_deg * (error_deg + gains.ki_per_s * self.integral_deg_s);
        opening.clamp(-1.0, 1.0)
    }
}

/// Gains and thresholds of the steering (paper 2.2; facts 6.1).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SteeringGains {
    /// Valve opening per angle error, 1/deg.
    pub kp_per_deg: f64,
    /// What the error's integral counts against the error, 1/s.
    pub ki_per_s: f64,
    /// Where the rear joint should be, as a share of where the front one is.
    pub rear_ratio: f64,
    /// Time constant of a filter on the front angle that the rear joint follows, s; 0 for none.
    pub rear_time_constant_s: f64,
    /// Up to this speed the joints hold, m/s.
    pub speed_threshold_m_s: f64,
}

impl SteeringGains {
    /// The machine's own.
    #[must_use]
    pub const fn new(articulation: &Articulation) -> Self {
        Self {
            kp_per_deg: articulation.kp_per_deg,
            ki_per_s: articulation.ki_per_s,
            rear_ratio: articulation.rear_ratio,
            rear_time_constant_s: 0.0,
            speed_threshold_m_s: articulation.speed_threshold_m_s,
        }
    }
}

/// Steering of both joints.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Steering {
    gains: SteeringGains,
    front: JointControl,
    rear: JointControl,
    /// The front angle as the rear joint follows it; none before the first tick.
    followed_deg: Option<f64>,
}

impl Steering {
    pub(crate) fn new(articulation: &Articulation) -> Self {
        let gains = SteeringGains::new(articulation);
        Self {
            gains,
            front: JointControl::default(),
            rear: JointControl::default(),
            followed_deg: None,
        }
    }

    /// The gains in force.
    pub(crate) const fn gains(&self) -> SteeringGains {
        self.gains
    }

    /// Takes other gains; what the integrals hold stays.
    pub(crate) const fn set_gains(&mut self, gains: SteeringGains) {
        self.gains = gains;
    }

    /// Openings of the front and the rear valve, left > 0, for joints at `front_deg` and `rear_deg`
    /// with the front one to go to `target_deg`. Not above the threshold speed in either direction,
    /// the valves stay closed: a joint that turns at a stand grinds its wheels into the ground.
    pub(crate) fn step(
        &mut self,
        target_deg: f64,
        [front_deg, rear_deg]: [f64; 2],
        speed_m_s: f64,
    ) -> [f64; 2] {
        let followed_deg = self.follow(front_deg);
        if speed_m_s.abs() <= self.gains.speed_threshold_m_s {
            return self.hold();
        }
        let front_error_deg = target_deg - front_deg;
        let rear_error_deg = self.gains.rear_ratio * followed_deg - rear_deg;
        [self.front.step(&self.gains, front_error_deg), self.rear.step(&self.gains, rear_error_deg)]
    }

    fn follow(&mut self, front_deg: f64) -> f64 {
        let before_deg = self.followed_deg.unwrap_or(front_deg);
        let time_constant_s = self.gains.rear_time_constant_s;
        let followed_deg = if time_constant_s > 0.0 {
            front_deg + (before_deg - front_deg) * (-PERIOD_S / time_constant_s).exp()
        } else {
            front_deg
        };
        self.followed_deg = Some(followed_deg);
        followed_deg
    }

    /// Closed valves, and both integrals forgotten.
    pub(crate) fn hold(&mut self) -> [f64; 2] {
        self.front = JointControl::default();
        self.rear = JointControl::default();
        [0.0; 2]
    }
}

#[cfg(test)]
mod tests {
    use xt28_machine::Machine;

    use super::*;

    fn steering() -> Steering {
        Steering::new(&Machine::xt28().articulation)
    }

    #[test]
    fn the_gains_multiply_and_the_rear_follows_at_56_percent() {
        let [front, rear] = steering().step(12.0, [10.0, 5.0], 0.5);
        assert!((front - 0.025 * (2.0 + 0.2 * 0.02)).abs() < 1e-15, "{front}");
        assert!((rear - 0.025 * (0.6 + 0.2 * 0.006)).abs() < 1e-15, "{rear}");
    }

    #[test]
    fn below_the_threshold_nothing_turns_and_nothing_winds_up() {
        let mut steering = steering();
        for _ in 0..1000 {
            steering.step(25.0, [0.0; 2], 1.0);
        }
        assert_eq!(steering.step(25.0, [0.0; 2], 0.0833), [0.0; 2]);
        let [front, _] = steering.step(0.0, [0.0; 2], -0.09);
        assert_eq!(front, 0.0, "the integral was reset");
    }

    #[test]
    fn a_filter_lets_the_rear_follow_late() {
        let mut late = steering();
        let gains = SteeringGains { rear_time_constant_s: 0.5, ..late.gains };
        late.set_gains(gains);
        late.step(0.0, [0.0; 2], 0.5);
        let rear: Vec<f64> = (0..51).map(|_| late.step(10.0, [10.0, 0.0], 0.5)[1]).collect();
        let prompt = steering().step(10.0, [10.0, 0.0], 0.5)[1];
        assert!(rear[0] < 0.03 * prompt, "{}", rear[0]);
        assert!((late.followed_deg.unwrap() - 10.0 * (1.0 - (-1.02_f64).exp())).abs() < 1e-9);
    }

    #[test]
    fn openings_and_integrals_are_bounded() {
        let mut steering = steering();
        for _ in 0..10_000 {
            let openings = steering.step(25.0, [-25.0, 25.0], 1.0);
            assert!(openings.iter().all(|o| o.abs() <= 1.0), "{openings:?}");
        }
        let [front, _] = steering.step(0.0, [0.0; 2], 1.0);
        assert!((front - 0.025 * 0.2 * 40.0).abs() < 1e-12, "{front}");
    }
}
