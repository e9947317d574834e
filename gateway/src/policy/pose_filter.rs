//! A steadier pose than a single fix gives: odometry between fixes, pulled to each fix.
//!
//! The steering leads its target, which would make 5 mrad of heading noise (paper 3.4) several
//! degrees of joint target at each fix.

use xt28_machine::Machine;

use crate::pose::wrap;
use crate::{Observation, Pose};

/// Share of the difference to the fix that is taken over: noise falls to 0.4 of it, and an error of
/// the prediction dies out in some four fixes.
const GAIN: f64 = 0.25;
/// Further than this from the prediction, the fix is taken as it is, m.
const RESTART_M: f64 = 0.5;

/// The filtered pose of the front axle.
#[derive(Clone, Copy, Debug)]
pub(super) struct PoseFilter {
    /// Front joint to front and to middle axle, m.
    ahead_m: f64,
    behind_m: f64,
    pose: Option<Pose>,
    joint_rad: f64,
}

impl PoseFilter {
    pub(super) fn new(machine: &Machine) -> Self {
        let joint_x_m = machine.articulation.front_joint_x_m;
        Self {
            ahead_m: machine.wheels.axle_x_m[0] - joint_x_m,
            behind_m: joint_x_m - machine.wheels.axle_x_m[1],
            pose: None,
            joint_rad: 0.0,
        }
    }

    /// The pose now, with the fix of this observation, `dt_s` after the last.
    pub(super) fn step(&mut self, fix: &Pose, seen: &Observation, dt_s: f64) -> Pose {
        let joint_change_rad = seen.front_joint_rad - self.joint_rad;
        self.joint_rad = seen.front_joint_rad;
        let pose = match self.pose {
            None => *fix,
            Some(before) => {
                let travel_m = seen.wheel_speed_m_s * dt_s;
                pulled(&self.moved(&before, travel_m, joint_change_rad), fix)
            }
        };
        self.pose = Some(pose);
        pose
    }

    /// `pose` moved on without sideslip of front and middle axle; the joint between them turns the
    /// front frame as well.
    fn moved(&self, pose: &Pose, travel_m: f64, joint_change_rad: f64) -> Pose {
        let (sin, cos) = self.joint_rad.sin_cos();
        let turn_rad = (travel_m * sin + self.behind_m * joint_change_rad)
            / (self.ahead_m * cos + self.behind_m);
        let (sin, cos) = (pose.heading_rad + turn_rad / 2.0).sin_cos();
        Pose {
            east_m: pose.east_m + travel_m * cos,
            north_m: pose.north_m + travel_m * sin,
            heading_rad: wrap(pose.heading_rad + turn_rad),
        }
    }
}

fn pulled(predicted: &Pose, fix: &Pose) -> Pose {
    let (de, dn) = (fix.east_m - predicted.east_m, fix.north_m - predicted.north_m);
    if de.hypot(dn) > RESTART_M {
        return *fix;
    }
    Pose {
        east_m: predicted.east_m + GAIN * de,
        north_m: predicted.north_m + GAIN * dn,
        heading_rad: wrap(
            predicted.heading_rad + GAIN * wrap(fix.heading_rad - predicted.heading_rad),
        ),
    }
}
