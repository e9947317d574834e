//! One generator with its residuals at the base, and how they answer to every knob.

use core::ops::Range;
use std::collections::BTreeMap;

use nalgebra::{DMatrix, DVector};
use xt28_machine::Machine;
use xt28_sim::Effects;

use super::bumps::Bumps;
use super::echo::{Echo, Filter};
use super::halves::{Half, Scene, Uneven};
use super::stack::{Group, Stack};
use crate::diagnosis::belief::{Base, Belief, Supposed};
use crate::diagnosis::generator::{Generator, STEP_S};
use crate::diagnosis::knob::Knob;
use crate::diagnosis::onset::Onset;
use crate::diagnosis::signals::Signals;

/// Share of a knob's tolerance by which it is nudged.
const NUDGE: f64 = 0.05;

/// One generator with its residuals at the base and their slopes.
pub(super) struct Watch {
    pub(super) stack: Stack,
    /// Knobs it answers to.
    pub(super) knobs: Vec<usize>,
    /// How it answers to each, per sample and tolerance.
    slopes: Vec<Slope>,
    /// Products of slopes in each group.
    pub(super) products: Vec<DMatrix<f64>>,
    /// Weight of each group at the base, when tolerances are set.
    pub(super) weights: Vec<f64>,
    /// Of the base.
    pub(super) sums: Sums,
}

/// How residuals answer to one knob, per tolerance.
struct Slope {
    /// Of each sample.
    values: Vec<f64>,
    /// Where it answers at all: groups, and samples of theirs that follow one another.
    heard: Vec<(usize, Range<usize>)>,
}

impl Slope {
    fn new(values: Vec<f64>, stretches: &[(usize, Range<usize>)]) -> Self {
        let is_heard = |range: &Range<usize>| values[range.clone()].iter().any(|s| *s != 0.0);
        let heard = stretches.iter().filter(|(_, range)| is_heard(range)).cloned().collect();
        Self { values, heard }
    }

    /// Its products with `others`, which are of the same samples, with the group of each.
    fn products<'a>(&'a self, others: &'a [f64]) -> impl Iterator<Item = (usize, f64)> + 'a {
        let of = |range: &Range<usize>| dot(&self.values[range.clone()], &others[range.clone()]);
        self.heard.iter().map(move |(group, range)| (*group, of(range)))
    }
}

/// Sum of products, with several accumulators so that it is computed in vector registers: as one sum it took half of
/// a diagnosis' time.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    const LANES: usize = 8;
    let ((a, rest_a), (b, rest_b)) = (a.as_chunks::<LANES>(), b.as_chunks::<LANES>());
    let mut sums = [0.0; LANES];
    for (a, b) in a.iter().zip(b) {
        for ((sum, a), b) in sums.iter_mut().zip(a).zip(b) {
            *sum += a * b;
        }
    }
    let rest: f64 = rest_a.iter().zip(rest_b).map(|(a, b)| a * b).sum();
    sums.iter().sum::<f64>() + rest
}

/// What the cost needs to know of one generator's residuals.
#[derive(Clone, Debug)]
pub(in crate::diagnosis) struct Sums {
    /// Squares in each group.
    pub(super) squares: Vec<f64>,
    /// Slopes times residuals in each group, by the watch's own knobs.
    pub(super) gradients: Vec<DVector<f64>>,
}

/// Sums of generators that look at one wheel alone, one for each instant, by wheel and values.
pub(in crate::diagnosis) type Memory = BTreeMap<(Generator, Vec<u64>), Vec<Sums>>;

