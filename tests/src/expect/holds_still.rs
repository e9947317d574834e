//! The arms stay where they are for a while.

use serde::Deserialize;
use xt28_machine::Wheel;

use super::Evidence;
use crate::{Bound, Finding};

/// No stroke changes by more than this between two instants.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HoldsStill {
    /// From when, s.
    pub from_s: f64,
    /// Until when, s.
    pub to_s: f64,
    /// Greatest change of a stroke, mm.
    pub within_mm: f64,
}

impl HoldsStill {
    pub(super) fn judge(&self, evidence: &Evidence<'_>) -> Vec<Finding> {
        let what = format!("greatest change of a stroke, {} to {} s", self.from_s, self.to_s);
        let wanted = Bound::AtMost(self.within_mm);
        let stroke_m = &evidence.trace.stroke_m;
        let strokes = match stroke_m.covering(self.from_s, self.to_s, "stroke") {
            Ok(strokes) => strokes,
            Err(note) => return vec![Finding::missing(what, wanted, "mm", note)],
        };
        let change_mm = |wheel: Wheel| {
            let of = |pick: fn(f64, f64) -> f64| {
                strokes.iter().map(|s| s.value[wheel]).reduce(pick).unwrap_or(f64::NAN)
            };
            (of(f64::max) - of(f64::min)) * 1e3
        };
        let worst =
            Wheel::ALL.map(|w| (change_mm(w), w)).into_iter().max_by(|a, b| a.0.total_cmp(&b.0));
        vec![match worst {
            Some((mm, wheel)) if mm.is_finite() => {
                Finding::of(what, mm, wanted, "mm").noting(format!("arm {wheel}"))
            }
            _ => Finding::missing(what, wanted, "mm", "no stroke in that time"),
        }]
    }
}
