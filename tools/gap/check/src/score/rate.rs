//! A score with its interval and the number of cases behind it.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde::Serialize;

use crate::wilson;

/// Resamples of a bootstrap interval, and the seed of its draws.
const RESAMPLES: usize = 2000;
const BOOTSTRAP_SEED: u64 = 28;

/// One score.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Score {
    /// Its value; `NaN` (null in JSON) where no case says anything.
    pub value: f64,
    /// 95 % interval: Wilson's of a share, a bootstrap over cases of anything else.
    pub interval: [f64; 2],
    /// Cases behind it; statements behind an error of calibration, numbers behind a share of intervals.
    pub count: usize,
}

impl Score {
    /// A share: how many of all.
    #[must_use]
    #[allow(clippy::cast_precision_loss)]
    pub fn share(outcomes: impl IntoIterator<Item = bool>) -> Self {
        let outcomes: Vec<bool> = outcomes.into_iter().collect();
        let (hits, of) = (outcomes.iter().filter(|hit| **hit).count(), outcomes.len());
        let value = if of == 0 { f64::NAN } else { hits as f64 / of as f64 };
        Self { value, interval: wilson(hits, of), count: of }
    }

    /// A mean over cases.
    #[must_use]
    pub fn mean(values: impl IntoIterator<Item = f64>) -> Self {
        let values: Vec<f64> = values.into_iter().collect();
        Self::of(&values, average)
    }

    /// Anything that is a function of the cases.
    #[must_use]
    pub fn of<T: Copy>(cases: &[T], statistic: impl Fn(&[T]) -> f64) -> Self {
        if cases.is_empty() {
            return Self { value: f64::NAN, interval: [f64::NAN; 2], count: 0 };
        }
        let mut drawn = drawn_again(cases, RESAMPLES, &statistic);
        Self::drawn(statistic(cases), &mut drawn, cases.len())
    }

    /// `value` of so many cases, which was `drawn` again and again from cases drawn again.
    #[must_use]
    pub(super) fn drawn(value: f64, drawn: &mut [f64], count: usize) -> Self {
        drawn.sort_by(f64::total_cmp);
        let tail = drawn.len() / 40;
        Self { value, interval: [drawn[tail], drawn[drawn.len() - 1 - tail]], count }
    }

    /// What chance alone raises, an error of calibration for one: a function of what all cases say together,
    /// with an interval that cases drawn again and again give, turned about the value. Drawn again the
    /// statistic is raised a second time, so that the plain interval would lie too high. Counts what is said.
    #[must_use]
    pub fn raised<T: Clone>(cases: &[Vec<T>], statistic: impl Fn(&[T]) -> f64) -> Self {
        let said = cases.concat();
        if said.is_empty() {
            return Self::unsaid();
        }
        let spread = Self::of(&cases.iter().collect::<Vec<_>>(), |cases| {
            let said: Vec<T> = cases.iter().flat_map(|case| case.iter().cloned()).collect();
            if said.is_empty() { f64::NAN } else { statistic(&said) }
        });
        let [low, high] = spread.interval.map(|end| (2.0 * spread.value - end).max(0.0));
        Self { value: spread.value, interval: [high, low], count: said.len() }
    }

    /// What nobody has stated.
    #[must_use]
    pub const fn unsaid() -> Self {
        Self { value: f64::NAN, interval: [f64::NAN; 2], count: 0 }
    }
}

/// `statistic` of as many cases drawn from `cases`, `draws` times.
pub(super) fn drawn_again<T: Copy, R>(
    cases: &[T],
    draws: usize,
    statistic: impl Fn(&[T]) -> R,
) -> Vec<R> {
    let mut random = ChaCha8Rng::seed_from_u64(BOOTSTRAP_SEED);
    let draw = |_| {
        let again = cases.iter().map(|_| cases[random.random_range(0..cases.len())]);
        statistic(&again.collect::<Vec<T>>())
    };
    (0..draws).map(draw).collect()
}

/// Mean; `NaN` of nothing.
#[allow(clippy::cast_precision_loss)]
pub(crate) fn average(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_chance_raises_may_be_nothing() {
        // Coins that are said to fall on either side, and do: what is left is chance.
        let cases: Vec<Vec<f64>> = (0..40).map(|i| vec![f64::from(i * 7 % 5 % 2)]).collect();
        let off = |said: &[f64]| (average(said) - 0.5).abs();
        let score = Score::raised(&cases, off);
        assert!(score.interval[0] < 0.01 && score.interval[1] > score.value, "{score:?}");
        assert_eq!(score.count, 40);
        assert!(Score::raised(&[Vec::<f64>::new()], off).value.is_nan());
    }

    #[test]
    fn a_share_and_a_mean_have_value_interval_and_count() {
        let share = Score::share([true, true, false, true]);
        assert!((share.value - 0.75).abs() < 1e-15 && share.count == 4);
        assert_eq!(share.interval, wilson(3, 4));
        assert!(Score::share([]).value.is_nan());
        let values: Vec<f64> = (0..400).map(|i| f64::from(i % 2)).collect();
        let mean = Score::mean(values.iter().copied());
        // Standard error of 400 coins: 0.025.
        assert!((mean.value - 0.5).abs() < 1e-15);
        assert!(
            (mean.interval[0] - 0.451).abs() < 0.008 && (mean.interval[1] - 0.549).abs() < 0.008
        );
        assert_eq!(mean, Score::mean(values));
    }
}
