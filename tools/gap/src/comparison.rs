//! Ours against the log, signal by signal, with the bounds that a replay of the nominal machine
//! must keep.

use std::collections::BTreeMap;

use serde::Serialize;
use xt28_machine::Wheel;

use crate::channel::{PumpSide, SteerSide};
use crate::{Channel, Errors, Series};

/// Bounds on the RMSE of a signal, in the row's unit.
const STROKE_MM: f64 = 5.0;
const JOINT_DEG: f64 = 0.5;
const WHEEL_SPEED_M_S: f64 = 0.02;
const ATTITUDE_DEG: f64 = 0.3;
const LOAD_SUM_PERCENT: f64 = 2.0;

/// One signal of a replay against the log: a row of its table.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SignalComparison {
    /// The channel's name; `wheel_load.sum` for the sum of all six.
    pub signal: String,
    /// Unit of the errors below.
    pub unit: &'static str,
    /// The errors.
    #[serde(flatten)]
    pub errors: Errors,
    /// Largest RMSE allowed; `None` where the signal only informs.
    pub bound: Option<f64>,
    /// Whether the bound is kept; `None` where the signal only informs.
    pub passed: Option<bool>,
}

/// A group of channels, shown in one unit and held to one bound.
struct Group {
    channels: Vec<Channel>,
    unit: &'static str,
    per_si: f64,
    bound: Option<f64>,
}

/// All rows: those with a bound first, then those that inform.
///
/// A signal is in bounds if its **RMSE** over the run is; the largest error stands beside it. An
/// instant is worse measured by one sample of a quantised signal than a run by all of them, and a
/// single tick's delay at a step of the throttle would fail a bound on the largest error.
pub(crate) fn rows(
    log: &BTreeMap<Channel, Series>,
    ours: &BTreeMap<Channel, Series>,
    wheel_radius_m: f64,
) -> Vec<SignalComparison> {
    let mut rows = Vec::new();
    let groups = groups(wheel_radius_m);
    let (judged, informing): (Vec<_>, Vec<_>) = groups.iter().partition(|g| g.bound.is_some());
    rows.extend(judged.iter().flat_map(|group| group.rows(log, ours)));
    rows.extend(load_sum(log, ours));
    rows.extend(informing.iter().flat_map(|group| group.rows(log, ours)));
    rows
}

fn groups(wheel_radius_m: f64) -> Vec<Group> {
    let group =
        |channels: Vec<Channel>, unit, per_si, bound| Group { channels, unit, per_si, bound };
    let wheels = |make: fn(Wheel) -> Channel| Wheel::ALL.map(make).to_vec();
    let deg = 1.0_f64.to_degrees();
    vec![
        group(wheels(Channel::Stroke), "mm", 1e3, Some(STROKE_MM)),
        group(vec![Channel::FrontJoint, Channel::RearJoint], "deg", deg, Some(JOINT_DEG)),
        group(wheels(Channel::WheelSpeed), "m/s", wheel_radius_m, Some(WHEEL_SPEED_M_S)),
        group(vec![Channel::Roll, Channel::Pitch], "deg", deg, Some(ATTITUDE_DEG)),
        group(wheels(Channel::WheelLoad), "kN", 1e-3, None),
        group(wheels(Channel::CylinderLoad), "kN", 1e-3, None),
        group(wheels(Channel::BorePressure), "bar", 1e-5, None),
        group(wheels(Channel::RodPressure), "bar", 1e-5, None),
        group(wheels(Channel::RetractCurrent), "mA", 1e3, None),
        group(wheels(Channel::ExtendCurrent), "mA", 1e3, None),
        group(SteerSide::ALL.map(Channel::SteerCurrent).to_vec(), "mA", 1e3, None),
        group(PumpSide::ALL.map(Channel::PumpCurrent).to_vec(), "mA", 1e3, None),
        group(wheels(Channel::MotorCurrent), "mA", 1e3, None),
        group(PumpSide::ALL.map(Channel::PumpPressure).to_vec(), "bar", 1e-5, None),
        group(vec![Channel::East, Channel::North], "m", 1.0, None),
    ]
}

