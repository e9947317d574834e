//! Causes fitted anew on the whole machine, together with what differs from machine to machine.
//!
//! Least squares over the fit runs, 5 s ahead of measured states, by Levenberg and Marquardt on finite
//! differences. Errors are in floors, weighted for their correlation in time, and grow only linearly
//! beyond a few floors: a wheel that slips once must not decide. The machine's own tolerances
//! (neighbours) give way within their priors, so that a cause need not explain a heavier frame; they
//! are near enough linear for slopes taken once. What blocks say of a parameter stands beside what the whole
//! machine does, and its interval, which holds the truth as often as it should, bounds it: what the simulator does
//! not know of the whole machine draws a play of the joints down by a quarter. What comes out are the causes alone:
//! that is what an overlay can hold, and what is judged.

use nalgebra::{Cholesky, DMatrix, DVector};
use rayon::prelude::*;
use xt28_machine::Machine;
use xt28_sim::Effects;
use xt28_sim::effects::{Block, LOCK_STIFFNESS, Parameter, Scope};

use super::machine_sample::{Horizon, WIDTH, floors};
use super::squares::{self, BLOCK, LOST};
use super::twin::PreparedRun;
use super::{HowFar, since};
use crate::diagnosis::knob::{Knob, TOLERANCES};
use crate::diagnosis::onset::FirstOnset;
use crate::diagnosis::verdict::{Cause, Estimate, Shrink};

/// Tolerances of the machine that may give way beside a cause, and with them the stiffness of all arms' locks.
const NEIGHBOURS: [&str; 4] = ["front mass", "middle mass", "rear mass", "drive time constant"];
/// Errors beyond this count linearly, floors.
const ROBUST: f64 = 5.0;
/// Time after which errors of the whole machine are drawn anew, in samples: 2 s.
const CORRELATED: f64 = 20.0;
/// Rounds of slopes at most.
const ROUNDS: usize = 8;
/// A round that gains less than this share of the cost is the last.
const ENOUGH: f64 = 2.0e-3;
/// What is known of a parameter that the runs do not show, inverse squares of tolerances: it to ten of them, no better.
const UNSHOWN: f64 = 0.01;

/// Causes fitted anew.
#[derive(Clone, Debug)]
pub struct Refit {
    /// What is believed, with the causes at their best.
    pub effects: Effects,
    /// Parameters with their intervals, cause by cause.
    pub estimates: Vec<Vec<Estimate>>,
    /// How far they shrink the gap on the judged runs.
    pub shrink: Shrink,
    /// Gap on the fit runs over 5 s at the start and at the end, floors; never larger at the end.
    pub fit_gap: [f64; 2],
}

/// One parameter of one cause.
#[derive(Clone, Copy)]
struct Turn {
    cause: usize,
    scope: Scope,
    parameter: &'static Parameter,
    /// What blocks leave it uncertain by, tolerances; infinite where they say nothing.
    known_by: f64,
    /// Values that they leave open.
    open: [f64; 2],
    /// Whether the whole machine answers to it. Commands come as they are in the log, so a bus shows not.
    shows: bool,
}

impl HowFar {
    /// Fits the parameters of `causes` together, from the values they have; where all of them begin in
    /// the middle of the runs, from the first beginning on.
    #[must_use]
    pub fn refit(&self, causes: &[Cause]) -> Refit {
        let (turns, since) = (turns(causes), &since(causes));
        let start: Vec<f64> = turns
            .iter()
            .map(|turn| {
                let of = |e: &&Estimate| e.name == turn.parameter.name;
                let estimate = causes[turn.cause].parameters.iter().find(of);
                let [low, high] = turn.parameter.range;
                estimate.map_or(turn.parameter.neutral, |e| e.value[0]).clamp(low, high)
            })
            .collect();
        let (at, sigma) = self.descend(&turns, &start, since);
        let fit_gap = |values: &[f64]| {
            let effects = self.turned(&turns, values);
            squares::gap(&self.squares(&effects, Horizon::FiveSeconds, since, |k| self.fits(k)))
        };
        let (before, after) = rayon::join(|| fit_gap(&start), || fit_gap(&at));
        let (at, after) = if after <= before { (at, after) } else { (start, before) };
        let effects = self.turned(&turns, &at);
        let mut estimates = vec![Vec::new(); causes.len()];
        for ((turn, value), sigma) in turns.iter().zip(&at).zip(&sigma) {
            let effect = causes[turn.cause].effect;
            let estimate = Estimate::new(effect, turn.parameter, *value, *sigma);
            let before = causes[turn.cause].parameters.iter().find(|e| e.name == estimate.name);
            estimates[turn.cause].push(match before {
                Some(before) if !turn.shows => *before,
                // Blocks and the whole machine have other faults: what they say apart is in doubt.
                Some(before) => estimate.reaching(before),
                None => estimate,
            });
        }
        let shrink = self.shrink_of(&self.gaps(&effects, since));
        Refit { shrink, effects, estimates, fit_gap: [before, after] }
    }

