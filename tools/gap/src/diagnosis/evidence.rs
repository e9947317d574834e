//! Residuals of all runs as one least-squares problem, linear in every tolerance.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};
use rayon::prelude::*;
use xt28_machine::Machine;
use xt28_sim::Effects;

use super::generator::{Generator, Signal};
use super::knob::Knob;
use super::signals::Signals;

/// Share of a knob's tolerance by which it is nudged.
const NUDGE: f64 = 0.05;

/// What the logs say about every knob, around one state of belief.
pub struct Evidence<'a> {
    runs: &'a [Signals],
    machine: Machine,
    /// What is believed beside the tolerances: effects found so far.
    pub base: Effects,
    knobs: Vec<Knob>,
    generators: Vec<Watch>,
    /// Of the knobs' posterior precision.
    factor: Cholesky<f64, Dyn>,
    /// Weighted squares of the base, and their slopes by knob.
    squares: f64,
    gradient: DVector<f64>,
}

/// One generator with its residuals at the base and their slopes.
struct Watch {
    generator: Generator,
    base: Stack,
    /// Knobs it answers to, and how, per sample and tolerance.
    slopes: Vec<(usize, Vec<f64>)>,
}

/// Residuals of one generator over all runs, each sample times the root of its weight.
#[derive(Clone, Debug, Default)]
struct Stack {
    /// Samples that can be judged.
    values: Vec<f64>,
    /// Where each signal's samples of each run end.
    ends: Vec<(usize, Signal, usize)>,
    mask: Vec<bool>,
}

impl<'a> Evidence<'a> {
    /// Residuals and their slopes by each of `knobs`, around `base`.
    ///
    /// # Panics
    /// Where a residual is not a number under the nominal machine.
    #[must_use]
    pub fn new(runs: &'a [Signals], machine: &Machine, base: Effects, knobs: Vec<Knob>) -> Self {
        let generators: Vec<Watch> = Generator::all()
            .into_par_iter()
            .map(|generator| Watch::new(generator, runs, machine, &base, &knobs))
            .collect();
        let n = knobs.len();
        let mut precision = DMatrix::<f64>::identity(n, n);
        for watch in &generators {
            for (i, (a, left)) in watch.slopes.iter().enumerate() {
                for (b, right) in &watch.slopes[i..] {
                    let product: f64 = left.iter().zip(right).map(|(l, r)| l * r).sum();
                    precision[(*a, *b)] += product;
                    if a != b {
                        precision[(*b, *a)] += product;
                    }
                }
            }
        }
        let factor = Cholesky::new(precision).expect("a sum of squares and the identity");
        let squares = generators.iter().map(|watch| square(&watch.base.values)).sum();
        let mut gradient = DVector::zeros(n);
        for watch in &generators {
            for (knob, slope) in &watch.slopes {
                gradient[*knob] +=
                    slope.iter().zip(&watch.base.values).map(|(s, r)| s * r).sum::<f64>();
            }
        }
        Self { runs, machine: machine.clone(), base, knobs, generators, factor, squares, gradient }
    }

    /// What it costs to believe `effects`, with the tolerances at their best around the base.
    ///
    /// `only` are the generators that can differ from the base.
    #[must_use]
    pub fn cost(&self, effects: &Effects, only: &dyn Fn(Generator) -> bool) -> f64 {
        let (mut squares, mut gradient) = (self.squares, self.gradient.clone());
        for watch in self.generators.iter().filter(|watch| only(watch.generator)) {
            let stack = watch.base.again(watch.generator, self.runs, &self.machine, effects);
            squares += square(&stack) - square(&watch.base.values);
            for (knob, slope) in &watch.slopes {
                let change = slope.iter().zip(stack.iter().zip(&watch.base.values));
                gradient[*knob] += change.map(|(s, (r, b))| s * (r - b)).sum::<f64>();
            }
        }
        squares - gradient.dot(&self.factor.solve(&gradient))
    }