impl Group {
    fn rows(
        &self,
        log: &BTreeMap<Channel, Series>,
        ours: &BTreeMap<Channel, Series>,
    ) -> Vec<SignalComparison> {
        let row = |channel: &Channel| {
            let errors = Errors::between(log.get(channel)?, ours.get(channel)?)?;
            Some(SignalComparison::new(
                channel.to_string(),
                self.unit,
                errors.scaled(self.per_si),
                self.bound,
            ))
        };
        self.channels.iter().filter_map(row).collect()
    }
}

/// The sum of the wheel loads, as a share of its mean in the log.
fn load_sum(
    log: &BTreeMap<Channel, Series>,
    ours: &BTreeMap<Channel, Series>,
) -> Option<SignalComparison> {
    let (log, ours) = (sum_of_loads(log)?, sum_of_loads(ours)?);
    let errors = Errors::between(&log, &ours)?;
    #[allow(clippy::cast_precision_loss)] // a log of 2^53 samples does not exist
    let mean_n = log.iter().map(|(_, value)| value).sum::<f64>() / log.len() as f64;
    let percent = errors.scaled(100.0 / mean_n);
    Some(SignalComparison::new("wheel_load.sum".to_owned(), "%", percent, Some(LOAD_SUM_PERCENT)))
}

/// Sum of the six wheel loads, N; `None` where one of them is not there.
pub(crate) fn sum_of_loads(series: &BTreeMap<Channel, Series>) -> Option<Series> {
    let parts = Wheel::ALL.map(|wheel| series.get(&Channel::WheelLoad(wheel)));
    let parts: Vec<&Series> = parts.into_iter().collect::<Option<_>>()?;
    Some(Series::sum(&parts))
}

impl SignalComparison {
    fn new(signal: String, unit: &'static str, errors: Errors, bound: Option<f64>) -> Self {
        Self { signal, unit, errors, bound, passed: bound.map(|bound| errors.rmse <= bound) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn constant(value: f64) -> Series {
        (0..10_u32).map(|i| (f64::from(i), value)).collect()
    }

    fn machine(stroke_m: f64, load_n: f64) -> BTreeMap<Channel, Series> {
        let strokes = Wheel::ALL.map(|w| (Channel::Stroke(w), constant(stroke_m)));
        let loads = Wheel::ALL.map(|w| (Channel::WheelLoad(w), constant(load_n)));
        strokes.into_iter().chain(loads).collect()
    }

    #[test]
    fn a_bound_is_kept_up_to_its_last_millimetre_and_no_further() {
        let log = machine(0.170, 20_000.0);
        let row = |stroke_m, load_n, signal: &str| {
            let rows = rows(&log, &machine(stroke_m, load_n), 0.74);
            rows.into_iter().find(|row| row.signal == signal).unwrap()
        };
        assert_eq!(row(0.1749, 20_000.0, "stroke.FR").passed, Some(true));
        let out = row(0.1751, 20_000.0, "stroke.FR");
        assert_eq!(out.passed, Some(false));
        assert!((out.errors.rmse - 5.1).abs() < 1e-9 && (out.errors.bias - 5.1).abs() < 1e-9);
        assert_eq!(row(0.17, 20_390.0, "wheel_load.sum").passed, Some(true));
        assert_eq!(row(0.17, 20_410.0, "wheel_load.sum").passed, Some(false));
        assert_eq!(row(0.17, 30_000.0, "wheel_load.FR").passed, None);
    }

    #[test]
    fn judged_signals_stand_before_those_that_inform() {
        let rows = rows(&machine(0.17, 1.0), &machine(0.17, 1.0), 0.74);
        let judged: Vec<bool> = rows.iter().map(|row| row.bound.is_some()).collect();
        assert!(judged.is_sorted_by(|a, b| a >= b), "{judged:?}");
        assert_eq!(rows.len(), 13);
    }
}
