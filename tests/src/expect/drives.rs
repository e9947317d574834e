//! The machine drives over a window: neither wheels that spin on the spot nor a slide count.

use serde::Deserialize;

use super::Evidence;
use super::standstill::mean_speed_m_s;
use crate::series::mean;
use crate::{Bound, Finding};

/// The mean speed over a window lies between two bounds, by the wheels and by the GNSS receiver.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Drives {
    /// Start of the window, s.
    pub from_s: f64,
    /// End of the window, s.
    pub to_s: f64,
    /// Least mean speed, m/s; forward > 0.
    pub from_m_s: f64,
    /// Greatest mean speed, m/s.
    pub to_m_s: f64,
}

impl Drives {
    pub(super) fn judge(&self, evidence: &Evidence<'_>) -> Vec<Finding> {
        let Evidence { trace, machine, .. } = evidence;
        let radius_m = machine.wheels.radius_m;
        let wheels = trace.wheel_speed_rad_s.covering(self.from_s, self.to_s, "wheel speed");
        let wheels = wheels.map(|speeds| mean(speeds, |speed| mean_speed_m_s(speed, radius_m)));
        let fixes = trace.motion.covering(self.from_s, self.to_s, "GNSS velocity");
        let fixes = fixes.map(|motions| {
            mean(motions, |motion| {
                let [east_m_s, north_m_s, _] = motion.velocity_m_s;
                let (sin, cos) = motion.heading_rad.sin_cos();
                east_m_s * cos + north_m_s * sin
            })
        });
        vec![self.finding("the wheels", wheels), self.finding("GNSS", fixes)]
    }

    fn finding(&self, by: &str, speed_m_s: Result<Option<f64>, String>) -> Finding {
        let what = format!("mean speed by {by}, {} to {} s", self.from_s, self.to_s);
        let wanted = Bound::Between(self.from_m_s, self.to_m_s);
        match speed_m_s {
            Ok(Some(m_s)) => Finding::of(what, m_s, wanted, "m/s"),
            Ok(None) => Finding::missing(what, wanted, "m/s", "nothing in that time"),
            Err(note) => Finding::missing(what, wanted, "m/s", note),
        }
    }
}
