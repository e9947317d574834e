//! Arms in the air: their wheels carry nothing.

use serde::Deserialize;
use xt28_machine::{PerWheel, Wheel};

use super::Evidence;
use super::arm_speed::WheelName;
use super::wheel_load::wheel_loads_n;
use crate::series::{Sample, extent, mean};
use crate::{Bound, Finding, Truth};

/// The wheels named carry next to nothing, as a mean over a window.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Unsupported {
    /// Which wheels: "FR" to "BL".
    pub wheels: Vec<WheelName>,
    /// Start of the window, s.
    pub from_s: f64,
    /// End of the window, s.
    pub to_s: f64,
    /// What counts as nothing, either way, kN.
    pub within_kn: f64,
}

const N_PER_KN: f64 = 1e3;

impl Unsupported {
    pub(super) fn judge(&self, evidence: &Evidence<'_>) -> Vec<Finding> {
        let Evidence { trace, machine, truth, .. } = evidence;
        let wanted = Bound::Near { value: 0.0, tolerance: self.within_kn };
        let loads = trace.cylinder_load_n.covering(self.from_s, self.to_s, "cylinder load");
        let mut findings = Vec::new();
        for &WheelName(wheel) in &self.wheels {
            let what = format!("load on {wheel} in the air, from its cylinder");
            let seen_n = |loads: &[Sample<PerWheel<f64>>]| -> Vec<f64> {
                let forces_n = loads.iter().filter_map(|load| wheel_loads_n(machine, trace, load));
                forces_n.map(|force_n| force_n[wheel]).collect()
            };
            findings.push(match loads.clone().map(seen_n) {
                Ok(seen_n) if seen_n.is_empty() => {
                    Finding::missing(what, wanted, "kN", "no stroke in the window")
                }
                Ok(seen_n) => {
                    #[allow(clippy::cast_precision_loss)]
                    let mean_n = seen_n.iter().sum::<f64>() / seen_n.len() as f64;
                    Finding::of(what, mean_n / N_PER_KN, wanted, "kN")
                }
                Err(note) => Finding::missing(what, wanted, "kN", note),
            });
            findings.extend(truth.map(|truth| self.truly(truth, wheel, wanted)));
        }
        findings
    }

    /// What the ground truly bore of `wheel`.
    fn truly(&self, truth: &Truth, wheel: Wheel, wanted: Bound) -> Finding {
        let what = format!("load on {wheel} in the air, true");
        let forces = match truth.ground_force_n.covering(self.from_s, self.to_s, "truth") {
            Ok(forces) => forces,
            Err(note) => return Finding::missing(what, wanted, "kN", note),
        };
        let of_wheel = |n: &PerWheel<f64>| n[wheel];
        match (mean(forces, of_wheel), extent(forces, of_wheel)) {
            (Some(mean_n), Some((_, most_n))) => Finding::of(what, mean_n / N_PER_KN, wanted, "kN")
                .noting(format!("at most {:.2}", most_n / N_PER_KN)),
            _ => Finding::missing(what, wanted, "kN", "no truth in the window"),
        }
    }
}
