//! The free model a tenth of a second ahead on errors that are made up: chance is not learnt, a law is.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::*;
use crate::diagnosis::floor::Signal;

/// Samples of a run: 30 s.
const SAMPLES: usize = 300;
/// Inputs: about as many as a machine has.
const INPUTS: usize = 30;

/// A run with slow inputs; the error of its one signal from these and chance.
fn lesson(run: usize, size: f64, error: impl Fn(&[f64], f64) -> f64) -> Lesson {
    let mut random = ChaCha8Rng::seed_from_u64(run as u64);
    let mut inputs = vec![0.0; INPUTS];
    let (mut errors, mut all) = (Vec::new(), Vec::new());
    for _ in 0..SAMPLES {
        for (i, x) in inputs.iter_mut().enumerate() {
            let size = if i < INPUTS / 2 { 1.0 } else { size };
            *x = 0.7 * *x + size * random.random_range(-1.0..1.0_f64);
        }
        errors.push(error(&inputs, random.random_range(-1.0..1.0)));
        all.push(DVector::from_vec(inputs.clone()));
    }
    Lesson { run, ahead: vec![(Signal::Stroke, errors)], inputs: all }
}

/// How far what is learnt of the first runs shrinks the last one.
fn shrink(lessons: Vec<Lesson>) -> f64 {
    let judged = lessons.len() - 1;
    let rms = |errors: &[f64]| errors.iter().map(|e| e * e).sum::<f64>().sqrt();
    let before = rms(&lessons[judged].ahead[0].1);
    let after = left(lessons, |run| run != 9, |run| run == 9);
    1.0 - rms(&after[0][0].1) / before
}

#[test]
fn chance_is_not_learnt_and_a_law_is() {
    for runs in 1..4 {
        let of = |error: fn(&[f64], f64) -> f64| {
            shrink((0..runs).chain([9]).map(|k| lesson(k, 1.0, error)).collect())
        };
        let (noise, law) = (of(|_, chance| chance), of(|x, chance| 2.0 * x[2] + 0.3 * chance));
        assert!(noise.abs() < 0.03, "{runs} runs: {noise}");
        assert!(law > 0.7, "{runs} runs: {law}");
    }
}

#[test]
fn what_no_fit_run_moved_is_not_guessed_at() {
    let first = lesson(0, 0.01, |x, chance| 2.0 * x[2] + 30.0 * x[INPUTS - 1] + 0.3 * chance);
    let shrink = shrink(vec![first, lesson(9, 20.0, |_, chance| chance)]);
    assert!(shrink > -0.05, "{shrink}");
}
