//! Where the arms stand, or how far they have come, over a window.

use serde::Deserialize;

use super::Evidence;
use super::arm_speed::WheelName;
use crate::series::extent;
use crate::{Bound, Finding};

/// Every stroke of the arms named lies between two bounds all through a window.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Strokes {
    /// Which arms, by wheel: "FR" to "BL".
    pub wheels: Vec<WheelName>,
    /// Start of the window, s.
    pub from_s: f64,
    /// End of the window, s.
    pub to_s: f64,
    /// Least stroke, mm.
    pub from_mm: f64,
    /// Greatest stroke, mm.
    pub to_mm: f64,
}

impl Strokes {
    /// Two findings: the least and the greatest stroke of any of the arms.
    pub(super) fn judge(&self, evidence: &Evidence<'_>) -> Vec<Finding> {
        let wanted = Bound::Between(self.from_mm, self.to_mm);
        let what = |which: &str| format!("{which} stroke, {} to {} s", self.from_s, self.to_s);
        let (least, greatest) = (what("least"), what("greatest"));
        let stroke_m = &evidence.trace.stroke_m;
        let strokes = match stroke_m.covering(self.from_s, self.to_s, "stroke") {
            Ok(strokes) => strokes,
            Err(note) => {
                return [least, greatest]
                    .map(|what| Finding::missing(what, wanted, "mm", note.as_str()))
                    .into();
            }
        };
        let of_arms = self.wheels.iter().filter_map(|&WheelName(wheel)| {
            Some((wheel, extent(strokes, |stroke| stroke[wheel] * 1e3)?))
        });
        let of_arms: Vec<_> = of_arms.collect();
        let low = of_arms.iter().min_by(|a, b| a.1.0.total_cmp(&b.1.0));
        let high = of_arms.iter().max_by(|a, b| a.1.1.total_cmp(&b.1.1));
        let finding = |what, found: Option<(_, f64)>| match found {
            Some((wheel, mm)) => Finding::of(what, mm, wanted, "mm").noting(format!("arm {wheel}")),
            None => Finding::missing(what, wanted, "mm", "no stroke in that time"),
        };
        vec![
            finding(least, low.map(|(wheel, (mm, _))| (*wheel, *mm))),
            finding(greatest, high.map(|(wheel, (_, mm))| (*wheel, *mm))),
        ]
    }
}
