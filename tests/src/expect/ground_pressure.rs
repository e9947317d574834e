//! Even ground pressure: the wheels share the weight, standing or driving.

use serde::Deserialize;
use xt28_machine::PerWheel;

use super::Evidence;
use super::wheel_load::wheel_loads_n;
use crate::series::{Sample, mean};
use crate::{Bound, Finding};

/// The standard deviation of the wheel forces over their sum, as the paper's reward has it (its
/// scale there is 0.1), as a mean over a window. All alike would be 0; the empty machine's weight
/// lies too far in front for less than 0.08 on level ground.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct EvenGroundPressure {
    /// Start of the window, s.
    pub from_s: f64,
    /// End of the window, s.
    pub to_s: f64,
    /// Least mean deviation: below it the wheels would not feel the ground.
    #[serde(default)]
    pub from: f64,
    /// Greatest mean deviation.
    pub below: f64,
}

impl EvenGroundPressure {
    pub(super) fn judge(&self, evidence: &Evidence<'_>) -> Vec<Finding> {
        let Evidence { trace, machine, truth, .. } = evidence;
        let wanted = Bound::Between(self.from, self.below);
        let finding = |what: &str, deviations: Result<Vec<f64>, String>| {
            let deviations = match deviations {
                Ok(deviations) => deviations,
                Err(note) => return Finding::missing(what, wanted, "", note),
            };
            let Some(worst) = deviations.iter().copied().reduce(f64::max) else {
                return Finding::missing(what, wanted, "", "no stroke in the window");
            };
            #[allow(clippy::cast_precision_loss)]
            let mean = deviations.iter().sum::<f64>() / deviations.len() as f64;
            Finding::of(what, mean, wanted, "").noting(format!("at most {worst:.3}"))
        };
        let loads = trace.cylinder_load_n.covering(self.from_s, self.to_s, "cylinder load");
        let seen = loads.map(|loads| {
            let forces_n = loads.iter().filter_map(|sample| wheel_loads_n(machine, trace, sample));
            forces_n.map(|force_n| deviation(&force_n)).collect()
        });
        let mut findings = vec![finding("deviation of wheel forces, from cylinders", seen)];
        if let Some(truth) = truth {
            let forces = truth.ground_force_n.covering(self.from_s, self.to_s, "truth");
            findings.push(finding("deviation of wheel forces, true", forces.map(smoothed)));
        }
        findings
    }
}

/// Ground forces are averaged over this much, as the cylinders' pressure sensors do.
const SMOOTH_S: f64 = 0.16;

fn smoothed(forces: &[Sample<PerWheel<f64>>]) -> Vec<f64> {
    let window = |first: &Sample<PerWheel<f64>>| {
        let from = forces.partition_point(|s| s.at_s < first.at_s);
        let to = forces.partition_point(|s| s.at_s < first.at_s + SMOOTH_S);
        let of = |wheel| mean(&forces[from..to], |force_n| force_n[wheel]).unwrap_or(0.0);
        deviation(&PerWheel::from_fn(of))
    };
    forces.iter().map(window).collect()
}

/// Standard deviation of the six forces, each over their sum.
pub(super) fn deviation(force_n: &PerWheel<f64>) -> f64 {
    let share = force_n.map(|n| n / force_n.sum());
    share.map(|s| (s - share.mean()).powi(2)).mean().sqrt()
}
