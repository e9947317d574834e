//! How strong a ridge a free model needs: what it makes of data that it was not shown.
//!
//! Whole runs are left out where there are three or more. Of one or two, blocks of time are left out
//! with the samples about them, as one run left out would leave no other manoeuvre to learn from; but
//! blocks of a run are alike, so of ridges that do about as well on them the strongest is taken, by one
//! standard error of what is left (Breiman and others, *Classification and Regression Trees*, 1984).
//! The strongest of all leaves no model.

/// Ridges to choose from, in units of an input's mean square, the strongest first: no model.
pub(super) const RIDGES: [f64; 7] = [f64::INFINITY, 10.0, 1.0, 0.1, 1.0e-2, 1.0e-3, 1.0e-4];
/// Fewer runs than this are left out in blocks.
const WHOLE_RUNS: usize = 3;
/// Blocks of a run: some 8 s of a usual one.
const BLOCKS: usize = 4;
/// Samples before and after a block that are not learnt from either: 2 s.
const APART: usize = 20;

/// What is left out at a time: samples of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Fold {
    run: usize,
    from: usize,
    end: usize,
}

impl Fold {
    /// Whether the model is judged on this sample.
    pub(super) const fn judges(&self, run: usize, sample: usize) -> bool {
        run == self.run && self.from <= sample && sample < self.end
    }

    /// Whether the model is fitted on this sample.
    pub(super) const fn fits(&self, run: usize, sample: usize) -> bool {
        run != self.run || sample + APART < self.from || sample >= self.end.saturating_add(APART)
    }
}

/// What is left out in turn of fit runs, each with its number and samples.
pub(super) fn folds(runs: &[(usize, usize)]) -> Vec<Fold> {
    if runs.len() >= WHOLE_RUNS {
        return runs.iter().map(|&(run, _)| Fold { run, from: 0, end: usize::MAX }).collect();
    }
    let blocks = |&(run, samples): &(usize, usize)| {
        let edge = move |k: usize| k * samples / BLOCKS;
        (0..BLOCKS).map(move |k| Fold { run, from: edge(k), end: edge(k + 1) })
    };
    runs.iter().flat_map(blocks).filter(|fold| fold.from < fold.end).collect()
}

/// The ridge to take by what each of [`RIDGES`] leaves of each of `folds`.
pub(super) fn choose(by_fold: &[[f64; RIDGES.len()]], folds: &[Fold]) -> f64 {
    let of = |k: usize| by_fold.iter().map(|left| left[k]).collect();
    strongest(&(0..RIDGES.len()).map(of).collect::<Vec<_>>(), folds)
}

/// The ridge that leaves least of whole runs or, of blocks, the strongest that leaves no more than that
/// within a standard error. `left` is what each of [`RIDGES`] leaves of each of `folds`.
#[allow(clippy::cast_precision_loss)]
fn strongest(left: &[Vec<f64>], folds: &[Fold]) -> f64 {
    let are_runs = folds.iter().all(|fold| fold.end == usize::MAX);
    let mean = |all: &[f64]| all.iter().sum::<f64>() / all.len().max(1) as f64;
    let Some(best) = left.iter().min_by(|a, b| mean(a).total_cmp(&mean(b))) else {
        return f64::INFINITY;
    };
    let as_good = |of: &&Vec<f64>| {
        let apart: Vec<f64> = of.iter().zip(best).map(|(of, best)| of - best).collect();
        let (folds, middle) = (apart.len() as f64, mean(&apart));
        let squares: f64 = apart.iter().map(|x| (x - middle).powi(2)).sum();
        let error = (squares / (folds * (folds - 1.0)).max(1.0)).sqrt();
        middle <= if are_runs { 0.0 } else { error }
    };
    left.iter().position(|of| as_good(&of)).map_or(f64::INFINITY, |k| RIDGES[k])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_runs_are_left_out_in_blocks_and_many_as_they_are() {
        for runs in [vec![(4, 300)], vec![(0, 300), (2, 301)]] {
            let all = folds(&runs);
            assert_eq!(all.len(), BLOCKS * runs.len());
            for &(run, samples) in &runs {
                for sample in 0..samples {
                    let judging = all.iter().filter(|fold| fold.judges(run, sample)).count();
                    assert_eq!(judging, 1, "each sample is judged once");
                }
            }
        }
        let second = folds(&[(4, 300)])[1];
        let fitted: Vec<usize> = (0..300).filter(|&k| second.fits(4, k)).collect();
        assert_eq!((fitted[54], fitted[55]), (54, 170), "2 s about 75..150 are not fitted");
        assert!(second.fits(3, 100) && !second.judges(3, 100));
        let whole = folds(&[(0, 9), (1, 9), (5, 9)]);
        assert_eq!(whole.len(), 3);
        assert!(whole[2].judges(5, 8) && !whole[2].fits(5, 8) && whole[2].fits(1, 8));
        assert!(folds(&[]).is_empty() && folds(&[(0, 0)]).is_empty());
    }

    #[test]
    fn ties_leave_no_model_nor_does_chance_of_a_run_s_own_blocks() {
        let [blocks, runs] = [folds(&[(0, 300)]), folds(&[(0, 9), (1, 9), (2, 9), (3, 9)])];
        let with = |best: &[f64], folds: &[Fold]| {
            let mut left = vec![vec![2.0, 3.0, 2.0, 3.0]; RIDGES.len()];
            left[4] = best.to_vec();
            strongest(&left, folds)
        };
        for folds in [&blocks, &runs] {
            assert!(with(&[2.0, 3.0, 2.0, 3.0], folds).is_infinite(), "all alike");
            assert!((with(&[1.6, 2.5, 1.5, 2.7], folds) - RIDGES[4]).abs() < 1e-12);
            assert!(
                strongest(&[], folds).is_infinite()
                    && strongest(&vec![vec![]; 7], folds).is_infinite()
            );
        }
        let on_one_fold_alone = [0.5, 3.2, 2.3, 3.1];
        assert!(with(&on_one_fold_alone, &blocks).is_infinite(), "blocks of a run are alike");
        assert!((with(&on_one_fold_alone, &runs) - RIDGES[4]).abs() < 1e-12, "runs are not");
    }
}
