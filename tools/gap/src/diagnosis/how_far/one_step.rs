//! A tenth of a second ahead: blocks on measured inputs, set anew at every sample.
//!
//! Of the whole machine a tenth of a second says little: setting it down on measured states moves it by
//! more than an effect does in that time. On measured inputs every block is set anew by itself. What a
//! block adds up (a stroke) is judged by what its error grows by from one sample to the next; what it says
//! at once (a torque, an opening, an attitude, a weight) by its error.

use xt28_machine::{Machine, Wheel};
use xt28_sim::Effects;

use super::squares::{BLOCK, Squares};
use crate::diagnosis::floor::Signal;
use crate::diagnosis::generator::{Generator, Residual, STEP_S};
use crate::diagnosis::signals::Signals;

/// What every block's signal lacks a tenth of a second ahead, in floors; `NaN` where nothing can be said.
pub(super) type OneStepErrors = Vec<(Signal, Vec<f64>)>;

/// Whether a block adds this signal up over time.
const fn adds_up(signal: Signal) -> bool {
    matches!(signal, Signal::Stroke)
}

/// What each block's signal lacks on one run.
pub(super) fn ahead(s: &Signals, machine: &Machine, effects: &Effects) -> OneStepErrors {
    let of = |residual: Residual| {
        let Residual { signal, mut values, .. } = residual;
        if adds_up(signal) {
            for k in (1..values.len()).rev() {
                values[k] -= values[k - 1];
            }
            if let Some(first) = values.first_mut() {
                *first = f64::NAN;
            }
        }
        (signal, values)
    };
    let all = Generator::all().into_iter();
    all.flat_map(|generator| generator.residuals(s, machine, effects)).map(of).collect()
}

/// `before` until `since_s`, `after` from then on.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
pub(super) fn splice(
    before: OneStepErrors,
    mut after: OneStepErrors,
    since_s: f64,
) -> OneStepErrors {
    let since = (since_s / STEP_S).ceil() as usize;
    for ((_, after), (_, before)) in after.iter_mut().zip(before) {
        let until = since.min(after.len()).min(before.len());
        after[..until].copy_from_slice(&before[..until]);
    }
    after
}

/// Squares of several residuals, those of the wheels' speeds taken together and those of their touch. Two that differ in what can be
/// judged are made alike by `mask`, whose own gaps count.
#[allow(clippy::ptr_arg)] // The name says more than a slice of pairs.
pub(super) fn squares(ahead: &OneStepErrors, mask: &OneStepErrors) -> Vec<Squares> {
    let kind = |signal: &Signal| match signal {
        Signal::WheelSpeed(_) => Signal::WheelSpeed(Wheel::Fr),
        Signal::Contact(_) => Signal::Contact(Wheel::Fr),
        other => *other,
    };
    let mut kinds: Vec<Signal> = ahead.iter().map(|(signal, _)| kind(signal)).collect();
    kinds.sort();
    kinds.dedup();
    let len = ahead.iter().map(|(_, values)| values.len()).max().unwrap_or(0);
    let mut blocks = vec![Squares::new(kinds.len()); len.div_ceil(BLOCK)];
    for ((signal, values), (_, judged)) in ahead.iter().zip(mask) {
        let k = kinds.binary_search(&kind(signal)).expect("every kind is listed");
        for (i, (value, judged)) in values.iter().zip(judged).enumerate() {
            if judged.is_finite() {
                // What the other cannot judge here is no worse than what it was to be set against.
                blocks[i / BLOCK].add(k, if value.is_finite() { *value } else { *judged });
            }
        }
    }
    blocks
}

#[cfg(test)]
mod tests {
    use super::super::squares::gap;
    use super::*;

    /// Six wheels that seem to hang count no more than one stroke.
    #[test]
    fn what_each_wheel_has_counts_once_for_all_wheels() {
        let of = |signal, value| (signal, vec![value; BLOCK]);
        let mut ahead = vec![of(Signal::Stroke, 2.0)];
        for wheel in Wheel::ALL {
            ahead.extend([of(Signal::Contact(wheel), 4.0), of(Signal::WheelSpeed(wheel), 6.0)]);
        }
        let gap = gap(&squares(&ahead, &ahead));
        assert!((gap - 4.0).abs() < 1e-12, "{gap}");
    }
}
