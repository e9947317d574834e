//! What reaches the ECUs, and when: frames that are missing, frames that are late.
//!
//! Commands come by one clock, every ten milliseconds where a gateway keeps the wire contract. Loss leaves holes in that row and every frame
//! that comes in its place; lateness moves frames off their places and loses none. What is expected is that of
//! the effects' own law, on a long row of frames; how far chance leads from it within a second is what the seconds
//! of the log differ by, whatever is believed: a loss that is believed larger must not excuse more.

#![allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, clippy::cast_precision_loss)]

use std::f64::consts::TAU;

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use xt28_sim::Effects;

use crate::diagnosis::floor::Signal;
use crate::diagnosis::signals::{DT_S, Samples, Signals, command_periods_s};

/// What is expected of the row of commands less what was seen, mean of arms' and drive's; smaller by as
/// much as chance, and what another law would make, is larger than the floor; `NaN` where nobody sent any.
#[derive(Clone, Debug, Default)]
pub(super) struct BusErrors {
    /// Share of frames that are missing.
    pub(super) missing: Samples,
    /// How far frames are from their places: one less the length of their mean pointer on a circle
    /// that is one period round.
    pub(super) out_of_place: Samples,
    /// Root mean square of an interval less the period, over the period.
    pub(super) uneven: Samples,
}

/// Time over which frames are counted, s.
const WINDOW_S: f64 = 1.0;
/// Within this time of a window's beginning and end commands are taken to fill it, s.
const BEGINS_S: f64 = 0.03;
/// Share of what lateness and loss are expected to make of the places and the intervals by which another law of
/// theirs would make more or less: few frames late by much, late by no more than some time, or lost in a row.
const ANOTHER_LAW: f64 = 0.2;
/// Windows of the row on which an expectation stands: chance leaves 0.2 % to a loss of a tenth.
const ROW: u32 = 200;

/// Errors over a run.
#[must_use]
pub(super) fn bus_errors(signals: &Signals, effects: &Effects) -> BusErrors {
    let periods_s = command_periods_s(signals);
    let [arms, drive] = periods_s;
    let by_arms = expected(effects, arms);
    #[allow(clippy::float_cmp)] // one and the same number, mostly
    let expected = if drive == arms { by_arms } else { by_arms.mean(&expected(effects, drive)) };
    let samples = (WINDOW_S / DT_S) as usize;
    let seen: Vec<Option<FrameTiming>> =
        (0..signals.len / samples).map(|window| seen(signals, window as f64, periods_s)).collect();
    let errors_of = |of: fn(&FrameTiming) -> f64, signal: Signal, law: f64| -> Samples {
        let (mean, floor) = (of(&expected), signal.floor().sigma);
        let doubt = (chance(&seen, of) / floor).hypot(law * mean / floor).hypot(1.0);
        let each = seen.iter().map(|row| row.map_or(f64::NAN, |row| (mean - of(&row)) / doubt));
        each.flat_map(|value| std::iter::repeat_n(value, samples)).collect()
    };
    BusErrors {
        missing: errors_of(|row| row.missing, Signal::BusMissing, 0.0),
        out_of_place: errors_of(|row| row.out_of_place, Signal::BusPlace, ANOTHER_LAW),
        uneven: errors_of(|row| row.uneven, Signal::BusUneven, ANOTHER_LAW),
    }
}

/// Mean of what arms' and drive's commands look like within a window; `None` where nobody sent any.
fn seen(signals: &Signals, window: f64, periods_s: [f64; 2]) -> Option<FrameTiming> {
    if !signals.command_times_s.iter().all(|times| spans(times, window)) {
        return None;
    }
    let row = |k: usize| FrameTiming::of_window(&signals.command_times_s[k], window, periods_s[k]);
    Some(row(0).mean(&row(1)))
}

/// Standard deviation from window to window, of windows that follow one another: what sets in once is no
/// chance.
fn chance(seen: &[Option<FrameTiming>], of: fn(&FrameTiming) -> f64) -> f64 {
    let pairs = seen.windows(2).filter_map(|pair| Some(of(&pair[1]?) - of(&pair[0]?)));
    let (count, squares) = pairs.fold((0, 0.0), |(n, sum), by| (n + 1, sum + by * by));
    (squares / f64::from(2 * count.max(1))).sqrt()
}

/// Whether somebody sent commands from the beginning of a window to its end: before the first command and
/// after the last none is missing.
fn spans(times_s: &[f64], window: f64) -> bool {
    let (Some(first), Some(last)) = (times_s.first(), times_s.last()) else { return false };
    let [from, to] = [window, window + 1.0].map(|at| at * WINDOW_S);
    *first <= from + BEGINS_S && *last >= to - BEGINS_S
}

