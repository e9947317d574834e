//! What the seals of the cylinders hold as a log begins: strained by what the machine did before, which no log says.
//!
//! It is gone once a rod has slid, and the friction is known from then on. Until then it may be anything up to what
//! breaks the seals away, and is taken where it leaves least of the weight and its place.

use nalgebra::{SMatrix, SVector};
use xt28_machine::{PerWheel, Wheel};

use crate::diagnosis::signals::{DT_S, Samples};

/// A log's first seconds, in which what was there before may still be, s: later an arm has moved, or nobody can
/// part it from a sensor that is off.
const BEGINS_S: f64 = 5.0;
/// Rounds in which the six settle on each other.
const ROUNDS: usize = 100;

/// Friction of one cylinder's seals over a run.
#[derive(Clone, Debug, Default)]
pub(super) struct Seal {
    /// Of a rod whose seals were not strained as the log began, as late as the pressures are, N; empty without any.
    pub(super) friction_n: Samples,
    /// Share of what they held as it began that is left, likewise.
    pub(super) left: Samples,
    /// The most that they hold, N.
    pub(super) most_n: f64,
    /// What they hold as the log begins, N; it acts against extension where positive.
    pub(super) begins_n: f64,
}

impl Seal {
    /// Friction at a sample, N.
    pub(super) fn at_n(&self, sample: usize) -> f64 {
        let of = |samples: &Samples| samples.get(sample).copied().unwrap_or_default();
        of(&self.friction_n) + self.begins_n * of(&self.left)
    }
}

/// Whether a sample is among a log's first seconds.
#[allow(clippy::cast_precision_loss)]
pub(super) fn begins(sample: usize) -> bool {
    sample as f64 * DT_S < BEGINS_S
}

/// What each cylinder's seals hold as the log begins, N, of at most `most_n`. `weigh` says what is left of weight
/// and place over the first seconds with the seals holding so much, in units of what it may be off.
pub(super) fn begun_n(
    most_n: &PerWheel<f64>,
    mut weigh: impl FnMut(&PerWheel<f64>) -> Vec<f64>,
) -> PerWheel<f64> {
    let none = PerWheel::splat(0.0);
    let unheld = weigh(&none);
    let answers = Wheel::ALL.map(|wheel| {
        if most_n[wheel] == 0.0 {
            return vec![0.0; unheld.len()];
        }
        let mut one = none;
        one[wheel] = most_n[wheel];
        weigh(&one).iter().zip(&unheld).map(|(with, without)| with - without).collect()
    });
    // One believes that they hold some of it, either way.
    let mut matrix = SMatrix::<f64, 6, 6>::identity();
    let mut right = SVector::<f64, 6>::zeros();
    for (k, error) in unheld.iter().enumerate().filter(|(_, error)| error.is_finite()) {
        let row = SVector::<f64, 6>::from_fn(|i, _| answers[i][k]);
        if row.iter().all(|by| by.is_finite()) {
            matrix += row * row.transpose();
            right -= row * *error;
        }
    }
    let mut share = SVector::<f64, 6>::zeros();
    for _ in 0..ROUNDS {
        for i in 0..6 {
            let others = matrix.row(i).dot(&share.transpose()) - matrix[(i, i)] * share[i];
            share[i] = ((right[i] - others) / matrix[(i, i)]).clamp(-1.0, 1.0);
        }
    }
    PerWheel::from_fn(|wheel| share[wheel.index()] * most_n[wheel])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What four seals of six hold shows in three numbers at ten instants.
    fn weigh(true_n: [f64; 6], held_n: &PerWheel<f64>) -> Vec<f64> {
        let place = [[1.0, 2.0, 1.0], [1.0, 2.0, -1.0], [1.0, 0.0, 1.0]];
        let place = [&place[..], &[[1.0, 0.0, -1.0], [1.0, -2.0, 1.0], [1.0, -2.0, -1.0]]].concat();
        let sum = |k: usize| -> f64 {
            (0..6).map(|i| place[i][k] * (held_n.0[i] - true_n[i]) / 1000.0).sum()
        };
        (0..10).flat_map(|_| [sum(0), sum(1), sum(2)]).collect()
    }

    #[test]
    fn what_seals_hold_is_what_leaves_least() {
        let true_n = [3e3, 3e3, 1e3, 1e3, 2e3, 2e3];
        let most_n = PerWheel::splat(8e3);
        let held_n = begun_n(&most_n, |held_n| weigh(true_n, held_n));
        let worst = weigh(true_n, &held_n).into_iter().fold(0.0_f64, |most, e| most.max(e.abs()));
        assert!(worst < 0.2, "{worst} of {:?}", weigh(true_n, &PerWheel::splat(0.0)));
    }

    #[test]
    fn seals_hold_no_more_than_breaks_them_away() {
        let most_n = PerWheel::splat(2e3);
        let held_n = begun_n(&most_n, |held_n| weigh([9e3; 6], held_n));
        assert!(held_n.iter().all(|(_, n)| (n - 2e3).abs() < 1.0), "{held_n:?}");
        let none = begun_n(&PerWheel::splat(0.0), |held_n| weigh([9e3; 6], held_n));
        assert!(none.iter().all(|(_, n)| *n == 0.0));
    }
}
