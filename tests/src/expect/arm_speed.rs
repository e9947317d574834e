//! Arms far from their target move at the cap of their valves: opening limit times full speed.

use serde::Deserialize;
use xt28_machine::{Machine, PerWheel, Wheel};

use super::Evidence;
use crate::series::{Sample, slope, stretches};
use crate::{Bound, Finding};

/// The arms named move at the speed the valve cap allows, whenever they are far from their target.
///
/// The mean is judged: a cylinder gives way under its load, so while weight shifts between the
/// axles one arm is measured faster than its valve feeds it and another slower.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ArmSpeed {
    /// Which arms must have moved, by wheel: "FR" to "BL".
    pub wheels: Vec<WheelName>,
    /// How far off the speed may be, percent of the cap.
    pub within_percent: f64,
}

/// A wheel by its name on the wire.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(try_from = "String")]
pub struct WheelName(pub Wheel);

impl TryFrom<String> for WheelName {
    type Error = String;

    fn try_from(name: String) -> Result<Self, String> {
        Wheel::from_name(&name)
            .map(Self)
            .ok_or_else(|| format!("unknown wheel `{name}`, expected FR, FL, MR, ML, BR or BL"))
    }
}

/// The start of a movement is left out while the valve opens and the lock takes up load.
const TAKE_UP_S: f64 = 0.2;
/// Below this much steady movement a slope says little: strokes come in whole mm.
const STEADY_S: f64 = 0.4;

impl ArmSpeed {
    pub(super) fn judge(&self, evidence: &Evidence<'_>) -> Vec<Finding> {
        let h = &evidence.machine.hydraulics;
        let cap_m_s = h.manual_opening_max * h.speed_full_m_s;
        let tolerance = cap_m_s * self.within_percent / 100.0;
        let wanted = Bound::Near { value: cap_m_s, tolerance };
        let what = "mean speed of the arms at the valve cap";
        let mut speeds_m_s = Vec::new();
        for &WheelName(wheel) in &self.wheels {
            let of_wheel = capped_speeds_m_s(evidence, wheel);
            if of_wheel.is_empty() {
                let note = format!("arm {wheel} is never far from its target for long enough");
                return vec![Finding::missing(what, wanted, "m/s", note)];
            }
            speeds_m_s.extend(of_wheel);
        }
        #[allow(clippy::cast_precision_loss)] // a handful
        let mean_m_s = speeds_m_s.iter().sum::<f64>() / speeds_m_s.len() as f64;
        let slowest = speeds_m_s.iter().copied().fold(f64::INFINITY, f64::min);
        let fastest = speeds_m_s.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let count = speeds_m_s.len();
        let note = format!("{count} movements, {slowest:.4} to {fastest:.4}");
        vec![Finding::of(what, mean_m_s, wanted, "m/s").noting(note)]
    }
}

/// Speeds towards the target of every movement of `wheel` in which the position controller is saturated, m/s.
fn capped_speeds_m_s(evidence: &Evidence<'_>, wheel: Wheel) -> Vec<f64> {
    let Evidence { trace, machine, .. } = evidence;
    let saturating_m = saturating_error_m(machine);
    let error_m = |sample: &Sample<PerWheel<f64>>| {
        let target = trace.stroke_target_m.known_at(sample.at_s)?.value[wheel]?;
        Some(target - sample.value[wheel])
    };
    let mut speeds = Vec::new();
    for sign in [1.0, -1.0] {
        let saturated =
            |s: &Sample<PerWheel<f64>>| error_m(s).is_some_and(|e| e * sign > saturating_m);
        for movement in stretches(trace.stroke_m.samples(), saturated) {
            let start_s = movement[0].at_s + TAKE_UP_S;
            let steady = &movement[movement.partition_point(|s| s.at_s < start_s)..];
            let long = steady.last().is_some_and(|last| last.at_s - start_s >= STEADY_S);
            // Towards the target > 0: an arm that runs away from it at full speed is not a fast one.
            let towards_m_s = slope(steady, |stroke| sign * stroke[wheel]);
            speeds.extend(towards_m_s.filter(|_| long));
        }
    }
    speeds
}

/// Stroke error above which the proportional part alone opens the valve to its cap, m.
fn saturating_error_m(machine: &Machine) -> f64 {
    let h = &machine.hydraulics;
    h.manual_opening_max / h.manual_kp_per_mm * 1e-3
}