/// How regularly the frames of one window come under an effect, in the mean.
fn expected(effects: &Effects, period_s: f64) -> FrameTiming {
    let times_s = expected_times_s(effects, period_s);
    let rows: Vec<FrameTiming> =
        (1..ROW).map(|k| FrameTiming::of_window(&times_s, f64::from(k), period_s)).collect();
    let mean = |of: fn(&FrameTiming) -> f64| rows.iter().map(of).sum::<f64>() / rows.len() as f64;
    FrameTiming {
        missing: mean(|row| row.missing),
        out_of_place: mean(|row| row.out_of_place),
        uneven: mean(|row| row.uneven),
    }
}

/// How regularly the frames of a row come.
#[derive(Clone, Copy, Debug, PartialEq)]
struct FrameTiming {
    missing: f64,
    out_of_place: f64,
    uneven: f64,
}

impl FrameTiming {
    fn mean(&self, other: &Self) -> Self {
        Self {
            missing: (self.missing + other.missing) / 2.0,
            out_of_place: (self.out_of_place + other.out_of_place) / 2.0,
            uneven: (self.uneven + other.uneven) / 2.0,
        }
    }

    /// Of those of `times_s` that fall within a window, counted from 0.
    fn of_window(times_s: &[f64], window: f64, period_s: f64) -> Self {
        let [from, to] =
            [window, window + 1.0].map(|at| times_s.partition_point(|time| *time < at * WINDOW_S));
        Self::of(&times_s[from..to], WINDOW_S, period_s)
    }

    /// Of frames that came at `times_s` within `window_s`.
    fn of(times_s: &[f64], window_s: f64, period_s: f64) -> Self {
        if times_s.len() < 2 {
            return Self { missing: 1.0, out_of_place: 0.0, uneven: 0.0 };
        }
        let count = times_s.len() as f64;
        let pointer = |part: fn(f64) -> f64| {
            times_s.iter().map(|at| part(TAU * at / period_s)).sum::<f64>() / count
        };
        let apart = times_s.windows(2).map(|pair| (pair[1] - pair[0]) / period_s - 1.0);
        Self {
            missing: 1.0 - count * period_s / window_s,
            out_of_place: 1.0 - pointer(f64::cos).hypot(pointer(f64::sin)),
            uneven: (apart.map(|by| by * by).sum::<f64>() / (count - 1.0)).sqrt(),
        }
    }
}

