//! The greatest roll of the run lies between two bounds: the obstacle is felt, and not too much.

use serde::Deserialize;

use super::Evidence;
use crate::{Bound, Finding};

/// Roll at its greatest and at the end; right side high > 0.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RollPeak {
    /// Least peak, degrees: below it the machine missed the obstacle.
    pub from_deg: f64,
    /// Greatest peak, degrees.
    pub to_deg: f64,
    /// Greatest roll either way at the end of the run, degrees.
    pub end_within_deg: f64,
}

impl RollPeak {
    pub(super) fn judge(&self, evidence: &Evidence<'_>) -> Vec<Finding> {
        let trace = evidence.trace;
        let rolls = trace.attitude.covering(0.0, trace.end_s, "Attitude frame");
        let peak_bound = Bound::Between(self.from_deg, self.to_deg);
        let end_bound = Bound::Near { value: 0.0, tolerance: self.end_within_deg };
        let (what_peak, what_end) = ("greatest roll", "roll at the end");
        let by_size = |a: &f64, b: &f64| a.abs().total_cmp(&b.abs());
        let missing = |note: &str| {
            vec![
                Finding::missing(what_peak, peak_bound, "deg", note),
                Finding::missing(what_end, end_bound, "deg", note),
            ]
        };
        let rolls = match rolls {
            Ok(rolls) => rolls,
            Err(note) => return missing(&note),
        };
        let degrees = || rolls.iter().map(|s| s.value.roll_rad.to_degrees());
        match (degrees().max_by(by_size), degrees().next_back()) {
            (Some(peak_deg), Some(end_deg)) => vec![
                Finding::of(what_peak, peak_deg, peak_bound, "deg"),
                Finding::of(what_end, end_deg, end_bound, "deg"),
            ],
            _ => missing("no Attitude frame"),
        }
    }
}
