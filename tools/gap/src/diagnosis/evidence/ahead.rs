//! The evidence of the runs driven and of one that is only foretold: what another drive would add.
//!
//! Signals of both are pooled as those of all runs are, so a difference that stays below a floor is worth
//! as little here as it will be. A foretold run has none of what models leave of one another; it is given
//! its share of what they leave of the runs driven.

use std::borrow::Cow;

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use super::left::cost_of_squares;
use super::watch::Sums;
use super::{Evidence, add_precision, gradient};
use crate::diagnosis::belief::Belief;
use crate::diagnosis::generator::Generator;
use crate::diagnosis::onset::Onset;

/// What models leave of a signal that no run driven has, mean square in floors: half of what they may.
const ORDINARY: f64 = 0.5;

/// Runs that were driven beside one that is foretold.
pub(in crate::diagnosis) struct Ahead<'a> {
    driven: &'a Evidence<'a>,
    foretold: &'a Evidence<'a>,
    /// Of the knobs' precision by both.
    factor: Cholesky<f64, Dyn>,
    /// Of each watch's groups of the foretold run, and those of the runs driven.
    pooled: Vec<Vec<Pooled>>,
    /// Weights of those groups when tolerances are set.
    weights: Vec<Vec<f64>>,
}

/// One group of the foretold run.
#[derive(Clone, Copy)]
struct Pooled {
    /// The same signal's group of the runs driven, if they have it.
    driven: Option<usize>,
    /// Squares that models leave in it.
    ordinary: f64,
}

impl<'a> Ahead<'a> {
    /// Both must have been made around one base with the same knobs; `truth` is what the foretold run was
    /// foretold with.
    #[must_use]
    pub(in crate::diagnosis) fn new(
        driven: &'a Evidence<'a>,
        foretold: &'a Evidence<'a>,
        truth: Belief<'_>,
    ) -> Self {
        let sums = driven.sums(truth, &|_| true);
        let left = driven.remaining(&sums, &driven.step(&sums));
        let mut pooled = Vec::new();
        let mut weights: Vec<Vec<f64>> = Vec::new();
        for ((was, will), squares) in driven.watches.iter().zip(&foretold.watches).zip(&left) {
            let same = |signal| was.stack.groups.iter().position(|group| group.signal == signal);
            let own: Vec<Pooled> = will
                .stack
                .groups
                .iter()
                .map(|group| {
                    let driven = same(group.signal);
                    let each = driven
                        .map_or(ORDINARY, |k| squares[k] / was.stack.groups[k].samples.max(1.0));
                    Pooled { driven, ordinary: each * group.samples }
                })
                .collect();
            weights
                .push(own.iter().map(|one| one.driven.map_or(1.0, |k| was.weights[k])).collect());
            pooled.push(own);
        }
        let mut precision = DMatrix::identity(driven.knobs.len(), driven.knobs.len());
        for watch in &driven.watches {
            add_precision(&mut precision, watch, &watch.weights);
        }
        for (watch, weights) in foretold.watches.iter().zip(&weights) {
            add_precision(&mut precision, watch, weights);
        }
        let factor = Cholesky::new(precision).expect("a sum of squares and the identity");
        Self { driven, foretold, factor, pooled, weights }
    }

    /// What it costs to believe, tolerances at their best in all runs; `only` are the generators that can
    /// differ from the base. What began in the middle of the runs driven is there from the start of the one
    /// foretold.
    #[must_use]
    pub(in crate::diagnosis) fn cost(
        &self,
        belief: Belief<'_>,
        only: &dyn Fn(Generator) -> bool,
    ) -> f64 {
        let was = self.driven.sums(belief, only);
        let will = self.foretold.sums(Belief { onset: Onset::ALWAYS, ..belief }, only);
        let step = self.step(&was, &will);
        let (before, after) =
            (self.driven.remaining(&was, &step), self.foretold.remaining(&will, &step));
        let mut cost = step.norm_squared();
        for (w, pooled) in self.pooled.iter().enumerate() {
            let own = &self.driven.watches[w].stack.groups;
            let mut all: Vec<[f64; 2]> =
                before[w].iter().zip(own).map(|(square, group)| [*square, group.samples]).collect();
            let new = &self.foretold.watches[w].stack.groups;
            for ((one, square), group) in pooled.iter().zip(&after[w]).zip(new) {
                let sum = [square + one.ordinary, group.samples];
                match one.driven {
                    Some(k) => all[k] = [all[k][0] + sum[0], all[k][1] + sum[1]],
                    None => all.push(sum),
                }
            }
            cost +=
                all.iter().map(|[square, samples]| cost_of_squares(*square, *samples)).sum::<f64>();
        }
        cost
    }

    fn step(&self, was: &[Cow<'_, Sums>], will: &[Cow<'_, Sums>]) -> DVector<f64> {
        let mut slope = DVector::zeros(self.driven.knobs.len());
        for (watch, sums) in self.driven.watches.iter().zip(was) {
            gradient(&mut slope, watch, &watch.weights, sums);
        }
        for ((watch, sums), weights) in self.foretold.watches.iter().zip(will).zip(&self.weights) {
            gradient(&mut slope, watch, weights, sums);
        }
        self.factor.solve(&slope)
    }
}
