//! Squared errors in units of the floor, kept in blocks of time so that they can be drawn anew.
//!
//! Over a whole run errors add up, so blocks of one run are no independent witnesses: there the runs are drawn
//! first, and blocks within those drawn.

use std::collections::BTreeMap;

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::machine_sample::{Horizon, MachineSample, Quantity, floors};
use super::twin::Forecast;

/// Samples of a block: 5 s. Errors of one step and of 5 s that are further apart are taken for independent.
pub(super) const BLOCK: usize = 50;
/// What a number that is not one counts for, floors: a machine that was thrown about.
pub(super) const LOST: f64 = 1.0e3;
/// Draws of a bootstrap.
const DRAWS: usize = 400;
/// Seed of the draws: the same logs give the same intervals.
const SEED: u64 = 0x0078_7432_3867_6170;

/// Squared errors of one block of time, signal by signal.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Squares {
    /// Which run the block is of.
    pub(super) run: usize,
    pub(super) sum: Vec<f64>,
    pub(super) count: Vec<f64>,
}

impl Squares {
    pub(super) fn new(signals: usize) -> Self {
        Self { run: 0, sum: vec![0.0; signals], count: vec![0.0; signals] }
    }

    /// Counts one error of `signal`, in floors.
    pub(super) fn add(&mut self, signal: usize, error: f64) {
        let error = if error.is_finite() { error } else { LOST };
        self.sum[signal] += error * error;
        self.count[signal] += 1.0;
    }

    fn join(&mut self, other: &Self) {
        self.sum.iter_mut().zip(&other.sum).for_each(|(a, b)| *a += b);
        self.count.iter_mut().zip(&other.count).for_each(|(a, b)| *a += b);
    }

    /// Root mean square of each signal that was judged, in floors; the mean of these.
    fn gap(&self) -> f64 {
        let judged = || self.sum.iter().zip(&self.count).filter(|(_, count)| **count > 0.0);
        let total: f64 = judged().map(|(sum, count)| (sum / count).sqrt()).sum();
        #[allow(clippy::cast_precision_loss)]
        let signals = judged().count().max(1) as f64;
        total / signals
    }
}

/// The blocks of one forecast.
pub(super) fn of_forecast(
    measured: &[MachineSample],
    forecast: &Forecast,
    horizon: Horizon,
) -> Vec<Squares> {
    let floors = floors(horizon);
    let pairs: Vec<(&MachineSample, &MachineSample)> =
        measured[forecast.from..].iter().zip(&forecast.samples).collect();
    let block = |samples: &[(&MachineSample, &MachineSample)]| {
        let mut squares = Squares::new(Quantity::ALL.len());
        for (measured, ours) in samples {
            for (k, quantity) in Quantity::ALL.into_iter().enumerate() {
                for c in quantity.columns().filter(|&c| measured[c].is_finite()) {
                    squares.add(k, (ours[c] - measured[c]) / floors[c]);
                }
            }
        }
        squares
    };
    pairs.chunks(BLOCK).map(block).collect()
}

/// Takes `quantity` from the log: it is off by nothing wherever it was judged.
pub(super) fn take_measured(blocks: &mut [Squares], quantity: Quantity) {
    for block in blocks {
        let sums = block.sum.iter_mut().zip(Quantity::ALL);
        sums.filter(|(_, of)| *of == quantity).for_each(|(sum, _)| *sum = 0.0);
    }
}

/// The gap over all blocks: mean over signals of the root mean square, in floors.
pub(super) fn gap(blocks: &[Squares]) -> f64 {
    total(blocks.iter()).gap()
}

/// Root mean square of each signal over all blocks, in floors.
pub(super) fn by_signal(blocks: &[Squares]) -> Vec<f64> {
    let total = total(blocks.iter());
    total.sum.iter().zip(&total.count).map(|(sum, count)| (sum / count.max(1.0)).sqrt()).collect()
}

/// Shrink from `before` to `after`, and its 90 % interval over draws of their blocks, each run's by themselves.
pub(super) fn shrink(before: &[Squares], after: &[Squares]) -> (f64, [f64; 2]) {
    let all: Vec<usize> = (0..before.len()).collect();
    shrink_of([before, after], &[all])
}

