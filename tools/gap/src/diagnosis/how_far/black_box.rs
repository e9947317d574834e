//! What a free model without physics would reach: the residual of the next sample from commands, states
//! and the residual itself, by ridge regression.
//!
//! The simulator stays as it is believed; beside it runs r' = r + W z(r, u, y), where r is the machine less
//! the simulator in floors, u are the commands and y is what the simulator shows. For each horizon W is
//! fitted on the same runs as the causes and rolled out from r = 0, with a ridge chosen by what that
//! leaves of data left out of the fit ([`folds`]); "no model" is among the choices, and no held-out run
//! is looked at. Where z lies further out than in any fit run, r goes back to nothing ([`Known`]).

use nalgebra::DVector;
use rayon::prelude::*;
use xt28_machine::Wheel;
use xt28_sim::Held;

use super::folds::{self, Fold, RIDGES};
use super::law::{Known, Law, Normal, scales};
use super::machine_sample::{Horizon, MachineSample, Quantity, TICKS_PER_SAMPLE, WIDTH, floors};
use super::squares::{self, BLOCK, Squares};
use super::twin::{Forecast, PreparedRun};
use super::{HorizonErrors, HowFar};
use crate::diagnosis::signals::Signals;
use crate::diagnosis::verdict::Shrink;

/// Commands of a sample: six strokes, throttle, front joint.
const COMMANDS: usize = 8;
/// A rolled-out residual stays within this many times the largest that was seen.
const REACH: f64 = 2.0;

/// The residual's next sample, fitted.
struct Model {
    law: Law,
    known: Known,
    reach: MachineSample,
}

/// A model with the scales of its inputs; without one, the simulator stays alone.
struct Learnt {
    scale: DVector<f64>,
    model: Option<Model>,
}

/// One forecast under what is believed, with what goes into a model of its residual.
struct Lesson {
    run: usize,
    /// Sample of the run that it begins with.
    from: usize,
    /// The machine less the simulator, floors; none where nothing is measured.
    error: Vec<[Option<f64>; WIDTH]>,
    /// The same; a number that is not known keeps its last value.
    residual: Vec<MachineSample>,
    /// What the simulator shows and by how much that changes, and the commands; one a sample.
    beside: Vec<Vec<f64>>,
}

impl HowFar {
    /// How far a free model of the residuals shrinks the gap on the judged runs.
    #[must_use]
    pub fn black_box(&self) -> Shrink {
        let left = |horizon: Horizon| -> Vec<Squares> {
            let lessons: Vec<Lesson> = self
                .runs
                .par_iter()
                .enumerate()
                .flat_map_iter(|(k, prepared)| lessons(k, prepared, self, horizon))
                .collect();
            let fitted: Vec<&Lesson> = lessons.iter().filter(|l| self.fits(l.run)).collect();
            let learnt = Learnt::of(&fitted);
            let judged = lessons.iter().filter(|lesson| self.judges(lesson.run));
            judged.flat_map(|lesson| learnt.left(lesson)).collect()
        };
        let [five_s, run] = [Horizon::FiveSeconds, Horizon::Run].map(left);
        self.shrink_of(&HorizonErrors { ahead: self.free_steps(), five_s, run })
    }
}

fn lessons(run: usize, prepared: &PreparedRun, far: &HowFar, horizon: Horizon) -> Vec<Lesson> {
    let floors = floors(horizon);
    let commands = commands(&prepared.signals);
    let forecasts = prepared.foretell(&far.machine, &far.believed, horizon, Held::default());
    let lesson = |forecast: Forecast| {
        let (mut error, mut beside) = (Vec::new(), Vec::new());
        for (k, ours) in forecast.samples.iter().enumerate() {
            let at = forecast.from + k;
            let of = |c: usize| {
                let measured = prepared.measured[at][c];
                measured.is_finite().then_some((measured - ours[c]) / floors[c])
            };
            error.push(core::array::from_fn(of));
            let before = &forecast.samples[k.saturating_sub(1)];
            let (now, past) = (commands[at], commands[at.saturating_sub(1)]);
            let shown = (0..WIDTH).filter(|c| !Quantity::Position.columns().contains(c));
            let state = shown.clone().map(|c| ours[c] / floors[c]);
            let change = shown.map(|c| (ours[c] - before[c]) / floors[c]);
            let all = state.chain(change).chain(now).chain(past).chain([1.0]);
            beside.push(all.map(|x| if x.is_finite() { x } else { 0.0 }).collect());
        }
        Lesson::new(run, forecast.from, error, beside)
    };
    forecasts.into_iter().map(lesson).collect()
}

impl Lesson {
    fn new(
        run: usize,
        from: usize,
        error: Vec<[Option<f64>; WIDTH]>,
        beside: Vec<Vec<f64>>,
    ) -> Self {
        let mut last = [0.0; WIDTH];
        let filled = |errors: &[Option<f64>; WIDTH]| {
            for (last, error) in last.iter_mut().zip(errors) {
                *last = error.filter(|error| error.is_finite()).unwrap_or(*last);
            }
            last
        };
        let residual = error.iter().map(filled).collect();
        Self { run, from, error, residual, beside }
    }

    /// Inputs of sample `k` with the residual before it, scaled.
    fn inputs(&self, residual: &MachineSample, k: usize, scale: &DVector<f64>) -> DVector<f64> {
        let all = residual.iter().chain(&self.beside[k]).zip(scale.iter());
        DVector::from_vec(all.map(|(x, scale)| x / scale).collect())
    }

