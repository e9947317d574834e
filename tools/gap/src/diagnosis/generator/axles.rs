//! How three axles with two joints between them can move over the ground.

use xt28_machine::Machine;

/// Distances between axles and joints, front to rear, m.
pub(super) struct Axles {
    front_to_joint: f64,
    joint_to_middle: f64,
    middle_to_joint: f64,
    joint_to_rear: f64,
}

/// Velocities of the three frames at their axles.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct FrameMotion {
    /// Forward, m/s.
    pub(super) along_m_s: [f64; 3],
    /// To the left, m/s: slip of the axle.
    pub(super) side_m_s: [f64; 3],
    /// Rate of turn, left > 0, rad/s.
    pub(super) turn_rad_s: [f64; 3],
}

impl Axles {
    pub(super) fn new(machine: &Machine) -> Self {
        let (x, a) = (machine.wheels.axle_x_m, &machine.articulation);
        Self {
            front_to_joint: x[0] - a.front_joint_x_m,
            joint_to_middle: a.front_joint_x_m - x[1],
            middle_to_joint: x[1] - a.rear_joint_x_m,
            joint_to_rear: a.rear_joint_x_m - x[2],
        }
    }

    /// Torque at the front joint for a side force at the middle axle that the others hold in balance,
    /// Nm/N.
    pub(super) fn lever_m(&self) -> f64 {
        let front = self.front_to_joint + self.joint_to_middle;
        let rear = self.middle_to_joint + self.joint_to_rear;
        self.front_to_joint * rear / (front + rear)
    }

    /// Motion with joints at `angle` turning at `rate`, a front axle that goes `ahead` and slips by
    /// `side`, and a front frame that turns at `turn`.
    fn motion(
        &self,
        angle: [f64; 2],
        rate: [f64; 2],
        ahead: f64,
        [side, turn]: [f64; 2],
    ) -> FrameMotion {
        let behind = side - self.front_to_joint * turn;
        let (sin, cos) = angle[0].sin_cos();
        let (along, across) = (ahead * cos - behind * sin, ahead * sin + behind * cos);
        let middle_turn = turn - rate[0];
        let middle = across - self.joint_to_middle * middle_turn;
        let behind = middle - self.middle_to_joint * middle_turn;
        let (sin, cos) = angle[1].sin_cos();
        let rear_turn = middle_turn - rate[1];
        let rear = along * sin + behind * cos - self.joint_to_rear * rear_turn;
        FrameMotion {
            along_m_s: [ahead, along, along * cos - behind * sin],
            side_m_s: [side, middle, rear],
            turn_rad_s: [turn, middle_turn, rear_turn],
        }
    }

    /// The motion whose axles slip least sideways.
    pub(super) fn rolling(&self, angle: [f64; 2], rate: [f64; 2], ahead: f64) -> FrameMotion {
        self.rolling_under([1.0; 3], angle, rate, ahead)
    }

    /// The motion whose axles slip least sideways, each counted as much as it is pressed to the ground by
    /// `load`, in any unit; at least two of them have some.
    pub(super) fn rolling_under(
        &self,
        load: [f64; 3],
        angle: [f64; 2],
        rate: [f64; 2],
        ahead: f64,
    ) -> FrameMotion {
        let [none, by_side, by_turn] = self.slips(angle, rate, ahead);
        let dot = |a: [f64; 3], b: [f64; 3]| (0..3).map(|k| load[k] * a[k] * b[k]).sum::<f64>();
        let (ss, st, tt) = (dot(by_side, by_side), dot(by_side, by_turn), dot(by_turn, by_turn));
        let (s, t) = (-dot(by_side, none), -dot(by_turn, none));
        let determinant = ss * tt - st * st;
        let free = [(tt * s - st * t) / determinant, (ss * t - st * s) / determinant];
        self.motion(angle, rate, ahead, free)
    }

    /// What of the axles' slips no motion of the machine can take away, m/s; positive where the front
    /// joint is to be turned left.
    pub(super) fn misfit_m_s(&self, angle: [f64; 2], rate: [f64; 2], ahead: f64) -> f64 {
        let [none, by_side, by_turn] = self.slips(angle, rate, ahead);
        -pattern(by_side, by_turn).iter().zip(none).map(|(n, slip)| n * slip).sum::<f64>()
    }

    /// Side forces of the axles that are balanced in themselves, of a straight machine, their squares one together.
    pub(super) fn pattern(&self) -> [f64; 3] {
        let [_, by_side, by_turn] = self.slips([0.0; 2], [0.0; 2], 0.0);
        pattern(by_side, by_turn)
    }

    /// Slips of the axles with the front frame held, and what its slip and its turn each add.
    fn slips(&self, angle: [f64; 2], rate: [f64; 2], ahead: f64) -> [[f64; 3]; 3] {
        let at = |free| self.motion(angle, rate, ahead, free).side_m_s;
        let none = at([0.0, 0.0]);
        let less = |slips: [f64; 3]| [0, 1, 2].map(|k| slips[k] - none[k]);
        [none, less(at([1.0, 0.0])), less(at([0.0, 1.0]))]
    }
}

/// What is square to both, of length one.
fn pattern(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    let normal = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    let length = normal.iter().map(|n| n * n).sum::<f64>().sqrt();
    normal.map(|n| n / length)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axles_that_share_a_circle_do_not_scrub() {
        let axles = Axles::new(&Machine::xt28());
        assert_eq!(axles.misfit_m_s([0.0; 2], [0.0; 2], 1.0), 0.0);
        // Axles that touch one circle: a joint midway between two of them bends by both half arcs.
        let bend = |from_axle_m: f64| 2.0 * (from_axle_m / 20.0).atan();
        let misfit = |angle| axles.misfit_m_s(angle, [0.0; 2], 1.0).abs();
        let (fits, weak) = ([bend(1.85), bend(1.175)], [bend(1.85), 0.5 * bend(1.175)]);
        assert!(misfit(fits) < 0.02 * misfit(weak), "{} {}", misfit(fits), misfit(weak));
        let motion = axles.rolling(fits, [0.0; 2], 1.0);
        for k in 0..3 {
            assert!((motion.turn_rad_s[k] - 1.0 / 20.0).abs() < 1e-3, "{motion:?}");
            assert!((motion.along_m_s[k] - 1.0).abs() < 1e-3, "{motion:?}");
            assert!(motion.side_m_s[k].abs() < 1e-3, "{motion:?}");
        }
    }

    #[test]
    fn a_joint_that_turns_left_scrubs_against_it() {
        let axles = Axles::new(&Machine::xt28());
        let [front, rear] =
            [[0.1, 0.0], [0.0, 0.1]].map(|rate| axles.misfit_m_s([0.0; 2], rate, 0.8));
        assert!(front > 0.0 && rear > 0.0, "{front} {rear}");
    }
}
