//! Ends at a pose: the mean of the last fixes lies within a distance and an angle of the target.

use serde::Deserialize;

use super::Evidence;
use crate::series::mean;
use crate::trace::{Attitude, Pose, wrapped_rad};
use crate::{Bound, Finding};

/// Ends with the front axle at a pose of the local frame.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ReachesPose {
    /// East, m.
    pub x_m: f64,
    /// North, m.
    pub y_m: f64,
    /// Counter-clockwise from east, degrees.
    pub heading_deg: f64,
    /// How far off the front axle may be, m.
    pub within_m: f64,
    /// How far off the heading may be, degrees.
    pub within_deg: f64,
}

/// Fixes of this last span are averaged: eight bring 5 mm of noise to 2 mm.
const LAST_S: f64 = 1.0;

impl ReachesPose {
    pub(super) fn judge(&self, evidence: &Evidence<'_>) -> Vec<Finding> {
        let distance = Bound::AtMost(self.within_m);
        let angle = Bound::AtMost(self.within_deg);
        let (what_m, what_deg) = ("distance from the target pose", "heading off the target's");
        let Some(pose) = last_pose(evidence) else {
            let note = "no GNSS fix in the last second";
            return vec![
                Finding::missing(what_m, distance, "m", note),
                Finding::missing(what_deg, angle, "deg", note),
            ];
        };
        let off_m = (pose.x_m - self.x_m).hypot(pose.y_m - self.y_m);
        let off_rad = wrapped_rad(pose.heading_rad - self.heading_deg.to_radians());
        let (x_m, y_m, deg) = (pose.x_m, pose.y_m, pose.heading_rad.to_degrees());
        vec![
            Finding::of(what_m, off_m, distance, "m").noting(format!("at ({x_m:.2}, {y_m:.2}) m")),
            Finding::of(what_deg, off_rad.to_degrees().abs(), angle, "deg")
                .noting(format!("heading {deg:.1} deg")),
        ]
    }
}

fn last_pose(evidence: &Evidence<'_>) -> Option<Pose> {
    let Evidence { trace, machine, .. } = evidence;
    let from_s = trace.end_s - LAST_S;
    let fixes = trace.antenna_m.between(from_s, trace.end_s);
    let motions = trace.motion.between(from_s, trace.end_s);
    let antenna_m = [mean(fixes, |p| p[0])?, mean(fixes, |p| p[1])?];
    // The mean of directions, so that headings about half a turn do not cancel.
    let sin = mean(motions, |motion| motion.heading_rad.sin())?;
    let cos = mean(motions, |motion| motion.heading_rad.cos())?;
    let lean = trace.attitude.last().map_or_else(Attitude::default, |attitude| attitude.value);
    Some(Pose::from_antenna(machine, antenna_m, sin.atan2(cos), lean))
}
