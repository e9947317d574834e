//! What a free model would reach a tenth of a second ahead: each block's error from what is measured
//! and commanded at the same sample, by ridge regression.
//!
//! Fitted on the fit runs, block signal by block signal; each has the ridge that leaves least of what is
//! left out of the fit ([`folds`]), "no model" among the choices. It says less the further its inputs lie
//! from those of the fit runs ([`Known`]), and never more than the largest error that was seen there.

use nalgebra::DVector;
use rayon::prelude::*;

use super::HowFar;
use super::black_box::commands;
use super::folds::{self, Fold, RIDGES};
use super::law::{Known, Law, Normal, scales};
use super::machine_sample::{Horizon, Quantity, WIDTH, floors};
use super::one_step::{self, OneStepErrors};
use super::twin::PreparedRun;

/// Errors and inputs of one run, sample by sample.
struct Lesson {
    run: usize,
    ahead: OneStepErrors,
    inputs: Vec<DVector<f64>>,
}

/// What is known with each of [`RIDGES`] of the samples that were not left out, and how far the others
/// can be trusted.
struct Trusts {
    fold: Fold,
    /// A ridge and a run each; one share a sample.
    shares: Vec<Vec<Vec<f64>>>,
}

/// One signal's error, fitted.
struct Model {
    law: Law,
    ridge: usize,
    reach: f64,
}

impl HowFar {
    /// What a free model leaves of the blocks' errors on the judged runs.
    pub(super) fn free_steps(&self) -> Vec<OneStepErrors> {
        let of = |(run, prepared): (usize, &PreparedRun)| {
            let ahead = one_step::ahead(&prepared.signals, &self.machine, &self.believed);
            Lesson { run, ahead, inputs: inputs(prepared) }
        };
        let lessons: Vec<Lesson> = self.runs.par_iter().enumerate().map(of).collect();
        left(lessons, |run| self.fits(run), |run| self.judges(run))
    }
}

/// What is left of the errors of judged lessons once a model of the fitted ones is taken off.
fn left(
    mut lessons: Vec<Lesson>,
    fits: impl Fn(usize) -> bool,
    judges: impl Fn(usize) -> bool,
) -> Vec<OneStepErrors> {
    let fitted = lessons.iter().filter(|lesson| fits(lesson.run));
    let scale = scales(fitted.flat_map(|lesson| &lesson.inputs));
    for inputs in lessons.iter_mut().flat_map(|lesson| &mut lesson.inputs) {
        inputs.component_div_assign(&scale);
    }
    let fitted: Vec<&Lesson> = lessons.iter().filter(|lesson| fits(lesson.run)).collect();
    let signals = fitted.first().map_or(0, |lesson| lesson.ahead.len());
    let runs: Vec<(usize, usize)> = fitted.iter().map(|l| (l.run, l.inputs.len())).collect();
    let trusts: Vec<Trusts> =
        folds::folds(&runs).into_par_iter().map(|fold| Trusts::of(fold, &fitted)).collect();
    let models: Vec<Option<Model>> =
        (0..signals).into_par_iter().map(|j| Model::of(j, &fitted, &trusts)).collect();
    let known = RIDGES.map(|ridge| known(&fitted, ridge, |_, _| true));
    let judged = lessons.iter().filter(|lesson| judges(lesson.run));
    let after = |lesson: &Lesson| {
        let mut ahead = lesson.ahead.clone();
        for ((_, errors), model) in ahead.iter_mut().zip(&models) {
            let Some((model, known)) =
                model.as_ref().and_then(|m| Some((m, known[m.ridge].as_ref()?)))
            else {
                continue;
            };
            for (error, z) in errors.iter_mut().zip(&lesson.inputs) {
                *error -= model.says(z, known.trust(z));
            }
        }
        ahead
    };
    judged.map(after).collect()
}

/// What is known of the samples that are fitted.
fn known(
    lessons: &[&Lesson],
    ridge: f64,
    is_fitted: impl Fn(usize, usize) -> bool,
) -> Option<Known> {
    let of = |lesson: &&'_ Lesson| {
        let run = lesson.run;
        (0..lesson.inputs.len()).filter(|&k| is_fitted(run, k)).collect::<Vec<_>>()
    };
    let chosen: Vec<&DVector<f64>> =
        lessons.iter().flat_map(|l| of(l).into_iter().map(|k| &l.inputs[k])).collect();
    let mut normal = Normal::new(chosen.first()?.len(), 0);
    chosen.iter().for_each(|z| normal.add(z, &DVector::zeros(0)));
    normal.known(ridge, chosen.into_iter())
}

