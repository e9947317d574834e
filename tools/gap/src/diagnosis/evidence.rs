//! Residuals of all runs as one problem: linear in every tolerance, each signal with a scale of its own.
//!
//! A sound machine's residuals lie below the floor; a block that the simulator does not quite know lies
//! higher. So the scale of each signal is unknown too, but never less than one: what is below the floor
//! is how two models differ, and to explain a part of it explains nothing. A larger scale is worth
//! [`SCALE_SAMPLES`] samples of belief against. With RSS the squares that a signal leaves, N its
//! independent samples and nu that belief, believing something costs RSS up to N, and
//! `N + (N + nu) ln((RSS + nu) / (N + nu))` beyond: a block that nothing explains raises its own scale
//! and does not drown the others.

mod ahead;
mod bumps;
mod echo;
mod halves;
mod left;
mod precision;
mod span;
mod stack;
mod watch;

use std::borrow::Cow;

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};
use rayon::prelude::*;
use xt28_machine::Machine;
use xt28_sim::Effects;
use xt28_sim::effects::PumpFlowLimit;

use super::belief::{Base, Belief, Supposed};
use super::generator::Generator;
use super::knob::Knob;
use super::onset::Onset;
use super::signals::Signals;
pub(super) use ahead::Ahead;
pub use echo::Echo;
#[cfg(test)]
pub(super) use halves::Half;
pub use halves::Uneven;
pub(super) use halves::{BEND_RAD, SHUT};
pub use left::Left;
use left::{cost_of_squares, with_bumps};
use precision::{add_precision, gradient, precision};
use stack::Group;
pub(super) use watch::Memory;
use watch::{Sums, Watch};

/// How many samples one's belief in a floor is worth.
const SCALE_SAMPLES: f64 = 10.0;
/// Rounds in which scales and tolerances settle on each other.
const ROUNDS: usize = 4;

/// What the logs say about every knob, around one state of belief.
pub struct Evidence<'a> {
    runs: &'a [Signals],
    machine: Machine,
    /// What is believed beside the tolerances: effects found so far.
    base: Base,
    watches: Vec<Watch>,
    /// Cost of the base.
    base_cost: f64,
    /// Of the knobs' posterior precision.
    factor: Cholesky<f64, Dyn>,
    knobs: Vec<Knob>,
}

impl<'a> Evidence<'a> {
    /// Residuals and their slopes by each of `knobs`, around `base`.
    ///
    /// # Panics
    /// Where a residual is not a number under the nominal machine.
    #[must_use]
    pub fn new(
        runs: &'a [Signals],
        machine: &Machine,
        base: impl Into<Base>,
        knobs: &[Knob],
    ) -> Self {
        Self::watching(Generator::all(), runs, machine, base, knobs)
    }

    /// The same for some `generators` only.
    ///
    /// # Panics
    /// Where a residual is not a number under the nominal machine.
    #[must_use]
    pub fn watching(
        generators: Vec<Generator>,
        runs: &'a [Signals],
        machine: &Machine,
        base: impl Into<Base>,
        knobs: &[Knob],
    ) -> Self {
        let base = base.into();
        let watches: Vec<Watch> = generators
            .into_par_iter()
            .map(|generator| Watch::new(generator, runs, machine, &base, knobs))
            .collect();
        let factor = precision(&watches, knobs.len());
        let mut evidence = Self {
            runs,
            machine: machine.clone(),
            base,
            watches,
            base_cost: 0.0,
            factor,
            knobs: knobs.to_vec(),
        };
        for _ in 0..ROUNDS {
            evidence.settle();
        }
        evidence.base_cost = evidence.cost(evidence.base.belief(), &|_| false);
        evidence
    }

