//! `goto:X,Y,HEADING`: drive to a pose, level on the way, stop there.
//!
//! The built-in baseline, so that the loop closes without a trained network. It plans one smooth
//! path when armed and follows it: curvature of the path, previewed by the delay of the steering,
//! plus feedback on lateral and heading error. Speed falls with the square root of the
//! distance left, as seen after the delay of the drive.

use xt28_machine::{Machine, SimTime};
use xt28_safety::{Arms, Command};

use super::arrival::{Standstill, judge, too_far};
use super::levelling::Levelling;
use super::path::{Path, Point};
use super::pose_filter::PoseFilter;
use super::steering::Steering;
use super::{Outcome, Pace, Policy, held};
use crate::pose::wrap;
use crate::{Observation, Pose};

/// Speed limit of the paper's reward, m/s.
const CRUISE_M_S: f64 = 0.8;
/// Slowest speed driven, m/s: well above the 0.083 below which the joints hold.
const CREEP_M_S: f64 = 0.2;
/// Planned deceleration, m/s² (assumed).
const DECELERATION_M_S2: f64 = 0.1;
/// Longest delay from throttle to motion, s (paper 3.4); braking is planned for it.
const DRIVE_DELAY_MAX_S: f64 = 0.7;
/// Middle of the paper's delays, 0.2 to 0.7 s: the point where the throttle is let go.
const DRIVE_DELAY_S: f64 = 0.45;
/// Steering delay and lag that the path is previewed by, s (paper 3.4 and the lead's rate).
const STEERING_PREVIEW_S: f64 = 1.0;
/// Curvature per lateral error, 1/m². With the next, an error dies out over some 3 m, about
/// critically damped (y'' = -k y - c y' along the path; assumed).
const LATERAL_GAIN_PER_M2: f64 = 0.12;
/// Curvature per heading error, 1/m.
const HEADING_GAIN_PER_M: f64 = 0.7;
/// Share of the tightest curve that planning may use; the rest is left to feedback.
const PLANNABLE: f64 = 0.9;
/// Less than this along the path counts as no progress, m, and so long without any ends a drive, s
/// (assumed: at the creeping speed it is half a second's way).
const PROGRESS_M: f64 = 0.1;
const NO_PROGRESS_S: f64 = 10.0;
/// Throttle trim per speed error, 1/m, and its bound: for a machine that is not quite as fast as
/// its file says.
const TRIM_PER_M: f64 = 0.05;
const TRIM_MAX: f64 = 0.1;

/// Drives to a pose and holds there.
#[derive(Clone, Debug)]
pub struct Goto {
    goal: Pose,
    steering: Steering,
    levelling: Levelling,
    filter: PoseFilter,
    speed_full_m_s: f64,
    stage: Stage,
    trim: f64,
    last_at: Option<SimTime>,
}

#[derive(Clone, Debug)]
enum Stage {
    /// Not armed yet, or no fix.
    Waiting,
    /// On the way; metres covered along the path, and where and when it last got on.
    Driving { path: Path, along_m: f64, got_on: Option<(f64, SimTime)> },
    /// Throttle let go, until it stands.
    Stopping(Standstill),
    /// Standing for good.
    Ended(Outcome),
}

impl Goto {
    /// A drive to `goal` with the machine's steering, speed and arms.
    #[must_use]
    pub fn new(machine: &Machine, goal: Pose) -> Self {
        Self {
            goal,
            steering: Steering::new(machine),
            levelling: Levelling::new(machine),
            filter: PoseFilter::new(machine),
            speed_full_m_s: machine.drive.speed_full_m_s,
            stage: Stage::Waiting,
            trim: 0.0,
            last_at: None,
        }
    }

