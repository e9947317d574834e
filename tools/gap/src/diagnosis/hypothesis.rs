//! One effect at one scope, fitted to the logs.

mod curvature;
mod descent;
mod spread;

use xt28_sim::Effects;
use xt28_sim::effects::{CATALOGUE, Effect, Parameter, Scope};

use super::belief::Supposed;
use super::evidence::Evidence;
use super::generator::Generator;
use super::onset::Onset;
use descent::{End, descend, follow_valley};
use spread::Spread;

/// Beginnings that an effect may have, as many as can be told apart in a run.
const BEGINNINGS: f64 = 12.0;

/// An effect at a scope.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hypothesis {
    /// Which effect.
    pub effect: &'static Effect,
    /// On which wheels.
    pub scope: Scope,
}

/// Share of a standard deviation by which one fit is of another size than another.
const PARTS: f64 = 0.25;

/// A hypothesis with its parameters at their best.
#[derive(Clone, Debug)]
pub struct Fit {
    /// What was fitted.
    pub hypothesis: Hypothesis,
    /// One value a parameter.
    pub values: Vec<f64>,
    /// Standard deviation of each value, whatever the others are.
    pub sigma: Vec<f64>,
    /// Before it the effect is not there.
    pub onset: Onset,
    /// Logarithm of its evidence over that of the base, prior included.
    pub log_evidence: f64,
    /// What of that was paid for its sizes, its beginning and its wheels, nats: the more of them could have
    /// been otherwise, the dearer.
    pub price: f64,
}

impl Fit {
    /// Whether it is another one than `other`: elsewhere, of another beginning, or of another size by a share of
    /// what either is known to.
    #[must_use]
    pub(super) fn parts_from(&self, other: &Self) -> bool {
        let known = self.sigma.iter().zip(&other.sigma).map(|(a, b)| a.max(*b));
        let mut sizes = self.values.iter().zip(&other.values).zip(known);
        self.hypothesis != other.hypothesis
            || self.onset != other.onset
            || sizes.any(|((a, b), sigma)| (a - b).abs() > PARTS * sigma)
    }
}

impl Hypothesis {
    /// Every one of `effects` at every scope that it can have.
    #[must_use]
    pub fn of(effects: &[&'static Effect]) -> Vec<Self> {
        let scopes = |&effect: &&'static Effect| {
            let scopes = if effect.has_scope() { &Scope::ALL[..] } else { &Scope::ALL[..1] };
            scopes.iter().map(move |&scope| Self { effect, scope })
        };
        effects.iter().flat_map(scopes).collect()
    }

    /// Every effect at every scope it can have.
    #[must_use]
    pub fn all() -> Vec<Self> {
        Self::of(&CATALOGUE.iter().collect::<Vec<_>>())
    }

