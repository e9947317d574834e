//! What reaches the ECUs, and when: frames that are missing, frames that are late.
//!
//! Commands come every ten milliseconds by one clock. Loss leaves holes in that row and every frame
//! that comes in its place; lateness moves frames off their places and loses none. The expectation is
//! that of the effects' own law, on a long row of frames.

use std::f64::consts::TAU;

use xt28_sim::Effects;

use super::signals::{DT_S, Samples, Signals};

/// What is expected of the row of commands less what was seen, mean of arms' and drive's.
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
/// Period of the two commands, s (the wire contract).
const PERIOD_S: f64 = 0.01;
/// Frames of the row on which an expectation stands.
const ROW: u32 = 1024;

/// Errors over a run.
#[must_use]
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, clippy::cast_precision_loss)]
pub(super) fn bus_errors(signals: &Signals, effects: &Effects) -> BusErrors {
    let expected = Row::of(&expected_times_s(effects), f64::from(ROW) * PERIOD_S);
    let samples = (WINDOW_S / DT_S) as usize;
    let mut errors = BusErrors::default();
    let windows = signals.len / samples;
    for window in 0..windows {
        let from_s = window as f64 * WINDOW_S;
        let seen = signals.command_times_s.each_ref().map(|times| {
            let (a, b) = (
                times.partition_point(|at| *at < from_s),
                times.partition_point(|at| *at < from_s + WINDOW_S),
            );
            Row::of(&times[a..b], WINDOW_S)
        });
        let less = |of: fn(&Row) -> f64| of(&expected) - (of(&seen[0]) + of(&seen[1])) / 2.0;
        let fill = |to: &mut Samples, value: f64| to.extend(std::iter::repeat_n(value, samples));
        fill(&mut errors.missing, less(|row| row.missing));
        fill(&mut errors.out_of_place, less(|row| row.out_of_place));
        fill(&mut errors.uneven, less(|row| row.uneven));
    }
    errors
}

/// What a row of frames looks like.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Row {
    missing: f64,
    out_of_place: f64,
    uneven: f64,
}

impl Row {
    /// Of frames that came at `times_s` within `window_s`.
    #[allow(clippy::cast_precision_loss)]
    fn of(times_s: &[f64], window_s: f64) -> Self {
        if times_s.len() < 2 {
            return Self { missing: 1.0, out_of_place: 0.0, uneven: 0.0 };
        }
        let count = times_s.len() as f64;
        let pointer = |part: fn(f64) -> f64| {
            times_s.iter().map(|at| part(TAU * at / PERIOD_S)).sum::<f64>() / count
        };
        let apart = times_s.windows(2).map(|pair| (pair[1] - pair[0]) / PERIOD_S - 1.0);
        Self {
            missing: 1.0 - count * PERIOD_S / window_s,
            out_of_place: 1.0 - pointer(f64::cos).hypot(pointer(f64::sin)),
            uneven: (apart.map(|by| by * by).sum::<f64>() / (count - 1.0)).sqrt(),
        }
    }
}

/// Instants at which a long row of frames comes under the bus's effects. What chance would draw comes
/// evenly spread instead (multiples of irrational numbers), so that the same belief always gives the
/// same row.
fn expected_times_s(effects: &Effects) -> Vec<f64> {
    let (loss, late) = (effects.bus.frame_loss.share, effects.bus.command_jitter.latest_s);
    let spread = |k: u32, step: f64| (f64::from(k) * step).fract();
    let mut before_s = 0.0_f64;
    (0..ROW)
        .filter_map(|k| {
            let late_s = late * spread(k, 0.754_877_666);
            // Order is kept: a frame waits for the one before it.
            before_s = before_s.max(f64::from(k) * PERIOD_S + late_s);
            (spread(k, 0.569_840_291) >= loss).then_some(before_s)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(loss: f64, late_s: f64) -> Row {
        let mut effects = Effects::default();
        effects.bus.frame_loss.share = loss;
        effects.bus.command_jitter.latest_s = late_s;
        Row::of(&expected_times_s(&effects), f64::from(ROW) * PERIOD_S)
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
        // Holes of one period each: the square of one, for each frame lost.
        assert!((row.uneven - (0.1_f64 / 0.9).sqrt()).abs() < 0.05, "{row:?}");
    }

    #[test]
    fn lateness_moves_frames_and_loses_none() {
        let row = row(0.0, 0.008);
        assert!(row.missing.abs() < 1e-9 && row.out_of_place > 0.5, "{row:?}");
        // Two draws, each over 0.8 of a period.
        assert!((row.uneven - 0.8 / 6.0_f64.sqrt()).abs() < 0.05, "{row:?}");
    }
}