/// The same over draws of whole runs, and of blocks within each.
pub(super) fn shrink_by_run(before: &[Squares], after: &[Squares]) -> (f64, [f64; 2]) {
    let mut runs: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    before.iter().enumerate().for_each(|(k, block)| runs.entry(block.run).or_default().push(k));
    shrink_of([before, after], &runs.into_values().collect::<Vec<_>>())
}

/// Shrink over all blocks, and its 90 % interval over draws of `clusters` and of blocks within those.
fn shrink_of([before, after]: [&[Squares]; 2], clusters: &[Vec<usize>]) -> (f64, [f64; 2]) {
    let of = |before: f64, after: f64| if before > 0.0 { 1.0 - after / before } else { 0.0 };
    let whole = of(gap(before), gap(after));
    let mut random = ChaCha8Rng::seed_from_u64(SEED);
    let mut draws: Vec<f64> = (0..DRAWS)
        .map(|_| {
            let mut drawn: Vec<usize> = Vec::with_capacity(before.len());
            for _ in clusters {
                let cluster = match clusters.len() {
                    1 => &clusters[0],
                    n => &clusters[random.random_range(0..n)],
                };
                drawn
                    .extend(cluster.iter().map(|_| cluster[random.random_range(0..cluster.len())]));
            }
            let gap = |all: &[Squares]| total(drawn.iter().map(|&k| &all[k])).gap();
            of(gap(before), gap(after))
        })
        .collect();
    draws.sort_by(f64::total_cmp);
    let at = |share: f64| {
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            clippy::cast_precision_loss
        )]
        let k = (share * DRAWS as f64) as usize;
        draws.get(k).copied().unwrap_or(whole)
    };
    (whole, [at(0.05).min(whole), at(0.95).max(whole)])
}

fn total<'a>(blocks: impl Iterator<Item = &'a Squares>) -> Squares {
    let mut total = Squares::default();
    for block in blocks {
        if total.sum.is_empty() {
            total = Squares::new(block.sum.len());
        }
        total.join(block);
    }
    total
}

#[cfg(test)]
mod tests {
    use super::*;

    fn blocks(errors: &[f64]) -> Vec<Squares> {
        let one = |error: &f64| {
            let mut squares = Squares::new(2);
            squares.add(0, *error);
            squares
        };
        errors.iter().map(one).collect()
    }

    #[test]
    fn the_gap_is_a_mean_over_signals_of_root_mean_squares() {
        let mut squares = Squares::new(3);
        [3.0, 5.0].iter().for_each(|e| squares.add(0, *e));
        squares.add(1, f64::NAN);
        let gap = gap(&[squares]);
        assert!((gap - 0.5 * (17.0_f64.sqrt() + LOST)).abs() < 1e-9, "{gap}");
    }

    #[test]
    fn an_interval_holds_its_estimate_and_widens_with_the_blocks_spread() {
        let before = blocks(&[2.0; 12]);
        let (even, narrow) = shrink(&before, &blocks(&[1.0; 12]));
        assert!((even - 0.5).abs() < 1e-12 && (narrow[1] - narrow[0]).abs() < 1e-12);
        let uneven: Vec<f64> = (0..12).map(|k| if k % 2 == 0 { 0.1 } else { 1.6 }).collect();
        let (estimate, wide) = shrink(&before, &blocks(&uneven));
        assert!(wide[0] < estimate && estimate < wide[1] && wide[1] - wide[0] > 0.1);
        assert_eq!(shrink(&before, &blocks(&uneven)), (estimate, wide));
    }

    #[test]
    fn two_runs_that_differ_are_two_witnesses_and_not_twelve() {
        let of = |errors: [f64; 2]| {
            let each: Vec<f64> = (0..12).map(|k| errors[k / 6]).collect();
            let mut all = blocks(&each);
            all.iter_mut().enumerate().for_each(|(k, block)| block.run = 3 + k / 6);
            all
        };
        let (before, after) = (of([2.0, 2.0]), of([0.2, 1.8]));
        let ((estimate, by_block), (same, by_run)) =
            (shrink(&before, &after), shrink_by_run(&before, &after));
        assert!((estimate - same).abs() < 1e-12);
        assert!((by_run[0] - 0.1).abs() < 1e-9 && (by_run[1] - 0.9).abs() < 1e-9, "{by_run:?}");
        assert!(by_block[0] > 0.15 && by_block[1] < 0.85, "{by_block:?}");
    }
}
