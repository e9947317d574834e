//! What a free model without physics would reach: the residual of the next sample from commands, states
//! and the residual itself, by ridge regression.
//!
//! The simulator stays as it is believed; beside it runs r' = W z(r, u, y), where r is the machine less
//! the simulator in floors, u are the commands and y is what the simulator shows. W is fitted on the
//! same runs as the causes, and rolled out from r = 0 over the same horizons. Its ridge is chosen by
//! leaving out one fit run after the other, rolled out over 5 s; "no model" is among the choices, and no
//! held-out run is looked at.

use nalgebra::{Cholesky, DMatrix, DVector};
use rayon::prelude::*;
use xt28_machine::Wheel;
use xt28_sim::Held;

use super::course::{Horizon, Quantity, Row, STRIDE, WIDTH, floors};
use super::squares::{self, BLOCK, Squares};
use super::twin::{Course, Stretch};
use super::{Gaps, HowFar};
use crate::diagnosis::signals::Signals;
use crate::diagnosis::verdict::Shrink;

/// Commands of a sample: six strokes, throttle, front joint.
const COMMANDS: usize = 8;
/// Ridges to choose from, in units of an input's mean square; the last leaves no model.
const RIDGES: [f64; 6] = [1.0e-4, 1.0e-3, 1.0e-2, 0.1, 1.0, f64::INFINITY];
/// A rolled-out residual stays within this many times the largest that was seen.
const REACH: f64 = 2.0;

/// The residual's next sample, fitted.
struct Model {
    /// One column a number of the residual, one row an input.
    weights: DMatrix<f64>,
    reach: Row,
}

/// One stretch under what is believed, with what goes into a model of its residual.
struct Lesson {
    run: usize,
    /// The machine less the simulator, floors; a number that is not known keeps its last value.
    residual: Vec<Row>,
    /// What the simulator shows and by how much that changes, and the commands; one a sample.
    beside: Vec<Vec<f64>>,
}

impl HowFar {
    /// How far a free model of the residuals shrinks the gap on the judged runs.
    #[must_use]
    pub fn black_box(&self) -> Shrink {
        let [five_s, run] = [Horizon::FiveSeconds, Horizon::Run].map(|horizon| {
            let lessons: Vec<Lesson> = self
                .courses
                .par_iter()
                .enumerate()
                .flat_map_iter(|(k, course)| self.lessons(k, course, horizon))
                .collect();
            lessons
        });
        let fitted: Vec<&Lesson> = five_s.iter().filter(|l| self.fits(l.run)).collect();
        let scale = scales(&fitted);
        let chosen = choose(&fitted, &scale);
        let model = Model::fit(&fitted, &scale, chosen);
        let after = |lessons: &[Lesson]| -> Vec<Squares> {
            let judged = lessons.iter().filter(|lesson| self.judges(lesson.run));
            judged.flat_map(|lesson| lesson.left(model.as_ref(), &scale)).collect()
        };
        let gaps = Gaps { ahead: self.free_steps(), five_s: after(&five_s), run: after(&run) };
        self.shrink_of(&gaps)
    }

    fn lessons(&self, run: usize, course: &Course, horizon: Horizon) -> Vec<Lesson> {
        let floors = floors(horizon);
        let commands = commands(&course.signals);
        let stretches = course.foretell(&self.machine, &self.believed, horizon, Held::default());
        let lesson = |stretch: Stretch| {
            let (mut residual, mut beside) = (Vec::new(), Vec::new());
            let mut last = [0.0; WIDTH];
            for (k, ours) in stretch.rows.iter().enumerate() {
                let at = stretch.from + k;
                for (c, last) in last.iter_mut().enumerate() {
                    let error = (course.measured[at][c] - ours[c]) / floors[c];
                    *last = if error.is_finite() { error } else { *last };
                }
                residual.push(last);
                let before = &stretch.rows[k.saturating_sub(1)];
                let (now, past) = (commands[at], commands[at.saturating_sub(1)]);
                let shown = (0..WIDTH).filter(|c| !Quantity::Position.columns().contains(c));
                let state = shown.clone().map(|c| ours[c] / floors[c]);
                let change = shown.map(|c| (ours[c] - before[c]) / floors[c]);
                let all = state.chain(change).chain(now).chain(past).chain([1.0]);
                beside.push(all.map(|x| if x.is_finite() { x } else { 0.0 }).collect());
            }
            Lesson { run, residual, beside }
        };
        stretches.into_iter().map(lesson).collect()
    }
}

