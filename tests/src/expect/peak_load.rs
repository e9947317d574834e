//! The hardest knock: the greatest force that a cylinder felt.

use serde::Deserialize;
use xt28_machine::Wheel;

use super::Evidence;
use crate::{Bound, Finding};

/// The greatest load of any cylinder over a window lies between two bounds.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PeakLoad {
    /// Start of the window, s.
    pub from_s: f64,
    /// End of the window, s.
    pub to_s: f64,
    /// Least peak, kN: below it nothing was hit.
    pub from_kn: f64,
    /// Greatest peak, kN.
    pub to_kn: f64,
}

const N_PER_KN: f64 = 1e3;

impl PeakLoad {
    pub(super) fn judge(&self, evidence: &Evidence<'_>) -> Vec<Finding> {
        let wanted = Bound::Between(self.from_kn, self.to_kn);
        let what = "greatest load of a cylinder";
        let load_n = &evidence.trace.cylinder_load_n;
        let loads = match load_n.covering(self.from_s, self.to_s, "cylinder load") {
            Ok(loads) => loads,
            Err(note) => return vec![Finding::missing(what, wanted, "kN", note)],
        };
        let all =
            loads.iter().flat_map(|s| Wheel::ALL.map(|wheel| (s.value[wheel], wheel, s.at_s)));
        vec![match all.max_by(|a, b| a.0.total_cmp(&b.0)) {
            Some((load_n, wheel, at_s)) => Finding::of(what, load_n / N_PER_KN, wanted, "kN")
                .noting(format!("{wheel} at {at_s:.2} s")),
            None => Finding::missing(what, wanted, "kN", "no load in the window"),
        }]
    }
}