    /// What is left on each generator under `effects`, tolerances at their best: mean square in
    /// units of the floor, one where nothing but the floor is left.
    #[must_use]
    pub fn left(&self, effects: &Effects) -> Vec<(Generator, f64)> {
        let mut gradient = DVector::<f64>::zeros(self.knobs.len());
        let stack =
            |watch: &Watch| watch.base.again(watch.generator, self.runs, &self.machine, effects);
        let stacks: Vec<Vec<f64>> = self.generators.iter().map(stack).collect();
        for (watch, stack) in self.generators.iter().zip(&stacks) {
            for (knob, slope) in &watch.slopes {
                gradient[*knob] += slope.iter().zip(stack).map(|(s, r)| s * r).sum::<f64>();
            }
        }
        let step = self.factor.solve(&gradient);
        let left = |(watch, mut stack): (&Watch, Vec<f64>)| {
            for (knob, slope) in &watch.slopes {
                let by = step[*knob];
                stack.iter_mut().zip(slope).for_each(|(r, s)| *r -= by * s);
            }
            (watch.generator, square(&stack) / watch.samples().max(1.0))
        };
        self.generators.iter().zip(stacks).map(left).collect()
    }

    /// Where all knobs at once come to lie, each by how many of its tolerances from the base.
    #[must_use]
    pub fn shifts(&self) -> Vec<(Knob, f64)> {
        let shifts = self.factor.solve(&self.gradient);
        self.knobs.iter().copied().zip(shifts.iter().map(|shift| -shift)).collect()
    }

    /// Cost of the base.
    #[must_use]
    pub fn base_cost(&self) -> f64 {
        self.cost(&self.base, &|_| false)
    }
}

fn square(values: &[f64]) -> f64 {
    values.iter().map(|r| r * r).sum()
}

impl Watch {
    /// Number of independent samples.
    #[allow(clippy::cast_precision_loss)]
    fn samples(&self) -> f64 {
        let (mut from, mut sum) = (0, 0.0);
        for (_, signal, end) in &self.base.ends {
            sum += (end - from) as f64 * signal.weight();
            from = *end;
        }
        sum
    }

    fn new(
        generator: Generator,
        runs: &[Signals],
        machine: &Machine,
        base: &Effects,
        knobs: &[Knob],
    ) -> Self {
        let stack = Stack::new(generator, runs, machine, base);
        let slope = |knob: &Knob| {
            if let Knob::Effect(effect, _, scope) = knob
                && !generator.hears(effect, *scope)
            {
                return None;
            }
            let (mut machine, mut effects) = (machine.clone(), base.clone());
            let at = match knob {
                Knob::Effect(_, parameter, scope) => parameter.get(base, *scope),
                Knob::Machine(_) => 1.0,
            };
            let step = NUDGE * knob.tolerance();
            knob.set(&mut machine, &mut effects, at + step);
            let nudged = stack.again(generator, runs, &machine, &effects);
            let slope: Vec<f64> =
                nudged.iter().zip(&stack.values).map(|(n, b)| (n - b) / NUDGE).collect();
            slope.iter().any(|s| *s != 0.0).then_some(slope)
        };
        let slopes = knobs.iter().enumerate().filter_map(|(i, knob)| Some((i, slope(knob)?)));
        let slopes = slopes.collect();
        Self { generator, base: stack, slopes }
    }
}

impl Stack {
    fn new(generator: Generator, runs: &[Signals], machine: &Machine, effects: &Effects) -> Self {
        let mut stack = Self::default();
        for (index, run) in runs.iter().enumerate() {
            for residual in generator.residuals(run, machine, effects) {
                let root = residual.signal.weight().sqrt();
                for value in residual.values {
                    stack.mask.push(value.is_finite());
                    if value.is_finite() {
                        stack.values.push(value * root);
                    }
                }
                stack.ends.push((index, residual.signal, stack.values.len()));
            }
        }
        stack
    }

    /// The same samples under another belief; those that were judged are judged again.
    fn again(
        &self,
        generator: Generator,
        runs: &[Signals],
        machine: &Machine,
        effects: &Effects,
    ) -> Vec<f64> {
        let mut values = Vec::with_capacity(self.values.len());
        let mut mask = self.mask.iter();
        for run in runs {
            for residual in generator.residuals(run, machine, effects) {
                let root = residual.signal.weight().sqrt();
                for value in residual.values {
                    if mask.next() == Some(&true) {
                        values.push(if value.is_finite() { value * root } else { 0.0 });
                    }
                }
            }
        }
        values
    }
}
