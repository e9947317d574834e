//! The machine leans by an angle for a while.

use serde::Deserialize;

use super::Evidence;
use crate::{Bound, Finding};

/// Mean roll between two instants.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Leans {
    /// Right side high > 0, degrees.
    pub roll_deg: f64,
    /// How far off it may be, degrees.
    pub within_deg: f64,
    /// From when, s.
    pub from_s: f64,
    /// Until when, s.
    pub to_s: f64,
}

impl Leans {
    pub(super) fn judge(&self, evidence: &Evidence<'_>) -> Vec<Finding> {
        let what = format!("mean roll, {} to {} s", self.from_s, self.to_s);
        let wanted = Bound::Near { value: self.roll_deg, tolerance: self.within_deg };
        let attitude = &evidence.trace.attitude;
        let rolls = match attitude.covering(self.from_s, self.to_s, "Attitude frame") {
            Ok(rolls) => rolls,
            Err(note) => return vec![Finding::missing(what, wanted, "deg", note)],
        };
        #[allow(clippy::cast_precision_loss)] // hundreds
        let count = rolls.len() as f64;
        let mean_rad = rolls.iter().map(|s| s.value.roll_rad).sum::<f64>() / count;
        vec![Finding::of(what, mean_rad.to_degrees(), wanted, "deg")]
    }
}
