//! Whether a reading alternates between two values: its message has two senders on one interface.

use crate::Series;

/// Samples below which nothing is said.
const SAMPLES_MIN: usize = 200;
/// From one sample to the next a reading changes so many times as much as from one to the next but one. Noise
/// changes as much either way, and what moves changes more over two.
const ALTERNATES: f64 = 3.0;
/// By so many counts of the signal on average: a reading on the border of two counts goes to and fro by one.
const COUNTS: f64 = 4.0;

/// Whether `series`, of which one count is `step`, does.
#[allow(clippy::cast_precision_loss)] // samples of a log
pub(super) fn alternates(series: &Series, step: f64) -> bool {
    let count = series.len();
    if count < SAMPLES_MIN {
        return false;
    }
    let (mut by_one, mut by_two) = (0.0, 0.0);
    let mut before = [f64::NAN; 2];
    for (_, value) in series.iter() {
        let [last, last_but_one] = before;
        if !last_but_one.is_nan() {
            by_one += (value - last).abs();
            by_two += (value - last_but_one).abs();
        }
        before = [value, last];
    }
    by_one > ALTERNATES * by_two && by_one > COUNTS * step * count as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    fn series(of: impl Fn(f64) -> f64) -> Series {
        let mut series = Series::default();
        for i in 0..600 {
            series.push(0.005 * f64::from(i), of(f64::from(i)));
        }
        series
    }

    #[test]
    fn two_that_move_apart_alternate() {
        let turn = |i: f64| if i % 2.0 == 0.0 { (0.01 * i).sin() } else { 1.0 + (0.013 * i).cos() };
        assert!(alternates(&series(turn), 0.001));
    }

    #[test]
    fn what_moves_jumps_shakes_or_is_coarse_does_not() {
        let hash = |i: f64| (1e4 * (i * i + 0.3).sin()).fract();
        for one in [
            series(|i| (0.05 * i).sin()),
            series(hash),
            series(|i| f64::from(u8::from(i > 300.0))),
            series(|i| f64::from(u8::from(i == 300.0))),
            series(|i| if i % 2.0 == 0.0 { 0.0 } else { 0.001 }),
            series(|_| 0.3),
        ] {
            assert!(!alternates(&one, 0.001));
        }
    }
}
