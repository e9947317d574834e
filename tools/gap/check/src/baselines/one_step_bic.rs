//! Fit each effect alone to the error one step ahead; the lowest Bayesian information criterion wins
//! (Schwarz 1978).
//!
//! As it is commonly done: samples are taken as independent, every signal's variance as what is left
//! of it, and no allowance is made for tolerances. A step is a tenth of a second.

use std::collections::BTreeMap;

use nalgebra::{Cholesky, DMatrix, DVector};
use rayon::prelude::*;
use xt28_gap::diagnosis::{Generator, Hypothesis, Inquiry, Signal, Signals, Verdict};
use xt28_sim::Effects;

use super::fitted;
use crate::reply::{Named, Reply};

/// Share of a parameter's tolerance by which it is nudged for its slope: as large as what is looked
/// for, since delays and play do not show on less.
const NUDGE: f64 = 2.0;
/// Shares of the linear step that are tried.
const STEPS: [f64; 4] = [1.0, 0.5, 2.0, 0.2];

/// One-step errors of one generator, by signal.
type Errors = BTreeMap<(Generator, Signal), Vec<f64>>;

pub(super) fn reply(inquiry: &Inquiry) -> Reply {
    let runs = fitted(inquiry);
    let errors =
        |generator: &Generator, effects: &Effects| one_step(*generator, &runs, inquiry, effects);
    let base: Vec<(Generator, Errors)> =
        Generator::all().into_par_iter().map(|g| (g, errors(&g, &inquiry.believed))).collect();
    let known = Hypothesis::all().into_iter().filter(|h| inquiry.catalogue.contains(&h.effect));
    let mut scored: Vec<(f64, Hypothesis)> = known
        .collect::<Vec<_>>()
        .into_par_iter()
        .filter_map(|h| Some((gain(&h, &base, &errors, &inquiry.believed)?, h)))
        .collect();
    scored.sort_by(|(a, _), (b, _)| b.total_cmp(a));
    // Weights of the criterion, exp(-BIC / 2), with no effect at a gain of zero.
    let most = scored.first().map_or(0.0, |(gain, _)| gain.max(0.0));
    let weight = |gain: f64| (0.5 * (gain - most)).exp();
    let total = weight(0.0) + scored.iter().map(|(gain, _)| weight(*gain)).sum::<f64>();
    let named = |(gain, h): &(f64, Hypothesis)| {
        let probability = weight(*gain) / total;
        let stands = probability > 0.5;
        let named = Named::without_probability(h.effect, h.scope);
        Named { probability: Some(probability), stands, ..named }
    };
    let causes: Vec<Named> = scored.iter().take(10).map(named).collect();
    let none = weight(0.0) / total;
    let verdict = if none > 0.5 { Verdict::None } else { Verdict::Effect };
    Reply { verdict, causes, none: Some(none), unknown: Some(0.0) }
}

/// Errors one step ahead from measured state: what each residual grows by in a step.
fn one_step(
    generator: Generator,
    runs: &[Signals],
    inquiry: &Inquiry,
    effects: &Effects,
) -> Errors {
    let mut errors = Errors::new();
    for run in runs {
        for residual in generator.residuals(run, &inquiry.machine, effects) {
            let all = errors.entry((generator, residual.signal)).or_default();
            all.extend(residual.values.windows(2).map(|w| w[1] - w[0]));
        }
    }
    errors
}