    /// Throttle and front joint target.
    fn drive(&mut self, seen: &Observation, pose: &Pose, dt_s: f64) -> (f64, f64) {
        let Stage::Driving { path, along_m, .. } = &mut self.stage else {
            return (0.0, seen.front_joint_rad);
        };
        let on_path = path.nearest(pose, *along_m);
        *along_m = along_m.max(on_path.along_m);
        let speed = seen.wheel_speed_m_s;
        let [ahead_m, ..] = pose.to_local(&self.goal);
        let along_left_m = path.length_m() - on_path.along_m;
        // Near the goal the path is as good as straight, and the projection is the finer measure.
        let left_m = if along_left_m < 2.0 { ahead_m } else { along_left_m };
        let preview_m = speed.max(0.0) * STEERING_PREVIEW_S;
        let curvature =
            curvature_per_m(path.curvature_per_m(on_path.along_m + preview_m), &on_path, pose);
        if left_m <= speed * DRIVE_DELAY_S {
            self.stage = Stage::Stopping(Standstill::default());
            return (0.0, seen.front_joint_rad);
        }
        let after_delay_m = (left_m - speed * DRIVE_DELAY_MAX_S).max(0.0);
        let wanted = (2.0 * DECELERATION_M_S2 * after_delay_m).sqrt().clamp(CREEP_M_S, CRUISE_M_S);
        // Trim only where the speed has had time to settle.
        if (wanted - speed).abs() < 0.3 * wanted {
            let trim = self.trim + TRIM_PER_M * (wanted - speed) * dt_s;
            self.trim = trim.clamp(-TRIM_MAX, TRIM_MAX);
        }
        let joint = self.steering.angle_rad(curvature);
        let throttle = wanted / self.speed_full_m_s + self.trim;
        (throttle, self.steering.target_rad(joint, seen.front_joint_rad))
    }

    /// Moves on to the stage that fits what is seen.
    fn advance(&mut self, seen: &Observation, pose: &Pose) {
        match &mut self.stage {
            Stage::Waiting if seen.since_arming_s.is_some() => {
                self.stage = self.depart(pose);
            }
            Stage::Stopping(standstill) => {
                if let Some(outcome) = standstill.outcome(seen, pose, &self.goal) {
                    self.stage = Stage::Ended(outcome);
                }
            }
            Stage::Driving { along_m, got_on, .. } => {
                let (mark_m, since) = *got_on.get_or_insert((*along_m, seen.at));
                if seen.since_arming_s.is_none() || *along_m > mark_m + PROGRESS_M {
                    *got_on = Some((*along_m, seen.at));
                } else if seen.at.since(since).as_secs_f64() >= NO_PROGRESS_S {
                    self.stage = Stage::Ended(Outcome::Failed(format!(
                        "no progress for {NO_PROGRESS_S} s, {mark_m:.1} m along the path; is something in the way?"
                    )));
                }
            }
            Stage::Waiting | Stage::Ended(_) => {}
        }
    }

    fn depart(&self, from: &Pose) -> Stage {
        let tightest = PLANNABLE * self.steering.curvature_max_per_m();
        if judge(from, &self.goal) == Outcome::Reached {
            return Stage::Ended(Outcome::Reached);
        }
        if let Some(failed) = too_far(from, &self.goal) {
            return Stage::Ended(failed);
        }
        match Path::plan(from, &self.goal, tightest) {
            Some(path) => Stage::Driving { path, along_m: 0.0, got_on: None },
            None => Stage::Ended(Outcome::Failed(format!(
                "no forward path to the goal is wider than the machine's turning radius of {:.1} m; \
                 give a goal further ahead",
                1.0 / tightest
            ))),
        }
    }
}

/// Path curvature with feedback on where the machine is beside the path.
fn curvature_per_m(previewed_per_m: f64, on_path: &Point, pose: &Pose) -> f64 {
    let [_, left_m, _] = on_path.pose.to_local(pose);
    let off_rad = wrap(pose.heading_rad - on_path.pose.heading_rad);
    previewed_per_m
        - LATERAL_GAIN_PER_M2 * left_m.clamp(-2.0, 2.0)
        - HEADING_GAIN_PER_M * off_rad.sin()
}

impl Policy for Goto {
    fn pace(&self) -> Pace {
        Pace::Fix
    }

    fn act(&mut self, seen: &Observation) -> Option<Command> {
        let dt_s = self.last_at.map_or(0.0, |last| seen.at.since(last).as_secs_f64().min(0.5));
        self.last_at = Some(seen.at);
        let mut command = held(seen.front_joint_rad, false);
        if let Some(located) = &seen.located {
            let pose = self.filter.step(&located.pose, seen, dt_s);
            self.advance(seen, &pose);
            (command.throttle, command.front_angle_rad) = self.drive(seen, &pose, dt_s);
        }
        if seen.since_arming_s.is_some() {
            command.arms = Arms::Position(self.levelling.step(seen, dt_s).0.map(Some));
        }
        command.brake = matches!(self.stage, Stage::Ended(_));
        Some(command)
    }

    fn outcome(&self) -> Outcome {
        match &self.stage {
            Stage::Ended(outcome) => outcome.clone(),
            _ => Outcome::Running,
        }
    }
}
