//! The wheels together carry the machine's weight once it stands.

use serde::Deserialize;
use xt28_machine::{GRAVITY_M_S2, Linkage, Machine, PerWheel, Wheel};

use super::Evidence;
use crate::series::{Sample, mean};
use crate::{Bound, Finding, Trace};

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
        let Evidence { trace, machine, truth, .. } = evidence;
        let weight_kn = machine.mass_kg() * GRAVITY_M_S2 / N_PER_KN;
        let tolerance = weight_kn * self.within_percent / 100.0;
        let wanted = Bound::Near { value: weight_kn, tolerance };
        let finding = |what: &str, sum_n: Option<f64>| match sum_n {
            Some(sum_n) => Finding::of(what, sum_n / N_PER_KN, wanted, "kN"),
            None => Finding::missing(what, wanted, "kN", "no load and stroke in the window"),
        };
        let loads = trace.cylinder_load_n.between(self.from_s, self.to_s);
        let sum_n = mean_of(loads, |sample| ground_force_n(machine, trace, sample));
        let mut findings = vec![finding("sum of wheel loads, from cylinders", sum_n)];
        if let Some(truth) = truth {
            let forces = truth.ground_force_n.between(self.from_s, self.to_s);
            let sum_n = mean(forces, PerWheel::sum);
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

/// Vertical ground force on all wheels, N, from one sample of cylinder loads and the strokes then.
fn ground_force_n(machine: &Machine, trace: &Trace, load_n: &Sample<PerWheel<f64>>) -> Option<f64> {
    let stroke_m = trace.stroke_m.known_at(load_n.at_s)?.value;
    let linkage = machine.linkage();
    let one = |wheel: Wheel| wheel_load_n(machine, &linkage, stroke_m[wheel], load_n.value[wheel]);
    Some(PerWheel::from_fn(one).sum())
}

/// Vertical ground force on one wheel at rest, N. Moments about the arm's pivot: the ground lifts
/// wheel and arm and presses the cylinder, so F = k F_cylinder + (m_wheel + share m_arm) g, with k
/// of the true linkage (facts 1.4) and `share` the way from pivot to wheel to the arm's centre of
/// mass. A horizontal ground force, as when arms pinch the ground, is not seen.
fn wheel_load_n(machine: &Machine, linkage: &Linkage, stroke_m: f64, load_n: f64) -> f64 {
    let unsprung_kg =
        machine.masses.wheel_kg + machine.vehicle.arm_com_share * machine.masses.arm_kg;
    linkage.at_stroke(stroke_m).force_ratio * load_n + unsprung_kg * GRAVITY_M_S2
}
