//! The rear joint settles at its ratio of the front one while the machine drives.

use serde::Deserialize;

use super::Evidence;
use super::standstill::mean_speed_m_s;
use crate::series::{Sample, extent, mean, stretches};
use crate::{Bound, Finding};

/// Wherever both joints have settled in a bend at speed, rear = ratio * front.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RearFollows {
    /// How far off the ratio may be.
    pub within: f64,
}

/// A bend: the front joint is at least this far over.
const BEND_RAD: f64 = 0.05;
/// Settled: both joints stay within a band of this width ...
const BAND_RAD: f64 = 0.0026;
/// ... for this long: longer than the turning points of their swing, which takes some 25 s.
const SETTLED_S: f64 = 6.0;

impl RearFollows {
    pub(super) fn judge(&self, evidence: &Evidence<'_>) -> Vec<Finding> {
        let ratio = evidence.machine.articulation.rear_ratio;
        let wanted = Bound::Near { value: ratio, tolerance: self.within };
        let what = "rear joint over front, settled in a bend";
        let ratios = settled_ratios(evidence);
        let off = |measured: &f64| (measured - ratio).abs();
        let finding = match ratios.iter().copied().max_by(|a, b| off(a).total_cmp(&off(b))) {
            Some(worst) => Finding::of(what, worst, wanted, "")
                .noting(format!("farthest of {} settled spans", ratios.len())),
            None => Finding::missing(what, wanted, "", "the joints never settled in a bend"),
        };
        vec![finding]
    }
}

/// Rear over front in every span of [`SETTLED_S`] in which both stand still in a bend at speed.
fn settled_ratios(evidence: &Evidence<'_>) -> Vec<f64> {
    let Evidence { trace, machine, .. } = evidence;
    let threshold_m_s = machine.articulation.speed_threshold_m_s;
    let bending = |joint: &Sample<[f64; 2]>| {
        let wheels = trace.wheel_speed_rad_s.known_at(joint.at_s);
        let speed = wheels.map_or(0.0, |w| mean_speed_m_s(&w.value, machine.wheels.radius_m));
        speed.abs() > threshold_m_s && joint.value[0].abs() > BEND_RAD
    };
    let mut ratios = Vec::new();
    for bend in stretches(trace.joint_rad.samples(), bending) {
        let mut rest = bend;
        while let Some(first) = rest.first() {
            let (span, after) =
                rest.split_at(rest.partition_point(|s| s.at_s < first.at_s + SETTLED_S));
            if after.is_empty() {
                break;
            }
            let still = |joint: usize| {
                extent(span, |v| v[joint]).is_some_and(|(low, high)| high - low < BAND_RAD)
            };
            if still(0) && still(1) {
                let front = mean(span, |v| v[0]);
                let rear = mean(span, |v| v[1]);
                ratios.extend(rear.zip(front).map(|(rear, front)| rear / front));
            }
            rest = after;
        }
    }
    ratios
}
