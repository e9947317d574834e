//! What a free model would reach a tenth of a second ahead: each block's error from what is measured
//! and commanded at the same sample, by ridge regression.
//!
//! Fitted on the fit runs, block signal by block signal; each has the ridge that leaves least of a fit run
//! that was left out, "no model" among the choices.

use nalgebra::{Cholesky, DMatrix, DVector};
use rayon::prelude::*;

use super::HowFar;
use super::black_box::commands;
use super::course::{Horizon, Quantity, WIDTH, floors};
use super::one_step::{self, Ahead};
use super::twin::Course;

/// Ridges to choose from, in units of an input's mean square; the last leaves no model.
const RIDGES: [f64; 6] = [1.0e-3, 1.0e-2, 0.1, 1.0, 10.0, f64::INFINITY];

/// Normal equations of one signal on one run.
#[derive(Clone)]
struct Normal {
    matrix: DMatrix<f64>,
    right: DVector<f64>,
    squares: f64,
    samples: f64,
}

impl HowFar {
    /// What a free model leaves of the blocks' errors on the judged runs.
    pub(super) fn free_steps(&self) -> Vec<Ahead> {
        let of = |course: &Course| {
            let ahead = one_step::ahead(&course.signals, &self.machine, &self.believed);
            (ahead, inputs(course))
        };
        let runs: Vec<(Ahead, Vec<DVector<f64>>)> = self.courses.par_iter().map(of).collect();
        let fitted: Vec<usize> = (0..runs.len()).filter(|&k| self.fits(k)).collect();
        let signals = runs.first().map_or(0, |(ahead, _)| ahead.len());
        let weights: Vec<Option<DVector<f64>>> = (0..signals)
            .into_par_iter()
            .map(|j| {
                let normal = |&k: &usize| Normal::of(&runs[k].0[j].1, &runs[k].1);
                let normals: Vec<Normal> = fitted.iter().map(normal).collect();
                let tried = RIDGES.map(|ridge| (left_out(&normals, ridge), ridge));
                let best = tried.into_iter().min_by(|a, b| a.0.total_cmp(&b.0))?;
                total(normals.iter())?.solve(best.1)
            })
            .collect();
        let judged = runs.into_iter().enumerate().filter(|(k, _)| self.judges(*k));
        let after = |(_, (mut ahead, inputs)): (usize, (Ahead, Vec<DVector<f64>>))| {
            for ((_, errors), weights) in ahead.iter_mut().zip(&weights) {
                let Some(weights) = weights else { continue };
                errors.iter_mut().zip(&inputs).for_each(|(error, z)| *error -= weights.dot(z));
            }
            ahead
        };
        judged.map(after).collect()
    }
}

/// Squares left on each run by the model of the others, per sample.
fn left_out(runs: &[Normal], ridge: f64) -> f64 {
    let one = |k: usize| {
        let others = runs.iter().enumerate().filter(|(j, _)| *j != k).map(|(_, run)| run);
        let weights = total(others).and_then(|all| all.solve(ridge));
        runs[k].left(weights.as_ref()) / runs[k].samples.max(1.0)
    };
    (0..runs.len()).map(one).sum()
}

fn total<'a>(mut runs: impl Iterator<Item = &'a Normal>) -> Option<Normal> {
    let mut all = runs.next()?.clone();
    for run in runs {
        all.matrix += &run.matrix;
        all.right += &run.right;
        all.squares += run.squares;
        all.samples += run.samples;
    }
    Some(all)
}

impl Normal {
    fn of(errors: &[f64], inputs: &[DVector<f64>]) -> Self {
        let n = inputs.first().map_or(0, DVector::len);
        let mut normal = Self {
            matrix: DMatrix::zeros(n, n),
            right: DVector::zeros(n),
            squares: 0.0,
            samples: 0.0,
        };
        for (error, z) in errors.iter().zip(inputs).filter(|(error, _)| error.is_finite()) {
            normal.matrix.ger(1.0, z, z, 1.0);
            normal.right.axpy(*error, z, 1.0);
            normal.squares += error * error;
            normal.samples += 1.0;
        }
        normal
    }

    /// Weights with a ridge as large as that share of each input's mean square.
    fn solve(&self, ridge: f64) -> Option<DVector<f64>> {
        if ridge.is_infinite() || self.samples == 0.0 {
            return None;
        }
        let mut matrix = self.matrix.clone();
        for k in 0..matrix.nrows() {
            let own = matrix[(k, k)];
            matrix[(k, k)] += ridge * own + 1.0e-9 * self.samples;
        }
        Some(Cholesky::new(matrix)?.solve(&self.right))
    }

    /// Squares that these weights leave.
    fn left(&self, weights: Option<&DVector<f64>>) -> f64 {
        weights.map_or(self.squares, |w| {
            (self.squares - 2.0 * w.dot(&self.right) + w.dot(&(&self.matrix * w))).max(0.0)
        })
    }
}

/// What is measured, how that changes and what is commanded, sample by sample, in floors.
fn inputs(course: &Course) -> Vec<DVector<f64>> {
    let floors = floors(Horizon::FiveSeconds);
    let commands = commands(&course.signals);
    let at = |k: usize| {
        let (now, before) = (&course.measured[k], &course.measured[k.saturating_sub(1)]);
        let shown = (0..WIDTH).filter(|c| !Quantity::Position.columns().contains(c));
        let state = shown.clone().map(|c| now[c] / floors[c]);
        let change = shown.map(|c| (now[c] - before[c]) / floors[c]);
        let past = commands[k.saturating_sub(1)];
        let all = state.chain(change).chain(commands[k]).chain(past).chain([1.0]);
        DVector::from_vec(all.map(|x| if x.is_finite() { x } else { 0.0 }).collect())
    };
    (0..course.measured.len()).map(at).collect()
}
