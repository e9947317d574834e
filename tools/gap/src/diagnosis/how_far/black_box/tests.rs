//! The free model on residuals that are made up: chance is not learnt, a law is.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::*;

/// Samples of a run: 30 s.
const SAMPLES: usize = 300;
/// Inputs beside the residual: about as many as a machine has.
const BESIDE: usize = 30;

/// A run in stretches of 5 s with slow inputs, each input of the size given; what the error becomes
/// from what it was, the inputs and chance.
fn run(
    run: usize,
    sizes: &dyn Fn(usize) -> f64,
    mut becomes: impl FnMut(f64, &[f64], &mut dyn FnMut() -> f64) -> f64,
) -> Vec<Lesson> {
    let mut random = ChaCha8Rng::seed_from_u64(run as u64);
    let mut chance = move || random.random_range(-1.0..1.0_f64);
    let mut beside: Vec<f64> = vec![0.0; BESIDE];
    let mut stretch = |from: usize| {
        let (mut errors, mut inputs) = (Vec::new(), Vec::new());
        let mut error = [0.0; WIDTH];
        for k in 0..BLOCK {
            for (i, x) in beside.iter_mut().enumerate() {
                *x = 0.7 * *x + sizes(i) * chance();
            }
            beside[BESIDE - 1] = 1.0;
            for error in &mut error {
                *error = if k == 0 { 0.0 } else { becomes(*error, &beside, &mut chance) };
            }
            errors.push(error.map(Some));
            inputs.push(beside.clone());
        }
        Lesson::new(run, from, errors, inputs)
    };
    (0..SAMPLES).step_by(BLOCK).map(&mut stretch).collect()
}

/// How far what is learnt of the first lessons shrinks the second ones.
fn shrink(fitted: &[Vec<Lesson>], judged: &[Lesson]) -> f64 {
    let fitted: Vec<&Lesson> = fitted.iter().flatten().collect();
    let (learnt, none) = (Learnt::of(&fitted), Learnt { scale: DVector::zeros(0), model: None });
    let gap = |learnt: &Learnt| {
        squares::gap(&judged.iter().flat_map(|lesson| learnt.left(lesson)).collect::<Vec<_>>())
    };
    1.0 - gap(&learnt) / gap(&none)
}

#[test]
fn of_pure_noise_nothing_is_learnt_however_few_the_runs() {
    for runs in 1..4 {
        for seed in 0..4 {
            let noise = |k: usize| {
                run(10 * seed + k, &|_| 1.0, |_, _, chance: &mut dyn FnMut() -> f64| chance())
            };
            let shrink = shrink(&(0..runs).map(noise).collect::<Vec<_>>(), &noise(9));
            assert!(shrink.abs() < 0.03, "{runs} runs, seed {seed}: {shrink}");
        }
    }
}

#[test]
fn a_linear_law_is_learnt_however_few_the_runs() {
    for runs in 1..4 {
        let lawful = |k: usize| {
            run(k, &|_| 1.0, |error, x, chance: &mut dyn FnMut() -> f64| {
                0.9 * error + 0.5 * x[3] - 0.2 * x[7] + 0.05 * chance()
            })
        };
        let shrink = shrink(&(0..runs).map(lawful).collect::<Vec<_>>(), &lawful(9));
        assert!(shrink > 0.4, "{runs} runs: {shrink}");
    }
}

/// A manoeuvre that moves what the fit runs left at rest: their law is not carried over to it.
#[test]
fn what_no_fit_run_moved_is_not_guessed_at() {
    let lawful = |error: f64, x: &[f64], chance: &mut dyn FnMut() -> f64| {
        0.9 * error + 0.5 * x[3] + 0.1 * x[7] + 0.05 * chance()
    };
    let first = run(0, &|i| if i < 5 { 1.0 } else { 0.01 }, lawful);
    let other = |error: f64, _: &[f64], chance: &mut dyn FnMut() -> f64| 0.5 * error + chance();
    let second = run(1, &|i| if i < 5 { 0.01 } else { 20.0 }, other);
    let shrink = shrink(&[first], &second);
    assert!(shrink > -0.05, "{shrink}");
}
