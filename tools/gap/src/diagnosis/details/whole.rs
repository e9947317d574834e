//! The whole machine over a run that was not fitted, as foretold with and without the causes: what a shrink
//! over the run looks like.

use std::collections::BTreeMap;

use rayon::prelude::*;

use super::{STEP_S, Trace};
use crate::diagnosis::how_far::{Horizon, HowFar, Quantity, Traces};
use crate::diagnosis::inquiry::Inquiry;
use crate::diagnosis::signals::Samples;
use crate::diagnosis::verdict::{Cause, Diagnosis};
use crate::{Channel, GapError, Series};

/// Pictures at most, of one quantity each.
const TRACES: usize = 4;

/// The channels that part most on that of the runs that were not fitted, or of all where all were, which parts
/// most; nothing where *How far* was not asked, or there is nothing to put in.
///
/// # Errors
/// [`GapError::Command`] for a command that our bus cannot say.
pub(super) fn whole(inquiry: &Inquiry, diagnosis: &Diagnosis) -> Result<Vec<Trace>, GapError> {
    let causes: Vec<Cause> = diagnosis.stood_by().cloned().collect();
    if diagnosis.together.is_none() || causes.is_empty() {
        return Ok(Vec::new());
    }
    let all_fitted = inquiry.runs.iter().all(|run| run.fit);
    let judged = inquiry.runs.iter().filter(|run| all_fitted || !run.fit);
    let judged = Inquiry { runs: judged.cloned().collect(), ..inquiry.clone() };
    let far = HowFar::new(&judged)?;
    let each = (0..judged.runs.len()).into_par_iter().map(|k| {
        let [before, after] = [&[][..], &causes].map(|causes| far.traces(k, causes));
        let run = &judged.runs[k];
        largest(&before, &after, &run.file(), run.fit)
    });
    let each: Vec<Vec<(f64, Trace)>> = each.collect();
    let gap = |traces: &[(f64, Trace)]| traces.iter().map(|(gap, _)| gap).sum::<f64>();
    let most = each.into_iter().max_by(|a, b| gap(a).total_cmp(&gap(b)));
    Ok(most.into_iter().flatten().take(TRACES).map(|(_, trace)| trace).collect())
}

/// The channel of each quantity with the largest gap, squares of floors, the largest first.
fn largest(before: &Traces, after: &Traces, run: &str, fit: bool) -> Vec<(f64, Trace)> {
    let mut worst: BTreeMap<Quantity, (f64, Trace)> = BTreeMap::new();
    for (without, with) in before.channels.iter().zip(&after.channels) {
        let (channel, measured, _) = without;
        let Some((quantity, unit, per_si)) = told(*channel) else { continue };
        let [was, is] = [without, with].map(|(_, _, ours)| errors(measured, ours));
        let square = was.iter().filter(|e| e.is_finite()).map(|e| e * e).sum::<f64>();
        let gap = square / quantity.floor(Horizon::Run).powi(2);
        let scaled = |samples: Samples| samples.into_iter().map(|value| value * per_si).collect();
        let trace = Trace {
            title: format!("{run}: the whole machine, {channel}"),
            unit,
            measured: Some(scaled(every_step(measured))),
            before: scaled(was),
            after: scaled(is),
            fit,
        };
        if worst.get(&quantity).is_none_or(|(most, _)| gap > *most) {
            worst.insert(quantity, (gap, trace));
        }
    }
    let mut all: Vec<(f64, Trace)> = worst.into_values().collect();
    all.sort_by(|(a, _), (b, _)| b.total_cmp(a));
    all
}

/// Quantity of a channel, its unit in a picture, and how many of it make one SI unit.
fn told(channel: Channel) -> Option<(Quantity, &'static str, f64)> {
    let deg = 1.0_f64.to_degrees();
    Some(match channel {
        Channel::Stroke(_) => (Quantity::Stroke, "stroke, mm", 1e3),
        Channel::CylinderLoad(_) => (Quantity::Load, "load, kN", 1e-3),
        Channel::FrontJoint | Channel::RearJoint => (Quantity::Joint, "joint angle, deg", deg),
        Channel::WheelSpeed(_) => (Quantity::WheelSpeed, "wheel speed, rad/s", 1.0),
        Channel::Roll => (Quantity::Roll, "roll, deg", deg),
        Channel::Pitch => (Quantity::Pitch, "pitch, deg", deg),
        Channel::East | Channel::North => (Quantity::Position, "position, m", 1.0),
        Channel::PumpPressure(_) => (Quantity::PumpPressure, "pressure, bar", 1e-5),
        _ => return None,
    })
}

/// What the simulator says less what was measured, every [`STEP_S`]; `NaN` where one of them is silent.
fn errors(measured: &Series, ours: &Series) -> Samples {
    let [measured, ours] = [measured, ours].map(every_step);
    let both = measured.iter().zip(ours.iter().copied().chain(std::iter::repeat(f64::NAN)));
    both.map(|(measured, ours)| ours - measured).collect()
}

/// A series by the step that its instant is next to; `NaN` where there is none.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
fn every_step(series: &Series) -> Samples {
    let mut all = Samples::new();
    for (at_s, value) in series.iter() {
        let step = (at_s / STEP_S).round().max(0.0) as usize;
        all.resize(all.len().max(step + 1), f64::NAN);
        all[step] = value;
    }
    all
}

#[cfg(test)]
mod tests {
    use xt28_machine::Wheel;

    use super::*;

    fn series(values: &[f64]) -> Series {
        (0_u32..).zip(values).map(|(k, value)| (f64::from(k) * STEP_S, *value)).collect()
    }

    #[test]
    fn the_worst_of_each_quantity_comes_once_the_largest_gap_first() {
        let (still, off) = (series(&[0.1; 5]), |by: f64| series(&[0.1 + by; 5]));
        let channel = |channel, ours| (channel, still.clone(), ours);
        let traces = |by: f64| Traces {
            run: "r.log".to_owned(),
            channels: vec![
                channel(Channel::Stroke(Wheel::Fr), off(0.001 * by)),
                channel(Channel::Stroke(Wheel::Fl), off(0.010 * by)),
                channel(Channel::Roll, off(0.002 * by)),
            ],
        };
        let all = largest(&traces(1.0), &traces(0.5), "r.log", false);
        let [(_, stroke), (_, roll)] = &all[..] else { panic!("{all:?}") };
        assert!(stroke.title.contains("stroke.FL") && roll.title.contains("roll"), "{all:?}");
        let mm = |samples: &Samples| samples.iter().map(|v| v.round()).collect::<Vec<_>>();
        assert_eq!(mm(&stroke.before), [10.0; 5]);
        assert_eq!(mm(&stroke.after), [5.0; 5]);
        assert_eq!(mm(stroke.measured.as_ref().unwrap()), [100.0; 5]);
    }

    #[test]
    fn where_nothing_was_measured_or_foretold_there_is_no_error() {
        let ours = series(&[0.0, 1.0]);
        let measured: Series = [(0.0, 0.0), (0.2, 3.0)].into_iter().collect();
        let errors = errors(&measured, &ours);
        assert_eq!(errors.len(), 3);
        assert!(errors[0] == 0.0 && errors[1].is_nan() && errors[2].is_nan());
    }
}
