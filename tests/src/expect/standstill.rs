//! Ends standing: neither the wheels, in the mean of all, nor the antenna move over the last seconds.

use serde::Deserialize;
use xt28_machine::PerWheel;

use super::Evidence;
use crate::series::slope;
use crate::{Bound, Finding, Incident};

/// Stands still at the end.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StandsStill {
    /// Greatest speed that counts as standing, m/s.
    pub below_m_s: f64,
    /// Over this last span, s.
    #[serde(default = "two_seconds")]
    pub over_s: f64,
}

fn two_seconds() -> f64 {
    2.0
}

impl StandsStill {
    pub(super) fn judge(&self, evidence: &Evidence<'_>) -> Vec<Finding> {
        let Evidence { scenario, trace, machine, .. } = evidence;
        let wanted = Bound::AtMost(self.below_m_s);
        let from_s = (trace.end_s - self.over_s).max(0.0);
        let speed_rad_s = &trace.wheel_speed_rad_s;
        let wheels = speed_rad_s.covering(from_s, trace.end_s, "wheel speed");
        let fastest_rad_s = wheels
            .map(|wheels| wheels.iter().map(|s| s.value.map(f64::abs).mean()).fold(0.0, f64::max));
        let what = "wheel speed at the end";
        let mut findings = vec![match fastest_rad_s {
            Ok(rad_s) => Finding::of(what, rad_s * machine.wheels.radius_m, wanted, "m/s"),
            Err(note) => Finding::missing(what, wanted, "m/s", note),
        }];
        let drift = "antenna drift at the end";
        let fixes = trace.antenna_m.between(from_s, trace.end_s);
        if let (Some(east), Some(north)) = (slope(fixes, |p| p[0]), slope(fixes, |p| p[1])) {
            let drift_m_s = east.hypot(north);
            findings.push(Finding::of(drift, drift_m_s, wanted, "m/s"));
        } else if !scenario.events.iter().any(|e| matches!(e.what, Incident::Kill(_))) {
            // A gateway that is gone sends no fixes; the wheels then speak alone. One fix shows no drift.
            let note = format!("{} GNSS fixes at the end; it takes two", fixes.len());
            findings.push(Finding::missing(drift, wanted, "m/s", note));
        }
        findings
    }
}

/// Mean speed of the wheels over ground, m/s.
pub(super) fn mean_speed_m_s(wheel_speed_rad_s: &PerWheel<f64>, radius_m: f64) -> f64 {
    wheel_speed_rad_s.mean() * radius_m
}
