//! Readings without their noise and steps, and their slopes.

use super::uncut::{CUT_M, jumped_m};
use super::{DT_S, Samples};

/// A reading of a stroke that becomes another at once, as no rod moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StrokeJump {
    /// When, s.
    pub at_s: f64,
    /// By how much, m.
    pub by_m: f64,
    /// Reading before it, m.
    pub from_m: f64,
}

/// How an arm swings by the readings of its stroke.
pub(super) struct Swing {
    /// Smooth readings but for what they have jumped by, m: a sensor that comes loose moves no arm.
    moved_m: Samples,
    /// What they have jumped by, m.
    jumped_m: Samples,
}

impl Swing {
    /// By the readings of a stroke, which came where `fresh` says so.
    pub(super) fn new(reading_m: &Samples, fresh: &[bool]) -> Self {
        let jumped_m = jumped_m(reading_m, fresh);
        let both = reading_m.iter().zip(&jumped_m);
        let moved_m = smooth(&both.map(|(reading_m, jumped_m)| reading_m - jumped_m).collect());
        Self { moved_m, jumped_m }
    }

    /// Smooth stroke as it is read, m.
    pub(super) fn stroke_m(&self) -> Samples {
        let both = self.moved_m.iter().zip(&self.jumped_m);
        both.map(|(moved_m, jumped_m)| moved_m + jumped_m + 0.5 * CUT_M).collect()
    }

    /// Where readings jump.
    pub(super) fn jumps(&self) -> impl Iterator<Item = StrokeJump> {
        let pairs = self.jumped_m.windows(2).enumerate();
        pairs.filter(|(_, pair)| pair[0] != pair[1]).map(|(i, pair)| StrokeJump {
            at_s: (i + 1) as f64 * DT_S,
            by_m: pair[1] - pair[0],
            from_m: self.moved_m[i] + pair[0],
        })
    }

    /// Its rate, m/s.
    pub(super) fn rate_m_s(&self) -> Samples {
        slope_over(&self.moved_m, 1)
    }
}

/// Slope of a quantised reading over 0.2 s.
pub(super) fn slope(samples: &Samples) -> Samples {
    slope_over(samples, 10)
}

/// Central difference over twice `half` samples, one-sided at the ends.
#[allow(clippy::cast_precision_loss)]
pub(in crate::diagnosis) fn slope_over(samples: &Samples, half: usize) -> Samples {
    let end = samples.len().saturating_sub(1);
    (0..samples.len())
        .map(|i| {
            let (from, to) = (i.saturating_sub(half), (i + half).min(end));
            if from == to {
                0.0
            } else {
                (samples[to] - samples[from]) / ((to - from) as f64 * DT_S)
            }
        })
        .collect()
}

/// Samples to either side that [`smooth`] looks at.
pub(in crate::diagnosis) const SMOOTHED: usize = 30;

/// What noise and steps of reading leave: a triangle of 0.6 s around each sample.
#[must_use]
pub(in crate::diagnosis) fn smooth(raw: &Samples) -> Samples {
    moving_mean(&moving_mean(raw, 0.3), 0.3)
}

/// Mean over `window_s` around each sample; shorter at the ends.
#[must_use]
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, clippy::cast_precision_loss)]
pub(in crate::diagnosis) fn moving_mean(samples: &[f64], window_s: f64) -> Samples {
    let half = (0.5 * window_s / DT_S) as usize;
    let mut sums = Vec::with_capacity(samples.len() + 1);
    let mut sum = 0.0;
    sums.push(sum);
    for value in samples {
        sum += value;
        sums.push(sum);
    }
    (0..samples.len())
        .map(|i| {
            let (from, to) = (i.saturating_sub(half), (i + half + 1).min(samples.len()));
            (sums[to] - sums[from]) / (to - from) as f64
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sensor_that_comes_loose_moves_no_arm() {
        let moves_m = |i: usize| ((170 + i / 10) as f64) * CUT_M;
        let loose: Samples =
            (0..400).map(|i| moves_m(i) + if i < 200 { 0.0 } else { 0.024 }).collect();
        let swing = Swing::new(&loose, &[true; 400]);
        let (stroke_m, rate_m_s) = (swing.stroke_m(), swing.rate_m_s());
        // But for the step that it moved by as it jumped.
        assert!(rate_m_s[60..340].iter().all(|rate| (rate - 0.01).abs() < 4e-3));
        let [StrokeJump { at_s, by_m, from_m }] = swing.jumps().collect::<Vec<_>>()[..] else {
            panic!("it jumps once")
        };
        assert!((at_s - 2.0).abs() < 1e-9 && (by_m - 0.025).abs() < 1e-9, "{at_s} {by_m}");
        assert!((from_m - 0.189).abs() < 2e-3, "{from_m}");
        assert!((stroke_m[200] - stroke_m[199] - 0.025).abs() < 1e-3);
        // Over a gap of the log the rod may have moved.
        let fresh: Vec<bool> = (0..400).map(|i| !(190..200).contains(&i)).collect();
        assert!(Swing::new(&loose, &fresh).rate_m_s()[200] > 0.05);
    }

    #[test]
    fn a_moving_mean_keeps_a_line_and_flattens_a_spike() {
        let line: Vec<f64> = (0..400).map(f64::from).collect();
        let mean = moving_mean(&line, 1.0);
        assert!((mean[200] - 200.0).abs() < 1e-9);
        let mut spike = vec![0.0; 400];
        spike[200] = 101.0;
        assert!((moving_mean(&spike, 1.0)[180] - 1.0).abs() < 1e-9);
        assert_eq!(moving_mean(&spike, 1.0)[100], 0.0);
    }
}
