//! The wheels together carry the weight of the machine and its payload once it stands.

use serde::Deserialize;
use xt28_machine::{GRAVITY_M_S2, PerWheel};

use super::Evidence;
use super::wheel_load::wheel_loads_n;
use crate::series::{Sample, mean};
use crate::{Bound, Finding};

/// Static wheel loads sum to the weight, over a window in which the machine stands.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CarriesWeight {
    /// Start of the window, s.
    pub from_s: f64,
    /// End of the window, s.
    pub to_s: f64,
    /// How far off the sum may be, percent of the weight.
    pub within_percent: f64,
}

const N_PER_KN: f64 = 1e3;

impl CarriesWeight {
    pub(super) fn judge(&self, evidence: &Evidence<'_>) -> Vec<Finding> {
        let Evidence { trace, machine, payload_kg, truth, .. } = evidence;
        let weight_kn = (machine.mass_kg() + payload_kg) * GRAVITY_M_S2 / N_PER_KN;
        let tolerance = weight_kn * self.within_percent / 100.0;
        let wanted = Bound::Near { value: weight_kn, tolerance };
        let finding = |what: &str, sum_n: Result<Option<f64>, String>| match sum_n {
            Ok(Some(sum_n)) => Finding::of(what, sum_n / N_PER_KN, wanted, "kN"),
            Ok(None) => Finding::missing(what, wanted, "kN", "no stroke in the window"),
            Err(note) => Finding::missing(what, wanted, "kN", note),
        };
        let loads = trace.cylinder_load_n.covering(self.from_s, self.to_s, "cylinder load");
        let sum_of = |sample: &_| wheel_loads_n(machine, trace, sample).map(|n| n.sum());
        let sum_n = loads.map(|loads| mean_of(loads, sum_of));
        let mut findings = vec![finding("sum of wheel loads, from cylinders", sum_n)];
        if let Some(truth) = truth {
            let forces = truth.ground_force_n.covering(self.from_s, self.to_s, "truth");
            let sum_n = forces.map(|forces| mean(forces, PerWheel::sum));
            findings.push(finding("sum of wheel loads, true", sum_n));
        }
        findings
    }
}

fn mean_of<T>(samples: &[Sample<T>], of: impl Fn(&Sample<T>) -> Option<f64>) -> Option<f64> {
    let values: Vec<f64> = samples.iter().filter_map(of).collect();
    #[allow(clippy::cast_precision_loss)]
    let count = values.len() as f64;
    (!values.is_empty()).then(|| values.iter().sum::<f64>() / count)
}
