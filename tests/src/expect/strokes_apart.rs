//! Arms apart: a machine that keeps level over uneven ground takes up its heights with its arms.

use serde::Deserialize;
use xt28_machine::Wheel;

use super::Evidence;
use crate::{Bound, Finding};

/// The greatest difference of two strokes at one time, over a window, lies between two bounds.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StrokesApart {
    /// Start of the window, s.
    pub from_s: f64,
    /// End of the window, s.
    pub to_s: f64,
    /// Least difference, mm: below it the arms felt no such ground.
    pub from_mm: f64,
    /// Greatest difference, mm.
    pub to_mm: f64,
}

impl StrokesApart {
    pub(super) fn judge(&self, evidence: &Evidence<'_>) -> Vec<Finding> {
        let what =
            format!("greatest difference of two strokes, {} to {} s", self.from_s, self.to_s);
        let wanted = Bound::Between(self.from_mm, self.to_mm);
        let stroke_m = &evidence.trace.stroke_m;
        let strokes = match stroke_m.covering(self.from_s, self.to_s, "stroke") {
            Ok(strokes) => strokes,
            Err(note) => return vec![Finding::missing(what, wanted, "mm", note)],
        };
        let apart_mm = strokes.iter().map(|sample| {
            let of = |pick: fn(f64, f64) -> f64| {
                Wheel::ALL.map(|wheel| sample.value[wheel]).into_iter().reduce(pick)
            };
            let apart_m = of(f64::max).zip(of(f64::min)).map_or(0.0, |(most, least)| most - least);
            (apart_m * 1e3, sample.at_s)
        });
        vec![match apart_mm.max_by(|a, b| a.0.total_cmp(&b.0)) {
            Some((mm, at_s)) => {
                Finding::of(what, mm, wanted, "mm").noting(format!("at {at_s:.2} s"))
            }
            None => Finding::missing(what, wanted, "mm", "no stroke in that time"),
        }]
    }
}