/// Instants at which a long row of frames comes under the bus's effects. What chance would draw comes
/// from a fixed row of draws, so that the same belief always gives the same frames.
fn expected_times_s(effects: &Effects, period_s: f64) -> Vec<f64> {
    let (loss, late) = (effects.bus.frame_loss.share, effects.bus.command_jitter.latest_s);
    let mut before_s = 0.0_f64;
    let frames = (f64::from(ROW) * WINDOW_S / period_s) as u32;
    let mut random = ChaCha8Rng::seed_from_u64(0);
    (0..frames)
        .filter_map(|k| {
            // Order is kept: a frame waits for the one before it.
            before_s =
                before_s.max((f64::from(k) + 0.5) * period_s + late * random.random::<f64>());
            (random.random::<f64>() >= loss).then_some(before_s)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::super::still::still;
    use super::*;
    use crate::diagnosis::signals::PERIOD_S;

    fn row(loss: f64, late_s: f64) -> FrameTiming {
        let mut effects = Effects::default();
        effects.bus.frame_loss.share = loss;
        effects.bus.command_jitter.latest_s = late_s;
        expected(&effects, PERIOD_S)
    }

    /// A run of ten seconds whose commands come `period_s` apart, all but every tenth.
    fn commanded(period_s: f64) -> Signals {
        let mut signals = still(10);
        let frames = (0..(10.0 / period_s) as u32).filter(|k| k % 10 != 3);
        let times_s: Vec<f64> = frames.map(|k| (f64::from(k) + 0.5) * period_s).collect();
        signals.command_times_s = [times_s.clone(), times_s];
        signals
    }

    #[test]
    fn a_gateway_that_sends_less_often_loses_nothing_by_that() {
        for period_s in [0.01, 0.02, 0.05] {
            let signals = commanded(period_s);
            assert!(command_periods_s(&signals).iter().all(|p| (p - period_s).abs() < 1e-12));
            let mut effects = Effects::default();
            effects.bus.frame_loss.share = 0.1;
            let errors = bus_errors(&signals, &effects);
            let largest = errors.missing.iter().fold(0.0_f64, |most, e| most.max(e.abs()));
            assert!(largest < 1.5, "{period_s}: {largest}");
        }
    }

    #[test]
    fn a_drive_that_is_told_less_often_than_the_arms_loses_nothing_by_that() {
        let mut signals = commanded(0.01);
        let [_, drive] = commanded(0.02).command_times_s;
        signals.command_times_s[1] = drive;
        let mut effects = Effects::default();
        effects.bus.frame_loss.share = 0.1;
        let errors = bus_errors(&signals, &effects);
        let largest = errors.missing.iter().fold(0.0_f64, |most, e| most.max(e.abs()));
        assert!(largest < 1.5, "{largest}");
    }

    #[test]
    fn a_loss_that_is_believed_larger_excuses_no_more() {
        let mut signals = commanded(PERIOD_S);
        let mut random = ChaCha8Rng::seed_from_u64(3);
        let kept = (0..1000).filter(|_| random.random::<f64>() >= 0.08);
        let times_s: Vec<f64> = kept.map(|k| (f64::from(k) + 0.5) * PERIOD_S).collect();
        #[allow(clippy::cast_precision_loss)]
        let lost = 1.0 - times_s.len() as f64 / 1000.0;
        signals.command_times_s = [times_s.clone(), times_s];
        let left = |share: f64| -> f64 {
            let mut effects = Effects::default();
            effects.bus.frame_loss.share = share;
            let errors = bus_errors(&signals, &effects).missing;
            errors.iter().filter(|e| e.is_finite()).map(|e| e * e).sum()
        };
        let shares = (0..100).map(|k| 0.04 + 0.001 * f64::from(k));
        let best = shares.min_by(|a, b| left(*a).total_cmp(&left(*b))).unwrap();
        assert!((best - lost).abs() < 0.005, "{best}, lost are {lost}");
    }

    /// The least that any lateness of ours leaves of frames late by another law, floors.
    fn left_by(late_s: impl Fn(&mut ChaCha8Rng) -> f64) -> f64 {
        let mut signals = commanded(PERIOD_S);
        let mut random = ChaCha8Rng::seed_from_u64(7);
        let mut times_s: Vec<f64> =
            (0..1000).map(|k| (f64::from(k) + 0.5) * PERIOD_S + late_s(&mut random)).collect();
        times_s.sort_by(f64::total_cmp);
        signals.command_times_s = [times_s.clone(), times_s];
        let left = |latest_ms: i32| {
            let mut effects = Effects::default();
            effects.bus.command_jitter.latest_s = f64::from(latest_ms) * 1e-3;
            let errors = bus_errors(&signals, &effects);
            let rms = |all: &Samples| {
                let known: Vec<f64> = all.iter().copied().filter(|e| e.is_finite()).collect();
                (known.iter().map(|e| e * e).sum::<f64>() / known.len() as f64).sqrt()
            };
            rms(&errors.out_of_place).max(rms(&errors.uneven))
        };
        (0..80).map(left).fold(f64::INFINITY, f64::min)
    }

    #[test]
    fn lateness_by_another_law_is_lateness_still() {
        let reordered = left_by(|random| 0.04 * random.random::<f64>());
        let rarely =
            left_by(
                |random| {
                    if random.random::<f64>() < 0.5 { 0.03 * random.random::<f64>() } else { 0.0 }
                },
            );
        let exponential = left_by(|random| -0.01 * (1.0 - random.random::<f64>()).ln());
        let worst = reordered.max(rarely).max(exponential);
        assert!(worst < 1.5, "{reordered:.2} {rarely:.2} {exponential:.2}");
        assert!(left_by(|_| 0.0) < 0.5);
    }

    #[test]
    fn a_sound_row_is_whole_and_even() {
        let row = row(0.0, 0.0);
        assert!(row.missing.abs() < 1e-9 && row.out_of_place < 1e-9 && row.uneven < 1e-6);
    }

    #[test]
    fn loss_leaves_holes_and_nothing_out_of_place() {
        let row = row(0.1, 0.0);
        assert!((row.missing - 0.1).abs() < 0.01, "{row:?}");
        assert!(row.out_of_place < 1e-9, "{row:?}");
        // Holes of any length: p (1 + p) / (1 - p)² is the mean square of what is lost in a row.
        assert!((row.uneven - (0.1_f64 * 1.1).sqrt() / 0.9).abs() < 0.05, "{row:?}");
    }

    #[test]
    fn lateness_moves_frames_and_loses_none() {
        let row = row(0.0, 0.008);
        // The last frame of all may come after the last window.
        assert!(row.missing.abs() < 1e-3 && row.out_of_place > 0.5, "{row:?}");
        // Two draws, each over 0.8 of a period.
        assert!((row.uneven - 0.8 / 6.0_f64.sqrt()).abs() < 0.05, "{row:?}");
    }
}
