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
    /// Rear angle per front angle; the machine file's when left out.
    pub ratio: Option<f64>,
}

/// A bend: the front joint is at least this far over.
const BEND_RAD: f64 = 0.05;
/// Settled: both joints stay within a band of this width ...
const BAND_RAD: f64 = 0.0026;
/// ... for this long: longer than the turning points of their swing, which takes some 25 s.
const SETTLED_S: f64 = 6.0;
/// Readings averaged before it is asked whether they stand: single ones are noisy.
const AVERAGED: usize = 25;
/// Where the joints have not settled, it is tried again this much later.
const STRIDE_S: f64 = 0.5;

impl RearFollows {
    pub(super) fn judge(&self, evidence: &Evidence<'_>) -> Vec<Finding> {
        let ratio = self.ratio.unwrap_or(evidence.machine.articulation.rear_ratio);
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
    let joints = averaged(trace.joint_rad.samples());
    stretches(&joints, bending).into_iter().flat_map(ratios_in_bend).collect()
}

/// Means of [`AVERAGED`] samples each, at the time of the middle one.
fn averaged(samples: &[Sample<[f64; 2]>]) -> Vec<Sample<[f64; 2]>> {
    let chunks = samples.chunks_exact(AVERAGED);
    let middle = |chunk: &[Sample<[f64; 2]>]| {
        let value = [mean(chunk, |v| v[0])?, mean(chunk, |v| v[1])?];
        Some(Sample { at_s: chunk[AVERAGED / 2].at_s, value })
    };
    chunks.filter_map(middle).collect()
}

/// The spans of one bend that count, none overlapping.
fn ratios_in_bend(bend: &[Sample<[f64; 2]>]) -> Vec<f64> {
    let mut ratios = Vec::new();
    let mut rest = bend;
    while let Some(first) = rest.first() {
        let later = |by_s: f64| rest.partition_point(|s| s.at_s < first.at_s + by_s);
        let span = &rest[..later(SETTLED_S)];
        if span.len() == rest.len() {
            break;
        }
        let still = |joint: usize| {
            extent(span, |v| v[joint]).is_some_and(|(low, high)| high - low < BAND_RAD)
        };
        let settled = still(0) && still(1);
        if settled {
            let (front, rear) = (mean(span, |v| v[0]), mean(span, |v| v[1]));
            ratios.extend(rear.zip(front).map(|(rear, front)| rear / front));
        }
        rest = &rest[later(if settled { SETTLED_S } else { STRIDE_S })..];
    }
    ratios
}