impl Watch {
    /// Residuals of `generator` around `base`, and how they answer to each of `knobs`.
    pub(super) fn new(
        generator: Generator,
        runs: &[Signals],
        machine: &Machine,
        base: &Base,
        knobs: &[Knob],
    ) -> Self {
        let stack = Stack::new(generator, runs, machine, base);
        let slope = |knob: &Knob| {
            if let Knob::Effect(effect, _, scope) = knob
                && !generator.hears(effect, *scope)
            {
                return None;
            }
            let (machine, nudged) = nudged(machine, base, knob);
            let nudged = stack.again(runs, &machine, nudged.from(Onset::ALWAYS));
            let slope: Vec<f64> =
                nudged.iter().zip(&stack.values).map(|(n, b)| (n - b) / NUDGE).collect();
            slope.iter().any(|s| *s != 0.0).then_some(slope)
        };
        let stretches = stack.stretches();
        let (mut own, mut slopes) = (Vec::new(), Vec::new());
        for (index, knob) in knobs.iter().enumerate() {
            if let Some(slope) = slope(knob) {
                own.push(index);
                slopes.push(Slope::new(slope, &stretches));
            }
        }
        let groups = stack.groups.len();
        let mut products = vec![DMatrix::zeros(own.len(), own.len()); groups];
        for (i, a) in slopes.iter().enumerate() {
            for (j, b) in slopes.iter().enumerate().skip(i) {
                for (group, product) in a.products(&b.values) {
                    products[group][(i, j)] += product;
                }
                for product in &mut products {
                    product[(j, i)] = product[(i, j)];
                }
            }
        }
        let mut watch = Self {
            stack,
            knobs: own,
            slopes,
            products,
            weights: vec![1.0; groups],
            sums: Sums { squares: Vec::new(), gradients: Vec::new() },
        };
        watch.sums = watch.sums_of(&watch.stack.values);
        watch
    }

    /// What the cost needs to know under another belief.
    pub(super) fn again(&self, runs: &[Signals], machine: &Machine, belief: Belief<'_>) -> Sums {
        self.sums_of(&self.values(runs, machine, belief))
    }

    /// Residuals under another belief, each times the root of its weight.
    pub(super) fn values(
        &self,
        runs: &[Signals],
        machine: &Machine,
        belief: Belief<'_>,
    ) -> Vec<f64> {
        self.stitched(&self.stack.again(runs, machine, belief), belief.onset)
    }