impl Lesson {
    /// Squares of what `model` leaves of the residual, block by block.
    fn left(&self, model: Option<&Model>, scale: &[f64]) -> Vec<Squares> {
        let foretold = model.map(|model| model.roll_out(self, scale));
        let error = |k: usize, c: usize| {
            self.residual[k][c] - foretold.as_ref().map_or(0.0, |rows| rows[k][c])
        };
        let samples: Vec<usize> = (0..self.residual.len()).collect();
        let block = |samples: &[usize]| {
            let mut squares = Squares::new(Quantity::ALL.len());
            for (q, quantity) in Quantity::ALL.into_iter().enumerate() {
                for &k in samples {
                    quantity.columns().for_each(|c| squares.add(q, error(k, c)));
                }
            }
            squares
        };
        samples.chunks(BLOCK).map(block).collect()
    }
}

impl Model {
    /// The model of these lessons; none for a ridge without end.
    fn fit(lessons: &[&Lesson], scale: &[f64], ridge: f64) -> Option<Self> {
        if ridge.is_infinite() {
            return None;
        }
        let inputs = scale.len();
        let mut matrix = DMatrix::<f64>::zeros(inputs, inputs);
        let mut right = DMatrix::<f64>::zeros(inputs, WIDTH);
        let (mut samples, mut reach) = (0.0, [0.0_f64; WIDTH]);
        for lesson in lessons {
            for k in 1..lesson.residual.len() {
                let z =
                    DVector::from_vec(inputs_of(&lesson.residual[k - 1], &lesson.beside[k], scale));
                matrix.ger(1.0, &z, &z, 1.0);
                // The step of the residual, so that a ridge without end leaves it where it is.
                let step = DVector::from_fn(WIDTH, |c, _| {
                    lesson.residual[k][c] - lesson.residual[k - 1][c]
                });
                right.ger(1.0, &z, &step, 1.0);
                samples += 1.0;
                for (reach, value) in reach.iter_mut().zip(&lesson.residual[k]) {
                    *reach = reach.max(REACH * value.abs());
                }
            }
        }
        for k in 0..inputs {
            matrix[(k, k)] += ridge * f64::max(samples, 1.0);
        }
        let weights = Cholesky::new(matrix)?.solve(&right);
        Some(Self { weights, reach })
    }

    /// The residual along a lesson, from none at its start.
    fn roll_out(&self, lesson: &Lesson, scale: &[f64]) -> Vec<Row> {
        let mut residual = [0.0; WIDTH];
        let mut rows = Vec::with_capacity(lesson.beside.len());
        for (k, beside) in lesson.beside.iter().enumerate() {
            if k > 0 {
                let z = DVector::from_vec(inputs_of(&residual, beside, scale));
                let step = self.weights.tr_mul(&z);
                for c in 0..WIDTH {
                    residual[c] = (residual[c] + step[c]).clamp(-self.reach[c], self.reach[c]);
                }
            }
            rows.push(residual);
        }
        rows
    }
}

/// The ridge that leaves least of a run that it was not fitted on, rolled out over 5 s.
fn choose(lessons: &[&Lesson], scale: &[f64]) -> f64 {
    let mut runs: Vec<usize> = lessons.iter().map(|lesson| lesson.run).collect();
    runs.dedup();
    let left = |ridge: f64| {
        let of = |&run: &usize| {
            let others: Vec<&Lesson> = lessons.iter().filter(|l| l.run != run).copied().collect();
            let model = Model::fit(&others, scale, ridge);
            let out = lessons.iter().filter(|l| l.run == run);
            out.flat_map(|lesson| lesson.left(model.as_ref(), scale)).collect::<Vec<_>>()
        };
        let blocks: Vec<Squares> = runs.par_iter().flat_map_iter(of).collect();
        squares::gap(&blocks)
    };
    let tried = RIDGES.map(|ridge| (left(ridge), ridge));
    tried.into_iter().min_by(|a, b| a.0.total_cmp(&b.0)).map_or(f64::INFINITY, |best| best.1)
}

/// Root mean square of each input over the lessons; one for an input that is always naught.
#[allow(clippy::cast_precision_loss)]
fn scales(lessons: &[&Lesson]) -> Vec<f64> {
    let mut sums = Vec::new();
    let mut samples = 0_usize;
    for lesson in lessons {
        for (residual, beside) in lesson.residual.iter().zip(&lesson.beside) {
            let all = residual.iter().chain(beside);
            sums.resize(WIDTH + beside.len(), 0.0);
            sums.iter_mut().zip(all).for_each(|(sum, x)| *sum += x * x);
            samples += 1;
        }
    }
    let scale = |sum: f64| if sum > 0.0 { (sum / samples as f64).sqrt() } else { 1.0 };
    sums.into_iter().map(scale).collect()
}

fn inputs_of(residual: &Row, beside: &[f64], scale: &[f64]) -> Vec<f64> {
    residual.iter().chain(beside).zip(scale).map(|(x, scale)| x / scale).collect()
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
    (0..s.len).step_by(STRIDE).map(at).collect()
}