impl Trusts {
    fn of(fold: Fold, lessons: &[&Lesson]) -> Self {
        let of = |ridge: f64| -> Vec<Vec<f64>> {
            let known = known(lessons, ridge, |run, k| fold.fits(run, k));
            let share = |lesson: &Lesson, k: usize| match &known {
                Some(known) if fold.judges(lesson.run, k) => known.trust(&lesson.inputs[k]),
                _ => 0.0,
            };
            lessons.iter().map(|l| (0..l.inputs.len()).map(|k| share(l, k)).collect()).collect()
        };
        Self { fold, shares: RIDGES.map(of).into() }
    }
}

impl Model {
    /// The model of signal `j`; none where none leaves as little.
    fn of(j: usize, lessons: &[&Lesson], trusts: &[Trusts]) -> Option<Self> {
        let left = |trusts: &Trusts| {
            let (normal, reach) = normal(j, lessons, |run, k| trusts.fold.fits(run, k));
            let of = |ridge: usize| {
                let model = normal.law(RIDGES[ridge]).map(|law| Self { law, ridge, reach });
                let (mut sum, mut count) = (0.0, 0.0);
                for (lesson, trust) in lessons.iter().zip(&trusts.shares[ridge]) {
                    for (k, error, z) in samples(j, lesson) {
                        if trusts.fold.judges(lesson.run, k) {
                            let said = model.as_ref().map_or(0.0, |model| model.says(z, trust[k]));
                            sum += (error - said).powi(2);
                            count += 1.0;
                        }
                    }
                }
                (sum / f64::max(count, 1.0)).sqrt()
            };
            core::array::from_fn(of)
        };
        let by_fold: Vec<[f64; RIDGES.len()]> = trusts.iter().map(left).collect();
        let folds: Vec<Fold> = trusts.iter().map(|trusts| trusts.fold).collect();
        let chosen = folds::choose(&by_fold, &folds);
        let ridge = RIDGES.iter().position(|ridge| ridge.total_cmp(&chosen).is_eq())?;
        let (normal, reach) = normal(j, lessons, |_, _| true);
        Some(Self { law: normal.law(chosen)?, ridge, reach })
    }

    fn says(&self, inputs: &DVector<f64>, trust: f64) -> f64 {
        (trust * self.law.of(inputs)[0]).clamp(-self.reach, self.reach)
    }
}

/// Samples of signal `j` that can be judged: number, error, inputs.
fn samples(j: usize, lesson: &Lesson) -> impl Iterator<Item = (usize, f64, &DVector<f64>)> {
    let all = lesson.ahead[j].1.iter().zip(&lesson.inputs).enumerate();
    all.filter(|(_, (error, _))| error.is_finite()).map(|(k, (error, z))| (k, *error, z))
}

/// Samples of signal `j` that are fitted, added up, and the largest error among them.
fn normal(
    j: usize,
    lessons: &[&Lesson],
    is_fitted: impl Fn(usize, usize) -> bool,
) -> (Normal, f64) {
    let inputs = lessons.iter().find_map(|lesson| lesson.inputs.first()).map_or(0, DVector::len);
    let (mut normal, mut reach) = (Normal::new(inputs, 1), 0.0_f64);
    for lesson in lessons {
        for (_, error, z) in samples(j, lesson).filter(|(k, ..)| is_fitted(lesson.run, *k)) {
            normal.add(z, &DVector::from_element(1, error));
            reach = reach.max(error.abs());
        }
    }
    (normal, reach)
}

/// What is measured, how that changes and what is commanded, sample by sample, in floors.
fn inputs(prepared: &PreparedRun) -> Vec<DVector<f64>> {
    let floors = floors(Horizon::FiveSeconds);
    let commands = commands(&prepared.signals);
    let at = |k: usize| {
        let (now, before) = (&prepared.measured[k], &prepared.measured[k.saturating_sub(1)]);
        let shown = (0..WIDTH).filter(|c| !Quantity::Position.columns().contains(c));
        let state = shown.clone().map(|c| now[c] / floors[c]);
        let change = shown.map(|c| (now[c] - before[c]) / floors[c]);
        let past = commands[k.saturating_sub(1)];
        let all = state.chain(change).chain(commands[k]).chain(past).chain([1.0]);
        DVector::from_vec(all.map(|x| if x.is_finite() { x } else { 0.0 }).collect())
    };
    (0..prepared.measured.len()).map(at).collect()
}

#[cfg(test)]
mod tests;
