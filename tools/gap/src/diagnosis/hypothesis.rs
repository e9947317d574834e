//! One effect at one scope, fitted to the logs.

use xt28_sim::Effects;
use xt28_sim::effects::{CATALOGUE, Effect, Parameter, Scope};

use super::evidence::Evidence;
use super::generator::Generator;

/// An effect at a scope.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hypothesis {
    /// Which effect.
    pub effect: &'static Effect,
    /// On which wheels.
    pub scope: Scope,
}

/// A hypothesis with its parameters at their best.
#[derive(Clone, Debug)]
pub struct Fit {
    /// What was fitted.
    pub hypothesis: Hypothesis,
    /// One value a parameter.
    pub values: Vec<f64>,
    /// What is left.
    pub cost: f64,
    /// Logarithm of the evidence, less that of the base.
    pub log_evidence: f64,
}

impl Hypothesis {
    /// Every effect at every scope it can have.
    #[must_use]
    pub fn all() -> Vec<Self> {
        let scopes = |effect: &'static Effect| {
            let scopes = if effect.has_scope() { &Scope::ALL[..] } else { &Scope::ALL[..1] };
            scopes.iter().map(move |&scope| Self { effect, scope })
        };
        CATALOGUE.iter().flat_map(scopes).collect()
    }

    /// `base` with this effect's parameters at `values`.
    #[must_use]
    pub fn applied(&self, base: &Effects, values: &[f64]) -> Effects {
        let mut effects = base.clone();
        for (parameter, value) in self.effect.parameters.iter().zip(values) {
            parameter.set(&mut effects, self.scope, *value);
        }
        effects
    }

    /// Best values by parabolas along each parameter, from the best of several starts.
    #[must_use]
    pub fn fit(&self, evidence: &Evidence<'_>, base: f64) -> Fit {
        let only = |generator: Generator| generator.hears(self.effect, self.scope);
        let cost = |values: &[f64]| {
            let clamped = self.clamped(values);
            let effects = self.applied(&evidence.base, &clamped);
            let of = |(p, v): (&Parameter, &f64)| ((v - p.neutral) / wide(p)).powi(2);
            let prior: f64 = self.effect.parameters.iter().zip(values).map(of).sum();
            evidence.cost(&effects, &only) + prior
        };
        let starts = self.starts().into_iter().map(|start| (cost(&start), start));
        let (_, start) = starts.min_by(|a, b| a.0.total_cmp(&b.0)).expect("there are starts");
        let (total, values) = descend(&cost, start, self);
        let values = self.clamped(&values);
        let log_evidence = 0.5 * (base - total) - self.occam(&cost, &values, total);
        Fit { hypothesis: *self, values, cost: total, log_evidence }
    }

    fn clamped(&self, values: &[f64]) -> Vec<f64> {
        let clamp = |(p, v): (&Parameter, &f64)| v.clamp(p.range[0], p.range[1]);
        self.effect.parameters.iter().zip(values).map(clamp).collect()
    }

    /// Starts on both sides of neutral, near and far.
    fn starts(&self) -> Vec<Vec<f64>> {
        let p = self.effect.parameters;
        let mut starts = Vec::new();
        for reach in [-8.0, -2.0, 2.0, 8.0] {
            for k in 0..p.len() {
                let mut start: Vec<f64> = p.iter().map(|p| p.neutral).collect();
                start[k] =
                    (p[k].neutral + reach * p[k].tolerance).clamp(p[k].range[0], p[k].range[1]);
                if start[k] != p[k].neutral && !starts.contains(&start) {
                    starts.push(start);
                }
            }
        }
        starts
    }

    /// What the freedom of the parameters costs: prior width over posterior width.
    fn occam(&self, cost: &dyn Fn(&[f64]) -> f64, at: &[f64], total: f64) -> f64 {
        let width = |(k, p): (usize, &Parameter)| {
            let step = 0.1 * p.tolerance;
            let side = |sign: f64| {
                let mut moved = at.to_vec();
                moved[k] += sign * step;
                cost(&moved)
            };
            let curvature = ((side(1.0) + side(-1.0) - 2.0 * total) / (step * step)).max(0.0);
            let precision = (0.5 * curvature).max(wide(p).powi(-2));
            (wide(p) * precision.sqrt()).ln()
        };
        self.effect.parameters.iter().enumerate().map(width).sum()
    }
}

/// Width of the prior of a parameter whose effect is supposed: ten tolerances.
fn wide(p: &Parameter) -> f64 {
    10.0 * p.tolerance
}

/// Parabolas along each parameter in turn, until nothing is gained.
fn descend(
    cost: &dyn Fn(&[f64]) -> f64,
    start: Vec<f64>,
    hypothesis: &Hypothesis,
) -> (f64, Vec<f64>) {
    let mut steps: Vec<f64> = hypothesis.effect.parameters.iter().map(|p| p.tolerance).collect();
    let mut least = cost(&start);
    let mut at = start;
    for _ in 0..10 {
        let before = least;
        for k in 0..at.len() {
            let probe = |by: f64| {
                let mut moved = at.clone();
                moved[k] += by;
                let moved = hypothesis.clamped(&moved);
                (cost(&moved), moved)
            };
            let (up, down) = (probe(steps[k]), probe(-steps[k]));
            let curvature = up.0 + down.0 - 2.0 * least;
            let vertex = if curvature > 0.0 {
                (0.5 * (down.0 - up.0) / curvature).clamp(-4.0, 4.0) * steps[k]
            } else if up.0 < down.0 {
                4.0 * steps[k]
            } else {
                -4.0 * steps[k]
            };
            for (total, moved) in [probe(vertex), up, down] {
                if total < least {
                    (least, at) = (total, moved);
                }
            }
            steps[k] = (0.5 * vertex.abs()).clamp(0.1 * steps[k], 2.0 * steps[k]);
        }
        if before - least < 0.05 {
            break;
        }
    }
    (least, at)
}
