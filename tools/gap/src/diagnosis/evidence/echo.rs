//! What a cause leaves that is what it explains once more, moved in time.
//!
//! A lag that stands for a delay explains most of a gap and leaves the difference of the two: its own
//! explanation, a few tenths of a second off. A right cause leaves what has nothing to do with it.

use nalgebra::{Cholesky, DMatrix, DVector};

use crate::diagnosis::floor::Signal;
use crate::diagnosis::generator::Generator;

/// How far what is explained may be moved, in samples either way.
const REACH: usize = 3;
/// Taps of the filter that moves it.
const TAPS: usize = 2 * REACH + 1;

/// How much of what one signal leaves is what a belief explains of it, moved in time.
#[derive(Clone, Copy, Debug)]
pub struct Echo {
    /// Who watches it.
    pub generator: Generator,
    /// The signal.
    pub signal: Signal,
    /// What the moved explanation tells of the rest, beyond what it tells where it is: a law that is
    /// wrong in size alone has no echo. Nats, with every tap believed to be about none, give or take one.
    pub nats: f64,
    /// Half the squares of what is explained, floors.
    pub explained: f64,
    /// Independent samples.
    pub samples: f64,
}

impl Echo {
    /// Mean square of what is explained, in units of the floor.
    #[must_use]
    pub fn square(&self) -> f64 {
        2.0 * self.explained / self.samples.max(1.0)
    }
}

/// What a filter by which what is explained becomes what is left has to know of both.
#[derive(Clone, Debug)]
pub(super) struct Filter {
    products: DMatrix<f64>,
    misfits: DVector<f64>,
}

impl Filter {
    pub(super) fn new() -> Self {
        Self { products: DMatrix::zeros(TAPS, TAPS), misfits: DVector::zeros(TAPS) }
    }

    /// Adds a stretch of samples without a hole: what is explained, and what is left.
    pub(super) fn add(&mut self, explained: &[f64], left: &[f64]) {
        let middles = left.iter().skip(REACH);
        for (around, left) in explained.windows(TAPS).zip(middles) {
            let around = DVector::from_column_slice(around);
            self.products.ger(1.0, &around, &around, 1.0);
            self.misfits.axpy(*left, &around, 1.0);
        }
    }

    /// Nats of the echo, and of what is explained.
    pub(super) fn nats(&self) -> [f64; 2] {
        let explained = self.products[(REACH, REACH)];
        let in_place = self.misfits[REACH].powi(2) / (explained + 1.0);
        let precision = &self.products + DMatrix::identity(TAPS, TAPS);
        let taps = Cholesky::new(precision).expect("squares and the identity").solve(&self.misfits);
        [self.misfits.dot(&taps) - in_place, explained].map(|squares| 0.5 * squares.max(0.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Something that moves, `by` samples later.
    fn moving(by: f64) -> Vec<f64> {
        let at = |i: i32| 40.0 * (0.31 * (f64::from(i) - by)).sin() * (0.07 * f64::from(i)).cos();
        (0..300).map(at).collect()
    }

    fn nats(explained: &[f64], left: &[f64]) -> [f64; 2] {
        let mut filter = Filter::new();
        filter.add(explained, left);
        filter.nats()
    }

    #[test]
    fn what_comes_late_leaves_its_echo() {
        let (explained, late) = (moving(0.0), moving(2.0));
        let left: Vec<f64> = late.iter().zip(&explained).map(|(late, now)| late - now).collect();
        let [echo, all] = nats(&explained, &left);
        assert!(echo > 0.1 * all, "{echo} of {all}");
    }

    #[test]
    fn what_is_wrong_in_size_or_has_nothing_to_do_with_it_leaves_none() {
        let explained = moving(0.0);
        let tenth: Vec<f64> = explained.iter().map(|value| 0.1 * value).collect();
        assert!(nats(&explained, &tenth)[0] < 1e-3 * nats(&explained, &tenth)[1]);
        let other: Vec<f64> = (0..300).map(|i| 0.8 * (f64::from(i).powi(2)).sin()).collect();
        assert!(nats(&explained, &other)[0] < 6.0);
    }

    #[test]
    fn nothing_is_moved_across_a_hole() {
        let [explained, left] = [[0.0, 0.0, 0.0, 9.0], [0.0, 0.0, 9.0, 0.0]];
        let mut filter = Filter::new();
        filter.add(&explained, &left);
        filter.add(&explained, &left);
        assert!(filter.nats().iter().all(|nats| *nats == 0.0));
    }
}
