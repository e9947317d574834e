//! How fast each wheel should turn in a bend, from the joint angles.
//!
//! Every axle rolls at right angles to itself. Two axles at distances `a` and `b` from the joint
//! between them, bent by phi, then turn about one centre, and the front one's curvature is
//! sin phi / (a cos phi + b). The middle axle belongs to both joints and takes the mean; the angle's
//! own rate is left out (at 10 deg/s it is 0.3 m/s at most, and soon over).

use xt28_machine::{Axle, Machine, PerWheel};

/// Places of axles and joints.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Turn {
    /// From the axle ahead of each joint to the joint, and from there to the axle behind, m.
    arms_m: [[f64; 2]; 2],
    half_track_m: f64,
}

/// Least share of the mean that a wheel is expected at: in no bend that the joints allow does one
/// stand still.
const SHARE_MIN: f64 = 0.1;

impl Turn {
    pub(crate) fn new(machine: &Machine) -> Self {
        let [front_m, middle_m, rear_m] = machine.wheels.axle_x_m;
        let (first_m, second_m) =
            (machine.articulation.front_joint_x_m, machine.articulation.rear_joint_x_m);
        Self {
            arms_m: [
                [front_m - first_m, first_m - middle_m],
                [middle_m - second_m, second_m - rear_m],
            ],
            half_track_m: machine.wheels.track_m / 2.0,
        }
    }

    /// Each wheel's speed as a share of the mean of all, for joints at `joint_deg` (left > 0).
    pub(crate) fn shares(&self, joint_deg: [f64; 2]) -> PerWheel<f64> {
        let [first, second] = [0, 1].map(|i| bend(self.arms_m[i], joint_deg[i].to_radians()));
        // Speeds of the three axles' middles over the front one's, and their curvatures, 1/m.
        let middle = first.speed_behind;
        let axles = [
            (1.0, first.curvature_ahead),
            (middle, 0.5 * (first.curvature_behind + second.curvature_ahead)),
            (middle * second.speed_behind, second.curvature_behind),
        ];
        let speed = PerWheel::from_fn(|wheel| {
            let (speed, curvature) = match wheel.axle() {
                Axle::Front => axles[0],
                Axle::Middle => axles[1],
                Axle::Rear => axles[2],
            };
            // In a left turn the left wheels have the shorter way.
            speed * (1.0 - curvature * self.half_track_m * wheel.side().sign())
        });
        let mean = speed.mean();
        speed.map(|s| (s / mean).max(SHARE_MIN))
    }
}

/// One joint's bend.
#[derive(Clone, Copy, Debug)]
struct Bend {
    /// Of the path of the axle ahead and behind, 1/m, left > 0.
    curvature_ahead: f64,
    curvature_behind: f64,
    /// Speed of the axle behind over that of the axle ahead.
    speed_behind: f64,
}

fn bend([a_m, b_m]: [f64; 2], phi_rad: f64) -> Bend {
    let (sin, cos) = phi_rad.sin_cos();
    let (ahead_m, behind_m) = (a_m * cos + b_m, b_m * cos + a_m);
    Bend {
        curvature_ahead: sin / ahead_m,
        curvature_behind: sin / behind_m,
        // Same angular rate about the same centre: speeds are as radii.
        speed_behind: behind_m / ahead_m,
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use xt28_machine::{Side, Wheel};

    use super::*;

    fn turn() -> Turn {
        Turn::new(&Machine::xt28())
    }

    #[test]
    fn straight_ahead_all_wheels_are_alike() {
        assert_eq!(turn().shares([0.0; 2]), PerWheel::splat(1.0));
    }

    /// By hand: 20 degrees over two arms of 1.85 m is a curvature of 0.342 / 3.588 m = 0.0953 / m.
    #[test]
    fn the_inner_wheel_has_the_shorter_way() {
        let shares = turn().shares([20.0, 0.56 * 20.0]);
        let front = shares[Wheel::Fl] / shares[Wheel::Fr];
        let wanted = (1.0 - 0.0953 * 1.175) / (1.0 + 0.0953 * 1.175);
        assert!((front - wanted).abs() < 2e-4, "{front} {wanted}");
        assert!((shares.mean() - 1.0).abs() < 1e-12);
    }

    proptest! {
        #[test]
        fn a_right_turn_mirrors_a_left_one(front_deg in -25.0..25.0_f64, rear_deg in -25.0..25.0_f64) {
            let (left, right) = (turn().shares([front_deg, rear_deg]), turn().shares([-front_deg, -rear_deg]));
            for (a, b) in [(Wheel::Fr, Wheel::Fl), (Wheel::Mr, Wheel::Ml), (Wheel::Br, Wheel::Bl)] {
                prop_assert!((left[a] - right[b]).abs() < 1e-12);
                prop_assert_eq!(a.side(), Side::Right);
            }
            prop_assert!(left.0.iter().all(|s| (0.5..1.6).contains(s)), "{:?}", left);
        }
    }
}
