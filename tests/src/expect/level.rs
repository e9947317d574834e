//! Level: roll and pitch stay small over a window.

use serde::Deserialize;

use super::Evidence;
use crate::series::extent;
use crate::trace::Attitude;
use crate::{Bound, Finding};

/// Neither roll nor pitch is greater, either way, from one time to another.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StaysLevel {
    /// Start of the window, s.
    pub from_s: f64,
    /// End of the window, s.
    pub to_s: f64,
    /// Greatest roll, degrees.
    pub roll_deg: f64,
    /// Greatest pitch, degrees.
    pub pitch_deg: f64,
}

impl StaysLevel {
    pub(super) fn judge(&self, evidence: &Evidence<'_>) -> Vec<Finding> {
        let attitude = &evidence.trace.attitude;
        let samples = attitude.covering(self.from_s, self.to_s, "Attitude frame");
        let greatest = |what: &str, limit_deg: f64, of: fn(&Attitude) -> f64| {
            let what = format!("greatest {what}, {} to {} s", self.from_s, self.to_s);
            let wanted = Bound::AtMost(limit_deg);
            let samples = match &samples {
                Ok(samples) => *samples,
                Err(note) => return Finding::missing(what, wanted, "deg", note),
            };
            match extent(samples, of) {
                Some((low, high)) => {
                    let (low_deg, high_deg) = (low.to_degrees(), high.to_degrees());
                    Finding::of(what, high_deg.max(-low_deg), wanted, "deg")
                        .noting(format!("{low_deg:.2} to {high_deg:.2}"))
                }
                None => Finding::missing(what, wanted, "deg", "no Attitude frame"),
            }
        };
        vec![
            greatest("roll", self.roll_deg, |attitude| attitude.roll_rad),
            greatest("pitch", self.pitch_deg, |attitude| attitude.pitch_rad),
        ]
    }
}