    /// What `effects` leave on the fit runs over 5 s, neighbours at their best: sum of squares in
    /// floors, each error counted as often as it is drawn anew. Differences of 2 are worth naming.
    #[must_use]
    pub fn cost(&self, effects: &Effects) -> f64 {
        let always = FirstOnset::default();
        let errors = self.errors(&self.machine, effects, &always);
        let (slopes, _) = self.neighbours(effects, &errors, &always);
        let (squares, gradient, matrix) = normal(&slopes, &errors);
        let matrix = matrix + DMatrix::identity(slopes.len(), slopes.len());
        let step = Cholesky::new(matrix).expect("a sum of squares and the identity");
        squares - gradient.dot(&step.solve(&gradient))
    }

    /// Whether a run is fitted: those marked so, or all where none is.
    pub(super) fn fits(&self, run: usize) -> bool {
        self.fit[run] || self.fit.iter().all(|fit| !*fit)
    }

    fn turned(&self, turns: &[Turn], values: &[f64]) -> Effects {
        let mut effects = self.believed.clone();
        for (turn, value) in turns.iter().zip(values) {
            turn.parameter.set(&mut effects, turn.scope, *value);
        }
        effects
    }

    /// Weighted errors of the fit runs, made robust; one number a sample and channel.
    fn errors(&self, machine: &Machine, effects: &Effects, since: &FirstOnset) -> Vec<f64> {
        let runs: Vec<&PreparedRun> = self
            .runs
            .iter()
            .enumerate()
            .filter(|(k, _)| self.fits(*k))
            .map(|(_, run)| run)
            .collect();
        let both = [&self.believed, effects];
        runs.par_iter().flat_map_iter(|run| errors(run, machine, both, since)).collect()
    }

    /// Slopes of the errors by each neighbour, a tolerance each.
    fn neighbours(
        &self,
        effects: &Effects,
        errors: &[f64],
        since: &FirstOnset,
    ) -> (Vec<Vec<f64>>, Vec<Knob>) {
        let knobs = neighbours();
        let slope = |knob: &Knob| {
            let (mut machine, mut effects) = (self.machine.clone(), effects.clone());
            knob.set(&mut machine, &mut effects, knob.neutral() + knob.tolerance());
            difference(&self.errors(&machine, &effects, since), errors, 1.0)
        };
        (knobs.par_iter().map(slope).collect(), knobs)
    }

    /// Best values, and the standard deviation of each.
    fn descend(&self, turns: &[Turn], start: &[f64], since: &FirstOnset) -> (Vec<f64>, Vec<f64>) {
        let effects_at = |values: &[f64]| self.turned(turns, values);
        let mut at = start.to_vec();
        let mut errors = self.errors(&self.machine, &effects_at(&at), since);
        let (beside, knobs) = self.neighbours(&effects_at(&at), &errors, since);
        // Neighbours as they were believed when `errors` were made, tolerances.
        let mut gave = DVector::<f64>::zeros(knobs.len());
        let mut damping = 1.0e-3;
        let mut sigma = vec![0.0; turns.len()];
        for _ in 0..ROUNDS {
            let slopes = self.slopes((turns, since), &at, &gave, &knobs, &errors);
            let all: Vec<Vec<f64>> = slopes.into_iter().chain(beside.iter().cloned()).collect();
            let (squares, mut gradient, mut matrix) = normal(&all, &errors);
            for (k, gave) in gave.iter().enumerate() {
                gradient[turns.len() + k] += gave;
                matrix[(turns.len() + k, turns.len() + k)] += 1.0;
            }
            for (k, turn) in turns.iter().enumerate() {
                gradient[k] += turn.away(at[k], start[k]) / turn.known_by;
                matrix[(k, k)] += turn.known_by.powi(-2);
            }
            let cost = squares + gave.norm_squared() + against(turns, start, &at);
            sigma = deviations(&matrix, turns, &all, &errors);
            let mut gained = 0.0;
            for _ in 0..3 {
                let mut damped = matrix.clone();
                for k in 0..damped.nrows() {
                    damped[(k, k)] += damping * matrix[(k, k)].max(1.0e-9);
                }
                let Some(factor) = Cholesky::new(damped) else { break };
                let step = -factor.solve(&gradient);
                let moved: Vec<f64> = turns.iter().zip(&at).zip(step.iter()).map(move_by).collect();
                let giving = &gave + step.rows(turns.len(), knobs.len());
                let (machine, effects) = self.given(&knobs, &giving, effects_at(&moved));
                let trial = self.errors(&machine, &effects, since);
                let after = sum(&trial) + giving.norm_squared() + against(turns, start, &moved);
                if after < cost {
                    gained = 1.0 - after / cost;
                    (at, gave, errors) = (moved, giving, trial);
                    damping *= 0.1;
                    break;
                }
                damping = (damping * 30.0_f64).max(0.03);
            }
            if gained < ENOUGH {
                break;
            }
        }
        (at, sigma)
    }

