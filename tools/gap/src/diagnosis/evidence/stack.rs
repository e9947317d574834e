//! Residuals of one generator over all runs, in groups that share one unknown scale.

use core::ops::Range;

use xt28_machine::Machine;
use xt28_sim::Effects;

use crate::diagnosis::belief::{Base, Belief, EffectSchedule};
use crate::diagnosis::floor::Signal;
use crate::diagnosis::generator::{Generator, Residual, STEP_S};
use crate::diagnosis::onset::Onset;
use crate::diagnosis::signals::Signals;

/// One signal of a generator, over all runs.
#[derive(Clone, Copy, Debug)]
pub(super) struct Group {
    /// Which signal.
    pub(super) signal: Signal,
    /// Independent samples: correlated ones count once.
    pub(super) samples: f64,
}

/// The samples of one generator that can be judged, each times the root of its weight.
#[derive(Clone, Debug)]
pub(super) struct Stack {
    /// Who made them.
    pub(super) generator: Generator,
    /// The values, run after run.
    pub(super) values: Vec<f64>,
    /// Group of each value.
    pub(super) group: Vec<usize>,
    /// Instant of each value in its run, s.
    pub(super) at_s: Vec<f64>,
    /// When that was read which it tells, s: it is of what was believed then.
    pub(super) read_at_s: Vec<f64>,
    /// Run of each value, by its place.
    pub(super) run: Vec<usize>,
    /// When each run began on the day, s.
    began_s: Vec<f64>,
    /// All groups.
    pub(super) groups: Vec<Group>,
    /// What they were made with.
    base: Base,
    /// Whether the base makes each run another, by its place.
    hears_base: Vec<bool>,
    mask: Vec<bool>,
}

impl Stack {
    /// Residuals of `generator` on `runs` under `base`.
    #[allow(clippy::cast_precision_loss)]
    pub(super) fn new(
        generator: Generator,
        runs: &[Signals],
        machine: &Machine,
        base: &Base,
    ) -> Self {
        let mut stack = Self {
            generator,
            values: Vec::new(),
            group: Vec::new(),
            at_s: Vec::new(),
            read_at_s: Vec::new(),
            run: Vec::new(),
            began_s: runs.iter().map(|run| run.began_s).collect(),
            groups: Vec::new(),
            base: base.clone(),
            hears_base: Vec::new(),
            mask: Vec::new(),
        };
        for (number, run) in runs.iter().enumerate() {
            let schedule = base.schedule(base.belief(), run.began_s);
            stack.hears_base.push(hears_base(generator, run, machine, schedule));
            for residual in stack.residuals(number, run, machine, schedule) {
                let group = stack.group_of(residual.signal);
                let weight = residual.signal.weight();
                for (i, value) in residual.values.iter().enumerate() {
                    let at_s = i as f64 * STEP_S;
                    let read_at_s = generator.read_at_s(residual.signal, at_s);
                    let counts = value.is_finite();
                    stack.mask.push(counts);
                    if counts {
                        stack.values.push(value * weight.sqrt());
                        stack.group.push(group);
                        stack.at_s.push(at_s);
                        stack.read_at_s.push(read_at_s);
                        stack.run.push(number);
                        stack.groups[group].samples += weight;
                    }
                }
            }
        }
        stack
    }

    /// The same samples under another belief; what can no longer be said stays as it was, so that
    /// nobody gains by it.
    pub(super) fn again(
        &self,
        runs: &[Signals],
        machine: &Machine,
        belief: Belief<'_>,
    ) -> Vec<f64> {
        self.after(runs, machine, &self.base.effects, belief)
    }