/// How far the criterion falls with `h` at its best. `None` where no signal hears of it.
#[allow(clippy::cast_precision_loss)]
fn gain(
    h: &Hypothesis,
    base: &[(Generator, Errors)],
    errors: &(impl Fn(&Generator, &Effects) -> Errors + Sync),
    believed: &Effects,
) -> Option<f64> {
    let heard: Vec<_> = base.iter().filter(|(g, _)| g.hears(h.effect, h.scope)).collect();
    let samples: usize =
        base.iter().flat_map(|(_, e)| e.values()).flatten().filter(|e| e.is_finite()).count();
    let neutral: Vec<f64> = h.effect.parameters.iter().map(|p| p.neutral).collect();
    let at = |values: &[f64]| -> Errors {
        let effects = h.applied(believed, values);
        heard.iter().flat_map(|(generator, _)| errors(generator, &effects)).collect()
    };
    let before: Errors = heard.iter().flat_map(|(_, e)| e.clone()).collect();
    if before.is_empty() {
        return None;
    }
    let mut best = f64::NEG_INFINITY;
    for sign in [1.0, -1.0] {
        let nudges: Vec<f64> = h
            .effect
            .parameters
            .iter()
            .map(|p| {
                (p.neutral + sign * NUDGE * p.tolerance).clamp(p.range[0], p.range[1]) - p.neutral
            })
            .collect();
        let slopes: Vec<Errors> = (0..nudges.len())
            .map(|k| {
                let mut values = neutral.clone();
                values[k] += nudges[k];
                difference(&at(&values), &before)
            })
            .collect();
        let Some(step) = linear_step(&slopes, &before) else { continue };
        for share in STEPS {
            let values: Vec<f64> = (0..nudges.len())
                .map(|k| {
                    let [low, high] = h.effect.parameters[k].range;
                    (neutral[k] + share * step[k] * nudges[k]).clamp(low, high)
                })
                .collect();
            best = best.max(log_ratio(&before, &at(&values)));
        }
    }
    best.is_finite().then(|| best - neutral.len() as f64 * (samples as f64).ln())
}

fn difference(a: &Errors, b: &Errors) -> Errors {
    let less = |(key, a): (&(Generator, Signal), &Vec<f64>)| {
        (*key, a.iter().zip(&b[key]).map(|(a, b)| a - b).collect())
    };
    a.iter().map(less).collect()
}

/// Nudges that together make the squares least, each signal over its variance.
fn linear_step(slopes: &[Errors], before: &Errors) -> Option<Vec<f64>> {
    let n = slopes.len();
    let (mut precision, mut gradient) = (DMatrix::<f64>::zeros(n, n), DVector::<f64>::zeros(n));
    for (key, errors) in before {
        let (square, count) = squares(errors);
        if square <= 0.0 {
            continue;
        }
        let dot = |a: &[f64], b: &[f64]| {
            let finite = a.iter().zip(b).filter(|(a, b)| a.is_finite() && b.is_finite());
            finite.map(|(a, b)| a * b).sum::<f64>() * count / square
        };
        for i in 0..n {
            gradient[i] -= dot(&slopes[i][key], errors);
            for k in 0..n {
                precision[(i, k)] += dot(&slopes[i][key], &slopes[k][key]);
            }
        }
    }
    let ridge = 1e-9 * precision.trace().max(f64::MIN_POSITIVE);
    let precision = precision + DMatrix::identity(n, n) * ridge;
    Some(Cholesky::new(precision)?.solve(&gradient).iter().copied().collect())
}

/// Twice the gain in log likelihood, every signal's variance at its best before and after.
fn log_ratio(before: &Errors, after: &Errors) -> f64 {
    let one = |(key, before): (&(Generator, Signal), &Vec<f64>)| {
        let both = before.iter().zip(&after[key]).filter(|(b, a)| b.is_finite() && a.is_finite());
        let (old, new): (Vec<f64>, Vec<f64>) = both.map(|(b, a)| (*b, *a)).unzip();
        let ((old, count), (new, _)) = (squares(&old), squares(&new));
        if old > 0.0 && new > 0.0 { count * (old / new).ln() } else { 0.0 }
    };
    before.iter().map(one).sum()
}

/// Sum of squares, and how many.
#[allow(clippy::cast_precision_loss)]
fn squares(errors: &[f64]) -> (f64, f64) {
    let finite = errors.iter().filter(|e| e.is_finite());
    (finite.clone().map(|e| e * e).sum(), finite.count() as f64)
}