    /// The machine with neighbours that gave way.
    fn given(
        &self,
        knobs: &[Knob],
        gave: &DVector<f64>,
        mut effects: Effects,
    ) -> (Machine, Effects) {
        let mut machine = self.machine.clone();
        for (knob, gave) in knobs.iter().zip(gave.iter()) {
            let value = knob.neutral() + gave * knob.tolerance();
            knob.set(&mut machine, &mut effects, value);
        }
        (machine, effects)
    }

    /// Slopes of the errors by each parameter, in tolerances.
    fn slopes(
        &self,
        (turns, since): (&[Turn], &FirstOnset),
        at: &[f64],
        gave: &DVector<f64>,
        knobs: &[Knob],
        errors: &[f64],
    ) -> Vec<Vec<f64>> {
        let slope = |k: usize| {
            if !turns[k].shows {
                return vec![0.0; errors.len()];
            }
            let parameter = turns[k].parameter;
            let far = (at[k] - parameter.neutral).abs();
            let nudge = (0.3 * parameter.tolerance).max(0.04 * far);
            let room = parameter.range[1] - at[k];
            let nudge = if room >= nudge { nudge } else { -nudge };
            let mut moved = at.to_vec();
            moved[k] += nudge;
            let (machine, effects) = self.given(knobs, gave, self.turned(turns, &moved));
            difference(&self.errors(&machine, &effects, since), errors, nudge / parameter.tolerance)
        };
        (0..turns.len()).into_par_iter().map(slope).collect()
    }
}

impl Turn {
    /// How far `value` is from what blocks say, by what these leave uncertain.
    fn away(&self, value: f64, said: f64) -> f64 {
        (value - said) / self.parameter.tolerance / self.known_by
    }
}

/// What blocks that `said` something have against values of `at`, as squares.
fn against(turns: &[Turn], said: &[f64], at: &[f64]) -> f64 {
    let each = turns.iter().zip(said.iter().zip(at));
    each.map(|(turn, (said, at))| turn.away(*at, *said).powi(2)).sum()
}

fn turns(causes: &[Cause]) -> Vec<Turn> {
    let of = |(cause, c): (usize, &Cause)| {
        let (scope, shows) = (c.scope, c.effect.block != Block::Bus);
        let turn = move |parameter: &'static Parameter| {
            let known = c.parameters.iter().find(|e| e.name == parameter.name);
            let known_by = known.map_or(f64::INFINITY, |e| e.deviation() / parameter.tolerance);
            let [low, high] = parameter.range;
            let [from, to] = known.map_or(parameter.range, Estimate::interval);
            let open = [from.max(low), to.min(high)];
            Turn { cause, scope, parameter, known_by, open, shows }
        };
        c.effect.parameters.iter().map(turn).collect::<Vec<_>>()
    };
    causes.iter().enumerate().flat_map(of).collect()
}

/// A parameter moved by a step in tolerances, within what is open.
fn move_by(((turn, at), step): ((&Turn, &f64), &f64)) -> f64 {
    let [low, high] = turn.open;
    (at + step * turn.parameter.tolerance).clamp(low, high)
}

