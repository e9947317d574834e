//! How sure all watches together are of every knob, and where they ask it to go.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use super::watch::{Sums, Watch};

/// Takes what one watch's groups, weighted, ask of the knobs from `slope`.
pub(super) fn gradient(slope: &mut DVector<f64>, watch: &Watch, weights: &[f64], sums: &Sums) {
    for (weight, slopes) in weights.iter().zip(&sums.gradients) {
        for (knob, by) in watch.knobs.iter().zip(slopes.iter()) {
            slope[*knob] -= weight * by;
        }
    }
}

/// Precision of the knobs, in units of their tolerances: one's belief and every watch's word.
pub(super) fn precision(watches: &[Watch], knobs: usize) -> Cholesky<f64, Dyn> {
    let mut precision = DMatrix::<f64>::identity(knobs, knobs);
    for watch in watches {
        add_precision(&mut precision, watch, &watch.weights);
    }
    Cholesky::new(precision).expect("a sum of squares and the identity")
}

/// Adds one watch's word, its groups weighted.
pub(super) fn add_precision(precision: &mut DMatrix<f64>, watch: &Watch, weights: &[f64]) {
    for (weight, product) in weights.iter().zip(&watch.products) {
        for (i, a) in watch.knobs.iter().enumerate() {
            for (j, b) in watch.knobs.iter().enumerate() {
                precision[(*a, *b)] += weight * product[(i, j)];
            }
        }
    }
}