    /// What it costs to believe, with the tolerances at their best around the base.
    ///
    /// `only` are the generators that can differ from the base.
    #[must_use]
    pub fn cost<'e>(&self, belief: impl Into<Belief<'e>>, only: &dyn Fn(Generator) -> bool) -> f64 {
        self.cost_of(&self.sums(belief.into(), only))
    }

    /// What belief would gain if the machine were as believed to the letter, nats: what the base then costs,
    /// tolerances at their best. Next to nothing is what no drive of these runs makes show.
    #[must_use]
    pub(super) fn most(&self, belief: Belief<'_>, only: &dyn Fn(Generator) -> bool) -> f64 {
        let sums = |watch: &Watch| {
            let mut values = watch.stack.values.clone();
            if only(watch.stack.generator) {
                let believed = watch.values(self.runs, &self.machine, belief);
                values.iter_mut().zip(believed).for_each(|(value, believed)| *value -= believed);
            } else {
                values.fill(0.0);
            }
            Cow::Owned(watch.sums_of(&values))
        };
        let sums: Vec<Cow<'_, Sums>> = self.watches.iter().map(sums).collect();
        0.5 * self.cost_of(&sums)
    }

    /// What is believed beside the tolerances, with `change` made to it.
    pub(super) fn with(&self, change: impl Fn(&Effects) -> Effects) -> Supposed {
        self.base.with(change)
    }

    /// What it costs to believe what is `supposed` from each of `onsets` on; what generators of
    /// one wheel say of `values` there is remembered.
    pub(super) fn costs_remembered(
        &self,
        supposed: &Supposed,
        only: &dyn Fn(Generator) -> bool,
        onsets: &[Onset],
        (values, memory): (&[f64], &mut Memory),
    ) -> Vec<f64> {
        let mut sums = |watch: &Watch| {
            let generator = watch.stack.generator;
            if !only(generator) {
                return vec![watch.sums.clone(); onsets.len()];
            }
            let again = || watch.onsets(self.runs, &self.machine, supposed, onsets, false);
            // On a pump that runs short an arm gets what the others leave, whatever theirs is then.
            let is_alone = self.base.effects.pump_flow == PumpFlowLimit::default();
            if generator.wheel().is_none() || !is_alone {
                return again();
            }
            let bits = values.iter().map(|value| value.to_bits()).collect();
            memory.entry((generator, bits)).or_insert_with(again).clone()
        };
        let sums: Vec<Vec<Sums>> = self.watches.iter().map(&mut sums).collect();
        let at = |k: usize| sums.iter().map(|all| Cow::Borrowed(&all[k])).collect::<Vec<_>>();
        (0..onsets.len()).map(|k| self.cost_of(&at(k))).collect()
    }

    /// What it costs to believe what is `supposed` from each of `onsets` on, fixes jumping there.
    pub(super) fn onset_costs(
        &self,
        supposed: &Supposed,
        only: &dyn Fn(Generator) -> bool,
        onsets: &[Onset],
    ) -> Vec<f64> {
        let late: Vec<Vec<Cow<'_, Sums>>> = self
            .watches
            .iter()
            .map(|watch| {
                if only(watch.stack.generator) {
                    let all = watch.onsets(self.runs, &self.machine, supposed, onsets, true);
                    all.into_iter().map(Cow::Owned).collect()
                } else {
                    onsets.iter().map(|_| Cow::Borrowed(&watch.sums)).collect()
                }
            })
            .collect();
        let at = |k: usize| late.iter().map(|all| all[k].clone()).collect::<Vec<_>>();
        (0..onsets.len()).map(|k| self.cost_of(&at(k))).collect()
    }

    fn cost_of(&self, sums: &[Cow<'_, Sums>]) -> f64 {
        let step = self.step(sums);
        let left = self.remaining(sums, &step);
        let mut cost = step.norm_squared();
        for (watch, squares) in self.watches.iter().zip(&left) {
            for (group, square) in watch.stack.groups.iter().zip(squares) {
                cost += cost_of_squares(*square, group.samples);
            }
        }
        cost
    }

    /// What is left on each signal, tolerances at their best.
    #[must_use]
    pub fn left<'e>(&self, belief: impl Into<Belief<'e>>) -> Vec<Left> {
        self.left_and_shifts(belief).0
    }

    /// The same, with [`Self::shifts`].
    pub(super) fn left_and_shifts<'e>(
        &self,
        belief: impl Into<Belief<'e>>,
    ) -> (Vec<Left>, Vec<(Knob, f64)>) {
        let (values, sums, step) = self.answers(belief.into());
        let each = self.watches.iter().zip(values);
        let bumps = each.flat_map(|(watch, values)| watch.bumps(&watch.bent(values, &step)));
        (with_bumps(self.left_at(&sums, &step), bumps), self.by_knob(&step))
    }

    /// How much of what `belief` leaves on each signal is what it explains of what `nothing` leaves, moved
    /// in time; and whether it is another share of that in one half of the samples than in the other.
    #[must_use]
    pub fn again<'e>(
        &self,
        belief: impl Into<Belief<'e>>,
        nothing: &Effects,
    ) -> (Vec<Echo>, Vec<Uneven>) {
        let (values, _, step) = self.answers(belief.into());
        let each = self.watches.par_iter().zip(values);
        let of = |(watch, believed): (&Watch, Vec<f64>)| {
            let unexplained = watch.values(self.runs, &self.machine, nothing.into());
            let left = watch.bent(believed.clone(), &step);
            let both = [&unexplained[..], &believed];
            (watch.echoes(both, &left), watch.unevens(self.runs, both, &left))
        };
        let (echoes, unevens): (Vec<Vec<Echo>>, Vec<Vec<Uneven>>) = each.map(of).unzip();
        (echoes.concat(), unevens.concat())
    }

    /// Residuals of each watch under `belief`, what the cost has to know of them, and where the tolerances
    /// go with it.
    fn answers(&self, belief: Belief<'_>) -> (Vec<Vec<f64>>, Vec<Cow<'_, Sums>>, DVector<f64>) {
        let values = |watch: &Watch| watch.values(self.runs, &self.machine, belief);
        let values: Vec<Vec<f64>> = self.watches.par_iter().map(values).collect();
        let each = self.watches.iter().zip(&values);
        let sums: Vec<_> = each.map(|(w, values)| Cow::Owned(w.sums_of(values))).collect();
        let step = self.step(&sums);
        (values, sums, step)
    }

    /// What the base leaves on each signal, tolerances where they are believed to be.
    #[must_use]
    pub fn unbent(&self) -> Vec<Left> {
        let sums = self.sums(self.base.belief(), &|_| false);
        let bumps = self.watches.iter().flat_map(|watch| watch.bumps(&watch.stack.values));
        with_bumps(self.left_at(&sums, &DVector::zeros(self.knobs.len())), bumps)
    }

    /// What the base leaves on each signal, tolerances at their best beside `beliefs`, which take over from one
    /// another, but none further than `most` of its own: the gap that is theirs to explain. Tolerances at their
    /// best without them bend to it, and hide it.
    #[must_use]
    pub fn apart(&self, beliefs: &[Belief<'_>], most: f64) -> Vec<Left> {
        let sums = |watch: &Watch| {
            Cow::Owned(watch.sums_of(&watch.in_turn(self.runs, &self.machine, beliefs)))
        };
        let step = self.step(&self.watches.iter().map(sums).collect::<Vec<_>>());
        let step = step.map(|by| by.clamp(-most, most));
        let sums = self.sums(self.base.belief(), &|_| false);
        self.left_at(&sums, &step)
    }

    fn left_at(&self, sums: &[Cow<'_, Sums>], step: &DVector<f64>) -> Vec<Left> {
        let mut all = Vec::new();
        for (watch, squares) in self.watches.iter().zip(self.remaining(sums, step)) {
            for (group, square) in watch.stack.groups.iter().zip(squares) {
                let square = square / group.samples.max(1.0);
                all.push(Left::evenly(watch.stack.generator, group.signal, square, group.samples));
            }
        }
        all
    }

    /// What each generator leaves under the base: root mean square of its signals in units of their
    /// floors; `None` where nothing was measured that it could be told by.
    #[must_use]
    pub fn gaps(&self) -> Vec<(Generator, Option<f64>)> {
        let left = self.left(self.base.belief());
        let gap = |watch: &Watch| {
            let own = left.iter().filter(|left| left.generator == watch.stack.generator);
            let (squares, samples) = own.fold((0.0, 0.0_f64), |(squares, samples), left| {
                (squares + left.square * left.samples, samples + left.samples)
            });
            let gap = (samples > 0.0).then(|| (squares / samples.max(1.0)).sqrt());
            (watch.stack.generator, gap)
        };
        self.watches.iter().map(gap).collect()
    }

    /// Where all knobs at once come to lie beside `belief`, each by how many of its tolerances.
    #[must_use]
    pub fn shifts<'e>(&self, belief: impl Into<Belief<'e>>) -> Vec<(Knob, f64)> {
        self.by_knob(&self.step(&self.sums(belief.into(), &|_| true)))
    }

    fn by_knob(&self, step: &DVector<f64>) -> Vec<(Knob, f64)> {
        self.knobs.iter().copied().zip(step.iter().copied()).collect()
    }

    /// Effects that are believed already.
    #[must_use]
    pub const fn base(&self) -> &Effects {
        &self.base.effects
    }

    /// Cost of the base.
    #[must_use]
    pub const fn base_cost(&self) -> f64 {
        self.base_cost
    }

    /// Scales from what the base leaves, then tolerances weighted by them.
    fn settle(&mut self) {
        let sums: Vec<_> = self.watches.iter().map(|watch| Cow::Borrowed(&watch.sums)).collect();
        let left = self.remaining(&sums, &self.step(&sums));
        for (watch, squares) in self.watches.iter_mut().zip(&left) {
            let weigh = |(group, square): (&Group, &f64)| {
                ((SCALE_SAMPLES + group.samples) / (SCALE_SAMPLES + square)).min(1.0)
            };
            watch.weights = watch.stack.groups.iter().zip(squares).map(weigh).collect();
        }
        self.factor = precision(&self.watches, self.knobs.len());
    }

    fn sums<'s>(
        &'s self,
        belief: Belief<'_>,
        only: &dyn Fn(Generator) -> bool,
    ) -> Vec<Cow<'s, Sums>> {
        let sums = |watch: &'s Watch| {
            if only(watch.stack.generator) {
                Cow::Owned(watch.again(self.runs, &self.machine, belief))
            } else {
                Cow::Borrowed(&watch.sums)
            }
        };
        self.watches.iter().map(sums).collect()
    }

    /// Where the tolerances go, in units of their own.
    fn step(&self, sums: &[Cow<'_, Sums>]) -> DVector<f64> {
        let mut slope = DVector::zeros(self.knobs.len());
        for (watch, sums) in self.watches.iter().zip(sums) {
            gradient(&mut slope, watch, &watch.weights, sums);
        }
        self.factor.solve(&slope)
    }

    /// Squares of each watch's groups once the tolerances have gone by `step`.
    fn remaining(&self, sums: &[Cow<'_, Sums>], step: &DVector<f64>) -> Vec<Vec<f64>> {
        let of = |(watch, sums): (&Watch, &Sums)| {
            let own =
                DVector::from_iterator(watch.knobs.len(), watch.knobs.iter().map(|k| step[*k]));
            let group = |(square, (gradient, product)): (&f64, (&DVector<f64>, &DMatrix<f64>))| {
                (square + 2.0 * gradient.dot(&own) + own.dot(&(product * &own))).max(0.0)
            };
            let each = sums.squares.iter().zip(sums.gradients.iter().zip(&watch.products));
            each.map(group).collect()
        };
        self.watches.iter().zip(sums.iter().map(Cow::as_ref)).map(of).collect()
    }
}