/// Errors of one run, each forecast filled up with zeros to a whole block.
fn errors(
    run: &PreparedRun,
    machine: &Machine,
    both: [&Effects; 2],
    since: &FirstOnset,
) -> Vec<f64> {
    let floors = floors(Horizon::FiveSeconds);
    let foretold = run.foretell_since(machine, both, since, Horizon::FiveSeconds);
    let mut errors = Vec::new();
    for forecast in &foretold {
        for (measured, ours) in run.measured[forecast.from..].iter().zip(&forecast.samples) {
            for c in 0..WIDTH {
                let error = match (ours[c].is_finite(), measured[c].is_finite()) {
                    (true, true) => robust((ours[c] - measured[c]) / floors[c]),
                    // As where it is judged: a machine that was thrown about is no better for it.
                    (false, true) => robust(LOST),
                    (_, false) => 0.0,
                };
                errors.push(error / CORRELATED.sqrt());
            }
        }
        errors.resize(errors.len().next_multiple_of(BLOCK * WIDTH), 0.0);
    }
    errors
}

/// The error whose square is Huber's loss.
fn robust(error: f64) -> f64 {
    let size = error.abs();
    if size <= ROBUST {
        return error;
    }
    (2.0 * ROBUST * size - ROBUST * ROBUST).sqrt().copysign(error)
}

fn sum(errors: &[f64]) -> f64 {
    errors.iter().map(|e| e * e).sum()
}

fn difference(moved: &[f64], errors: &[f64], by: f64) -> Vec<f64> {
    moved.iter().zip(errors).map(|(m, e)| (m - e) / by).collect()
}

/// Squares, gradient and matrix of the normal equations.
fn normal(slopes: &[Vec<f64>], errors: &[f64]) -> (f64, DVector<f64>, DMatrix<f64>) {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let n = slopes.len();
    let gradient = DVector::from_fn(n, |k, _| dot(&slopes[k], errors));
    let matrix = DMatrix::from_fn(n, n, |i, j| dot(&slopes[i], &slopes[j]));
    (sum(errors), gradient, matrix)
}

/// Standard deviation of each parameter, tolerant of what is left: errors are alike within 5 s, on all
/// channels at once, and independent beyond (the sandwich estimator, clusters of a segment each).
fn deviations(
    matrix: &DMatrix<f64>,
    turns: &[Turn],
    slopes: &[Vec<f64>],
    errors: &[f64],
) -> Vec<f64> {
    let n = slopes.len();
    let mut bread = matrix.clone();
    for k in 0..turns.len() {
        bread[(k, k)] += UNSHOWN;
    }
    let Some(factor) = Cholesky::new(bread) else { return vec![0.0; turns.len()] };
    let mut meat = DMatrix::<f64>::identity(n, n) * UNSHOWN;
    for (segment, errors) in errors.chunks(BLOCK * WIDTH).enumerate() {
        let from = segment * BLOCK * WIDTH;
        let pull = DVector::from_fn(n, |k, _| {
            slopes[k][from..].iter().zip(errors).map(|(s, e)| s * e).sum::<f64>()
        });
        meat.ger(1.0, &pull, &pull, 1.0);
    }
    let inverse = factor.inverse();
    let robust = &inverse * meat * &inverse;
    let of = |(k, turn): (usize, &Turn)| {
        robust[(k, k)].max(inverse[(k, k)]).max(0.0).sqrt() * turn.parameter.tolerance
    };
    turns.iter().enumerate().map(of).collect()
}

/// The tolerances of [`NEIGHBOURS`] and the locks'.
fn neighbours() -> Vec<Knob> {
    let named = |name| TOLERANCES.iter().find(|tolerance| tolerance.name == name);
    let of_machine = NEIGHBOURS.map(|name| Knob::Machine(named(name).expect("a tolerance's name")));
    let locks = LOCK_STIFFNESS.parameters.iter();
    let locks = locks.map(|parameter| Knob::Effect(&LOCK_STIFFNESS, parameter, Scope::All));
    of_machine.into_iter().chain(locks).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn five_tolerances_give_way_beside_a_cause() {
        let told: Vec<String> = neighbours().iter().map(ToString::to_string).collect();
        let named = ["front mass", "middle mass", "rear mass", "drive time constant"];
        assert_eq!(told[..4], named);
        assert!(told[4].starts_with("lock-stiffness all") && told.len() == 5, "{told:?}");
    }

    #[test]
    fn a_large_error_counts_linearly() {
        assert_eq!(robust(-3.0), -3.0);
        let square = |e: f64| robust(e).powi(2);
        assert!((square(ROBUST) - 25.0).abs() < 1e-12);
        assert!((square(101.0) - square(100.0) - 2.0 * ROBUST).abs() < 1e-9);
    }
}
