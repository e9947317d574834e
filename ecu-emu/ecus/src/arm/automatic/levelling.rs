//! The three P-controllers for height, roll and pitch: each asks every arm for a change of force.

use xt28_machine::{Axle, PerWheel};

/// What the controllers look at.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Pose {
    /// Mean stroke of the six arms, m (paper: "average height of the arms").
    pub(crate) height_m: f64,
    /// Right side high > 0.
    pub(crate) roll_rad: f64,
    /// Nose up > 0.
    pub(crate) pitch_rad: f64,
}

/// Gains of the three controllers, N per m and per rad.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Levelling {
    height_n_m: f64,
    roll_n_rad: f64,
    pitch_n_rad: f64,
}

impl Levelling {
    pub(crate) const fn new(gains: &xt28_machine::Levelling) -> Self {
        Self {
            height_n_m: gains.height_n_m,
            roll_n_rad: gains.roll_n_rad,
            pitch_n_rad: gains.pitch_n_rad,
        }
    }

    /// Requests of height, roll and pitch for every arm, N; more force extends. Height asks all arms
    /// alike, roll the left against the right, pitch the front against the rear and the middle not
    /// at all (paper).
    pub(crate) fn requests(&self, height_m: f64, pose: &Pose) -> [PerWheel<f64>; 3] {
        let height_n = self.height_n_m * (height_m - pose.height_m);
        let roll_n = self.roll_n_rad * pose.roll_rad;
        let pitch_n = self.pitch_n_rad * pose.pitch_rad;
        [
            PerWheel::splat(height_n),
            // A high right side wants more on the left, whose y is positive.
            PerWheel::from_fn(|wheel| roll_n * wheel.side().sign()),
            PerWheel::from_fn(|wheel| match wheel.axle() {
                Axle::Front => -pitch_n,
                Axle::Middle => 0.0,
                Axle::Rear => pitch_n,
            }),
        ]
    }
}

#[cfg(test)]
mod tests {
    use xt28_machine::{Machine, Wheel};

    use super::*;

    fn requests(pose: Pose) -> [PerWheel<f64>; 3] {
        let gains = Machine::xt28().levelling;
        Levelling::new(&gains).requests(0.25, &pose)
    }

    #[test]
    fn each_controller_answers_its_own_error_only() {
        let level = Pose { height_m: 0.25, ..Pose::default() };
        assert_eq!(requests(level), [PerWheel::splat(0.0); 3]);
        let [height, roll, pitch] = requests(Pose { height_m: 0.20, ..level });
        assert!((height.mean() - 0.05 * 760e3).abs() < 1e-6);
        assert_eq!([roll, pitch], [PerWheel::splat(0.0); 2]);
    }

    #[test]
    fn requests_push_against_the_lean() {
        let leaning = Pose { height_m: 0.25, roll_rad: 0.1, pitch_rad: 0.02 };
        let [_, roll, pitch] = requests(leaning);
        // Right side high: the right arms give way, the left ones push.
        assert!(roll[Wheel::Fr] < 0.0 && roll[Wheel::Ml] > 0.0);
        assert_eq!(roll[Wheel::Br], -roll[Wheel::Fl]);
        // Nose up: the front arms give way.
        assert!(pitch[Wheel::Fl] < 0.0 && pitch[Wheel::Br] > 0.0);
        assert_eq!(pitch[Wheel::Mr], 0.0);
        // Neither asks the machine to weigh more.
        assert!(roll.sum().abs() < 1e-9 && pitch.sum().abs() < 1e-9);
    }
}