    /// The same where other effects than the base's hold before the belief does.
    pub(super) fn after(
        &self,
        runs: &[Signals],
        machine: &Machine,
        before: &Effects,
        belief: Belief<'_>,
    ) -> Vec<f64> {
        let mut values = Vec::with_capacity(self.values.len());
        let mut mask = self.mask.iter();
        for (number, run) in runs.iter().enumerate() {
            let schedule = self.base.schedule(belief, run.began_s).taking_over(before);
            for residual in self.residuals(number, run, machine, schedule) {
                let root = residual.signal.weight().sqrt();
                for value in residual.values {
                    if mask.next() == Some(&true) {
                        let was = self.values[values.len()];
                        values.push(if value.is_finite() { value * root } else { was });
                    }
                }
            }
        }
        values
    }

    /// Whether what value `k` tells was read before `onset`.
    pub(super) fn is_before(&self, onset: Onset, k: usize) -> bool {
        self.read_at_s[k] < onset.in_run(self.began_s[self.run[k]])
    }

    /// What they were made with.
    pub(super) const fn base(&self) -> &Base {
        &self.base
    }

    /// Whether `effects` give the valve that it watches another play.
    pub(super) fn plays_otherwise(&self, effects: &Effects) -> bool {
        let play = |effects: &Effects, wheel| effects.arms[wheel].hysteresis;
        match self.generator {
            Generator::ArmStroke(w) => play(effects, w) != play(&self.base.effects, w),
            _ => false,
        }
    }

    /// Whether fixes that it looks at jump where `effects` set in.
    pub(super) fn jumps(&self, effects: &Effects) -> bool {
        let receiver =
            |effects: &Effects| (effects.sensors.gnss_latency, effects.sensors.gnss_lever_arm);
        matches!(self.generator, Generator::Travel | Generator::Turning)
            && receiver(effects) != receiver(&self.base.effects)
    }

    /// Sum of squares of `values` in each group.
    pub(super) fn squares(&self, values: &[f64]) -> Vec<f64> {
        let mut squares = vec![0.0; self.groups.len()];
        for (value, &group) in values.iter().zip(&self.group) {
            squares[group] += value * value;
        }
        squares
    }

    /// Values that follow one another and are of one group: which, from where and to where.
    pub(super) fn stretches(&self) -> Vec<(usize, Range<usize>)> {
        let mut from = 0;
        let each = self.group.chunk_by(|a, b| a == b).map(|stretch| {
            let range = from..from + stretch.len();
            from = range.end;
            (stretch[0], range)
        });
        each.collect()
    }

    /// Residuals on the run at place `number`: what was read before the base set in is told as if it never did, as a
    /// block that remembers would have the base's law all along.
    fn residuals(
        &self,
        number: usize,
        run: &Signals,
        machine: &Machine,
        schedule: EffectSchedule<'_>,
    ) -> Vec<Residual> {
        let (generator, since_s) = (self.generator, schedule.since_s());
        if !self.hears_base[number] {
            return generator.residuals_over(run, machine, schedule.without_base());
        }
        let mut all = generator.residuals_over(run, machine, schedule);
        if since_s > 0.0 {
            let before = generator.residuals_over(run, machine, schedule.without_base());
            for (residual, before) in all.iter_mut().zip(before) {
                let read_at_s = |i: usize| generator.read_at_s(residual.signal, i as f64 * STEP_S);
                let steps = 0..before.values.len();
                let until = steps.take_while(|i| read_at_s(*i) < since_s).count();
                residual.values[..until].copy_from_slice(&before.values[..until]);
            }
        }
        all
    }

    fn group_of(&mut self, signal: Signal) -> usize {
        self.groups.iter().position(|group| group.signal == signal).unwrap_or_else(|| {
            self.groups.push(Group { signal, samples: 0.0 });
            self.groups.len() - 1
        })
    }
}

/// Whether a base that sets in underway makes `generator` say anything else of a run.
fn hears_base(
    generator: Generator,
    run: &Signals,
    machine: &Machine,
    schedule: EffectSchedule<'_>,
) -> bool {
    let bits = |schedule| -> Vec<u64> {
        let all = generator.residuals_over(run, machine, schedule);
        all.iter().flat_map(|one| &one.values).map(|value| value.to_bits()).collect()
    };
    schedule.since_s() <= 0.0 || bits(schedule) != bits(schedule.without_base())
}
