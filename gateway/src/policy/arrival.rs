//! When a drive to a pose is over, and whether it got there: the same for every policy that has a goal.

use xt28_machine::SimTime;

use super::Outcome;
use crate::{Observation, Pose};

/// A pose counts as reached this close to it, m (paper 4.2).
pub const REACHED_DISTANCE_M: f64 = 0.3;
/// A pose counts as reached with this much heading error, rad (9 degrees, paper 4.2).
pub const REACHED_HEADING_RAD: f64 = 9.0 * core::f64::consts::PI / 180.0;
/// The furthest goal of one drive, m (assumed): further away is another site's, or another origin's.
const GOAL_MAX_M: f64 = 300.0;
/// Slower than this is standing, m/s.
const STANDING_M_S: f64 = 0.03;
/// Standing this long ends a drive, s.
const STANDING_S: f64 = 1.0;
/// One that lets go of its throttle stands within two seconds; after this long something else is wrong, s (assumed).
const STOPPING_MAX_S: f64 = 10.0;

/// How a machine at `pose` stands to `goal`: reached, or how far off.
pub(super) fn judge(pose: &Pose, goal: &Pose) -> Outcome {
    let [ahead_m, left_m, turn_rad] = pose.to_local(goal);
    let distance_m = ahead_m.hypot(left_m);
    if distance_m <= REACHED_DISTANCE_M && turn_rad.abs() <= REACHED_HEADING_RAD {
        return Outcome::Reached;
    }
    let turn_deg = turn_rad.to_degrees();
    Outcome::Failed(format!("stopped {distance_m:.2} m and {turn_deg:.1} deg from the goal"))
}

/// Why a drive from `pose` to `goal` is none, if it is too far.
pub(super) fn too_far(pose: &Pose, goal: &Pose) -> Option<Outcome> {
    let away_m = (goal.east_m - pose.east_m).hypot(goal.north_m - pose.north_m);
    (away_m > GOAL_MAX_M).then(|| {
        Outcome::Failed(format!(
            "the goal is {away_m:.0} m from the machine, and one drive goes {GOAL_MAX_M} m at most; \
             is the origin that its coordinates count from (--origin) where the machine is?"
        ))
    })
}

/// A machine that comes to a stop.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Standstill {
    since: Option<SimTime>,
    /// Since when it rolls on.
    rolls_since: Option<SimTime>,
}

impl Standstill {
    /// How a drive to `goal` came out, once the machine has stood at `pose` for a second, or should have long ago.
    pub(super) fn outcome(
        &mut self,
        seen: &Observation,
        pose: &Pose,
        goal: &Pose,
    ) -> Option<Outcome> {
        if self.has_stood(seen) {
            return Some(judge(pose, goal));
        }
        let speed_m_s = seen.wheel_speed_m_s;
        let rolls = speed_m_s.abs() >= STANDING_M_S && seen.since_arming_s.is_some();
        let since = self.rolls_since.filter(|_| rolls).unwrap_or(seen.at);
        self.rolls_since = rolls.then_some(since);
        (seen.at.since(since).as_secs_f64() >= STOPPING_MAX_S).then(|| {
            Outcome::Failed(format!(
                "{STOPPING_MAX_S} s after the throttle was let go the wheels still read {speed_m_s:.2} m/s; does a \
                 sensor of theirs hang?"
            ))
        })
    }

    /// Whether it has stood for a second.
    fn has_stood(&mut self, seen: &Observation) -> bool {
        let start = *self.since.get_or_insert(seen.at);
        if seen.wheel_speed_m_s.abs() >= STANDING_M_S {
            self.since = None;
            return false;
        }
        seen.at.since(start).as_secs_f64() >= STANDING_S
    }
}