    /// Logarithm of what one believes of it beside other effects and scopes (assumed): effects are
    /// alike; one that can have a scope is on all wheels two times in five, and on some axle, some
    /// side or some single wheel one time in five each.
    #[must_use]
    pub fn log_prior(&self) -> f64 {
        let share: f64 = match self.scope {
            _ if !self.effect.has_scope() => 1.0,
            Scope::All => 0.4,
            Scope::Axle(_) => 0.2 / 3.0,
            Scope::Side(_) => 0.2 / 2.0,
            Scope::Wheel(_) => 0.2 / 6.0,
        };
        share.ln()
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

    /// What `evidence` takes for granted with this effect's parameters at `values`.
    pub(super) fn supposed(&self, evidence: &Evidence<'_>, values: &[f64]) -> Supposed {
        evidence.with(|base| self.applied(base, values))
    }

    /// Its best values, sought from `values`, the effect there from `onset` on.
    #[must_use]
    pub fn refit(&self, evidence: &Evidence<'_>, onset: Onset, values: &[f64]) -> Fit {
        let cost = |values: &[f64]| self.cost(evidence, onset, values);
        let best = descend(&cost, values.to_vec(), self.effect.parameters);
        self.weighed(evidence, onset, best.at, best.cost)
    }

    /// The same hypothesis at the floor of its valley: sought further, where parameters make up for one
    /// another.
    #[must_use]
    pub(super) fn settled(&self, evidence: &Evidence<'_>, fit: Fit) -> Fit {
        if fit.values.len() == 1 {
            return fit;
        }
        let cost = |values: &[f64]| self.cost(evidence, fit.onset, values);
        let end = End { cost: cost(&fit.values), at: fit.values };
        let best = follow_valley(&cost, end, self.effect.parameters);
        self.weighed(evidence, fit.onset, best.at, best.cost)
    }

    /// What `evidence` says of the hypothesis where it suits `other` runs as well, sought from `fit` on.
    #[must_use]
    pub fn suiting(&self, evidence: &Evidence<'_>, other: &Evidence<'_>, fit: &Fit) -> Fit {
        let cost = |values: &[f64]| {
            self.cost(evidence, fit.onset, values) - 2.0 * self.gain(other, fit.onset, values)
        };
        let end = descend(&cost, fit.values.clone(), self.effect.parameters);
        let at = follow_valley(&cost, end, self.effect.parameters).at;
        let cost = self.cost(evidence, fit.onset, &at);
        self.weighed(evidence, fit.onset, at, cost)
    }

    /// How much better `evidence` is explained with `values`: half the cost that goes.
    #[must_use]
    pub fn gain(&self, evidence: &Evidence<'_>, onset: Onset, values: &[f64]) -> f64 {
        let belief = self.supposed(evidence, values);
        0.5 * (evidence.base_cost() - evidence.cost(belief.from(onset), &self.heard()))
    }

    /// What that could be at most: if the machine were just so.
    #[must_use]
    pub(super) fn most(&self, evidence: &Evidence<'_>, onset: Onset, values: &[f64]) -> f64 {
        evidence.most(self.supposed(evidence, values).from(onset), &self.heard())
    }

    /// The same for an effect that sets in at each of `onsets`.
    pub(super) fn onset_gains(
        &self,
        evidence: &Evidence<'_>,
        onsets: &[Onset],
        values: &[f64],
    ) -> Vec<f64> {
        let supposed = self.supposed(evidence, values);
        let costs = evidence.onset_costs(&supposed, &self.heard(), onsets);
        costs.into_iter().map(|cost| 0.5 * (evidence.base_cost() - cost)).collect()
    }

    /// The least of `cost` with what one has to believe for it, sought from `values`.
    pub(super) fn least(&self, cost: &dyn Fn(&[f64]) -> f64, values: &[f64]) -> f64 {
        let both = |values: &[f64]| cost(values) + self.disbelief(values);
        descend(&both, values.to_vec(), self.effect.parameters).cost
    }

    /// What one has to believe for these values, as a cost.
    pub(super) fn disbelief(&self, values: &[f64]) -> f64 {
        let of = |(p, v): (&Parameter, &f64)| disbelief((v - p.neutral) / wide(p));
        self.effect.parameters.iter().zip(values).map(of).sum()
    }

    /// The generators that it can make say something else.
    fn heard(&self) -> impl Fn(Generator) -> bool {
        |generator| generator.hears(self.effect, self.scope)
    }

    /// What is left and what one has to believe for it.
    fn cost(&self, evidence: &Evidence<'_>, onset: Onset, values: &[f64]) -> f64 {
        let belief = self.supposed(evidence, values);
        evidence.cost(belief.from(onset), &self.heard()) + self.disbelief(values)
    }

    fn weighed(&self, evidence: &Evidence<'_>, onset: Onset, values: Vec<f64>, cost: f64) -> Fit {
        let of = |moved: &[f64]| self.cost(evidence, onset, moved);
        let Spread { sigma, log_share } = Spread::about(&of, &values, cost, self.effect.parameters);
        let beginning = if onset.is_late() { BEGINNINGS.ln() } else { 0.0 };
        let disbelief = self.disbelief(&values);
        let price = 0.5 * disbelief - log_share + beginning - self.log_prior();
        let explained = 0.5 * (evidence.base_cost() - cost + disbelief);
        let log_evidence = explained - price;
        Fit { hypothesis: *self, values, sigma, onset, log_evidence, price }
    }
}

/// What it costs to believe a parameter so many widths from neutral: twice the negative logarithm of
/// Student's distribution with two degrees of freedom. A fault is as large as it is, and a square would
/// draw a bus that loses one command in ten down to one in twenty.
fn disbelief(widths: f64) -> f64 {
    3.0 * (widths * widths / 2.0).ln_1p()
}

/// Width of the prior of a parameter whose effect is supposed: ten tolerances.
fn wide(p: &Parameter) -> f64 {
    10.0 * p.tolerance
}