    /// Squares of what `model` leaves of the errors at samples that `is_judged`, block by block.
    fn left(
        &self,
        model: Option<&Model>,
        scale: &DVector<f64>,
        is_judged: impl Fn(usize) -> bool,
    ) -> Vec<Squares> {
        let foretold = model.map(|model| model.roll_out(self, scale));
        let samples: Vec<usize> = (0..self.error.len()).collect();
        let block = |samples: &[usize]| {
            let mut squares = Squares::new(Quantity::ALL.len());
            for &k in samples.iter().filter(|&&k| is_judged(self.from + k)) {
                for (q, quantity) in Quantity::ALL.into_iter().enumerate() {
                    for c in quantity.columns() {
                        let ours = foretold.as_ref().map_or(0.0, |residuals| residuals[k][c]);
                        if let Some(error) = self.error[k][c] {
                            squares.add(q, error - ours);
                        }
                    }
                }
            }
            squares
        };
        samples.chunks(BLOCK).map(block).collect()
    }
}

/// What goes into a fit: samples of lessons with their inputs, added up once for all ridges.
struct Regression {
    inputs: Vec<DVector<f64>>,
    normal: Normal,
    reach: MachineSample,
}

impl Regression {
    fn of(
        lessons: &[&Lesson],
        scale: &DVector<f64>,
        is_fitted: impl Fn(usize, usize) -> bool,
    ) -> Self {
        let mut fit = Self {
            inputs: Vec::new(),
            normal: Normal::new(scale.len(), WIDTH),
            reach: [0.0; WIDTH],
        };
        for lesson in lessons {
            let fitted = |k: &usize| is_fitted(lesson.run, lesson.from + k);
            for k in (1..lesson.residual.len()).filter(fitted) {
                let (before, now) = (&lesson.residual[k - 1], &lesson.residual[k]);
                let inputs = lesson.inputs(before, k, scale);
                // The step of the residual, so that a ridge without end leaves it where it is.
                fit.normal.add(&inputs, &DVector::from_fn(WIDTH, |c, _| now[c] - before[c]));
                fit.inputs.push(inputs);
                for (reach, value) in fit.reach.iter_mut().zip(now) {
                    *reach = reach.max(REACH * value.abs());
                }
            }
        }
        fit
    }

    fn model(&self, ridge: f64) -> Option<Model> {
        Some(Model {
            law: self.normal.law(ridge)?,
            known: self.normal.known(ridge, self.inputs.iter())?,
            reach: self.reach,
        })
    }
}

impl Model {
    /// The residual along a lesson, from none at its start.
    fn roll_out(&self, lesson: &Lesson, scale: &DVector<f64>) -> Vec<MachineSample> {
        let mut residual = [0.0; WIDTH];
        let mut residuals = Vec::with_capacity(lesson.beside.len());
        for k in 0..lesson.beside.len() {
            if k > 0 {
                let inputs = lesson.inputs(&residual, k, scale);
                let (step, trust) = (self.law.of(&inputs), self.known.trust(&inputs));
                for c in 0..WIDTH {
                    let next = trust * (residual[c] + step[c]);
                    residual[c] = next.clamp(-self.reach[c], self.reach[c]);
                }
            }
            residuals.push(residual);
        }
        residuals
    }
}

impl Learnt {
    /// The model of these lessons, with the ridge that does best on what is left out of them.
    fn of(lessons: &[&Lesson]) -> Self {
        let all: Vec<DVector<f64>> = lessons
            .iter()
            .flat_map(|l| l.residual.iter().zip(&l.beside))
            .map(|(r, beside)| {
                DVector::from_iterator(WIDTH + beside.len(), r.iter().chain(beside).copied())
            })
            .collect();
        let scale = scales(all.iter());
        let left = |fold: &Fold| {
            let fit = Regression::of(lessons, &scale, |run, sample| fold.fits(run, sample));
            let of = |ridge: f64| {
                let model = fit.model(ridge);
                let blocks: Vec<Squares> = lessons
                    .iter()
                    .flat_map(|l| l.left(model.as_ref(), &scale, |k| fold.judges(l.run, k)))
                    .collect();
                squares::gap(&blocks)
            };
            RIDGES.map(of)
        };
        let folds = folds::folds(&runs(lessons));
        let by_fold: Vec<[f64; RIDGES.len()]> = folds.par_iter().map(left).collect();
        let model =
            Regression::of(lessons, &scale, |_, _| true).model(folds::choose(&by_fold, &folds));
        Self { scale, model }
    }

    /// Squares of what it leaves of a lesson's errors, block by block.
    fn left(&self, lesson: &Lesson) -> Vec<Squares> {
        lesson.left(self.model.as_ref(), &self.scale, |_| true)
    }
}

/// Runs of these lessons, in order, each with its samples.
fn runs(lessons: &[&Lesson]) -> Vec<(usize, usize)> {
    let mut runs: Vec<(usize, usize)> = Vec::new();
    for lesson in lessons {
        let end = lesson.from + lesson.error.len();
        match runs.last_mut() {
            Some((run, samples)) if *run == lesson.run => *samples = end.max(*samples),
            _ => runs.push((lesson.run, end)),
        }
    }
    runs
}

/// Commands sample by sample.
pub(super) fn commands(s: &Signals) -> Vec<[f64; COMMANDS]> {
    let at = |i: usize| {
        let mut all = [0.0; COMMANDS];
        for w in Wheel::ALL {
            all[w.index()] = s.target_stroke_m[w][i];
        }
        all[6] = s.throttle[i];
        all[7] = s.target_joint_rad[i];
        all
    };
    (0..s.len).step_by(TICKS_PER_SAMPLE).map(at).collect()
}

#[cfg(test)]
mod tests;