    /// The same under beliefs that take over from one another, each at its own instant, the first from the base.
    pub(super) fn in_turn(
        &self,
        runs: &[Signals],
        machine: &Machine,
        beliefs: &[Belief<'_>],
    ) -> Vec<f64> {
        let mut values = self.stack.values.clone();
        let mut before = &self.stack.base().effects;
        for belief in beliefs {
            let later = self.stack.after(runs, machine, before, *belief);
            for (k, (value, later)) in values.iter_mut().zip(later).enumerate() {
                if !self.stack.is_before(belief.onset, k) {
                    *value = later;
                }
            }
            before = belief.effects;
        }
        values
    }

    /// The same for what sets in at each of `onsets`, as if they had always been there, so that one run of the
    /// generator does for all. But for a valve's play: the spool would not be where it is, for as long as no command
    /// crosses the play. And for fixes that jump, where `jumps` are asked for: that is for onsets that lie close
    /// together, as a jump at a wrong instant is worse than none.
    pub(super) fn onsets(
        &self,
        runs: &[Signals],
        machine: &Machine,
        supposed: &Supposed,
        onsets: &[Onset],
        jumps: bool,
    ) -> Vec<Sums> {
        let effects = &supposed.effects;
        if self.stack.plays_otherwise(effects) || (jumps && self.stack.jumps(effects)) {
            let again = |&at| self.again(runs, machine, supposed.from(at));
            return onsets.iter().map(again).collect();
        }
        let values = self.stack.again(runs, machine, supposed.from(Onset::ALWAYS));
        onsets.iter().map(|&onset| self.sums_of(&self.stitched(&values, onset))).collect()
    }

    /// `values` once the tolerances have gone by `step`.
    pub(super) fn bent(&self, mut values: Vec<f64>, step: &DVector<f64>) -> Vec<f64> {
        for (knob, slope) in self.knobs.iter().zip(&self.slopes) {
            values
                .iter_mut()
                .zip(&slope.values)
                .for_each(|(value, slope)| *value += slope * step[*knob]);
        }
        values
    }

    /// What `values` leave of each group that the mean square does not tell.
    pub(super) fn bumps(&self, values: &[f64]) -> Vec<Bumps> {
        let Stack { ref group, ref at_s, ref groups, .. } = self.stack;
        let of = |(index, one): (usize, &Group)| {
            let own = (0..values.len()).filter(|&i| group[i] == index);
            Bumps::of(&own.map(|i| (at_s[i], values[i])).collect::<Vec<_>>(), one)
        };
        groups.iter().enumerate().map(of).collect()
    }

    /// How much of what each group leaves is what is explained there, moved in time: `values` are residuals
    /// while nothing is believed, `believed` those under a belief, `left` the same once tolerances have
    /// gone where they go. Samples that are as they were, of which the belief says nothing or no longer
    /// can, are holes.
    pub(super) fn echoes(&self, [values, believed]: [&[f64]; 2], left: &[f64]) -> Vec<Echo> {
        let Stack { generator, ref group, ref at_s, ref groups, .. } = self.stack;
        let follows = |a: &usize, b: &usize| (at_s[*b] - at_s[*a] - STEP_S).abs() < 0.5 * STEP_S;
        let echo = |(index, &Group { signal, samples }): (usize, &Group)| {
            let own = |i: &usize| group[*i] == index && values[*i] != believed[*i];
            let own: Vec<usize> = (0..values.len()).filter(own).collect();
            let mut filter = Filter::new();
            for stretch in own.chunk_by(follows) {
                let explained: Vec<f64> =
                    stretch.iter().map(|&i| values[i] - believed[i]).collect();
                let left: Vec<f64> = stretch.iter().map(|&i| left[i]).collect();
                filter.add(&explained, &left);
            }
            let [nats, explained] = filter.nats();
            Echo { generator, signal, nats, explained, samples }
        };
        groups.iter().enumerate().map(echo).collect()
    }

    /// Whether what each group leaves is another share of what is explained there in one half than in the
    /// other; arguments and holes are those of [`Self::echoes`].
    pub(super) fn unevens(
        &self,
        runs: &[Signals],
        [values, believed]: [&[f64]; 2],
        left: &[f64],
    ) -> Vec<Uneven> {
        let Stack { generator, ref group, ref at_s, ref run, ref groups, .. } = self.stack;
        let scenes: Vec<Scene<'_>> = runs.iter().map(|run| Scene::new(generator, run)).collect();
        let of = |(index, &Group { signal, .. }): (usize, &Group)| {
            let own = |i: &usize| group[*i] == index && values[*i] != believed[*i];
            let own: Vec<usize> = (0..values.len()).filter(own).collect();
            let explained = |i: usize| values[i] - believed[i];
            let squares: f64 = own.iter().map(|&i| explained(i).powi(2)).sum();
            let mean = (squares / own.len().max(1) as f64).sqrt();
            Half::ALL.map(|half| {
                let mut uneven = Uneven::new(generator, signal, half);
                for &i in &own {
                    let by = explained(i);
                    if let Some(is_in) = scenes[run[i]].side(half, at_s[i], by / mean) {
                        uneven.add(is_in, by, left[i]);
                    }
                }
                uneven
            })
        };
        groups.iter().enumerate().flat_map(of).collect()
    }

    /// The base before `onset`, `values` after.
    fn stitched(&self, values: &[f64], onset: Onset) -> Vec<f64> {
        let both = values.iter().zip(&self.stack.values).enumerate();
        both.map(|(k, (value, base))| *if self.stack.is_before(onset, k) { base } else { value })
            .collect()
    }

    /// What the cost needs to know of `values`.
    pub(super) fn sums_of(&self, values: &[f64]) -> Sums {
        let mut gradients = vec![DVector::zeros(self.knobs.len()); self.stack.groups.len()];
        for (knob, slope) in self.slopes.iter().enumerate() {
            for (group, product) in slope.products(values) {
                gradients[group][knob] += product;
            }
        }
        Sums { squares: self.stack.squares(values), gradients }
    }
}

/// The machine and what is believed of it with `knob` turned a little.
fn nudged(machine: &Machine, base: &Base, knob: &Knob) -> (Machine, Supposed) {
    let turned = |effects: &Effects| {
        let (mut machine, mut effects) = (machine.clone(), effects.clone());
        let at = match knob {
            Knob::Effect(_, parameter, scope) => parameter.get(&effects, *scope),
            Knob::Machine(_) => 1.0,
        };
        knob.set(&mut machine, &mut effects, at + NUDGE * knob.tolerance());
        (machine, effects)
    };
    (turned(&base.effects).0, base.with(|effects| turned(effects).1))
}
