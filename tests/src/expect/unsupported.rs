//! Arms in the air: their wheels carry nothing.

use serde::Deserialize;

use super::Evidence;
use super::arm_speed::WheelName;
use super::wheel_load::wheel_loads_n;
use crate::series::{extent, mean};
use crate::{Bound, Finding};

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
        let loads = trace.cylinder_load_n.between(self.from_s, self.to_s);
        let mut findings = Vec::new();
        for &WheelName(wheel) in &self.wheels {
            let what = format!("load on {wheel} in the air, from its cylinder");
            let mut seen = Vec::new();
            for sample in loads {
                seen.extend(wheel_loads_n(machine, trace, sample).map(|force_n| force_n[wheel]));
            }
            findings.push(if seen.is_empty() {
                Finding::missing(what, wanted, "kN", "no load and stroke in the window")
            } else {
                #[allow(clippy::cast_precision_loss)]
                let mean_n = seen.iter().sum::<f64>() / seen.len() as f64;
                Finding::of(what, mean_n / N_PER_KN, wanted, "kN")
            });
            let Some(truth) = truth else { continue };
            let forces = truth.ground_force_n.between(self.from_s, self.to_s);
            let what = format!("load on {wheel} in the air, true");
            let of_wheel = |n: &xt28_machine::PerWheel<f64>| n[wheel];
            findings.push(match (mean(forces, of_wheel), extent(forces, of_wheel)) {
                (Some(mean_n), Some((_, most_n))) => {
                    Finding::of(what, mean_n / N_PER_KN, wanted, "kN")
                        .noting(format!("at most {:.2}", most_n / N_PER_KN))
                }
                _ => Finding::missing(what, wanted, "kN", "no truth in the window"),
            });
        }
        findings
    }
}
