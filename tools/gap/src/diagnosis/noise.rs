//! How noisy the readings of a log are, and how far that lifts the floors of what is made of them.
//!
//! A floor is what separates two models of one machine that has ordinary sensors. A worse sensor adds to
//! it: its noise is taken from the log, where its reading is calmest, and what it makes of each block's
//! error is found by adding as much once more.

use std::collections::BTreeMap;

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use xt28_machine::{Machine, PerWheel, Wheel};
use xt28_sim::Effects;

use super::floors::Floors;
use super::generator::{Generator, Residual};
use super::signals::{Signals, unwound};
use crate::{Channel, PumpSide, Series};

/// Readings of one stretch of a log whose noise is estimated together.
const STRETCH: usize = 40;
/// Which of all stretches counts, by rank: the calmest moves least, and moving looks like noise.
const CALM_SHARE: f64 = 0.25;
/// What the readings' noise makes of a block's error on machines with ordinary sensors, in floors, which
/// have that in them: on the logs of two kinds of foreign plants it is 0.83 at most, in speed over ground.
const ORDINARY: f64 = 0.9;
/// Standard deviation of a normal distribution, by the median of its size.
const NORMAL_PER_MEDIAN: f64 = 1.4826;
/// Noise below this share of a reading's step cannot be told from the steps of what moves.
const STEP_SHARE: f64 = 0.6;
/// Seed of the noise that is added: any would do, and the answer must not depend on when it is asked.
const SEED: u64 = 28;

/// `signals` with its floors lifted where `readings`, which it was made of, are noisier than floors have
/// it, by what that makes of each block of `machine`.
#[must_use]
pub fn with_noise_of(
    mut signals: Signals,
    readings: &BTreeMap<Channel, Series>,
    machine: &Machine,
) -> Signals {
    let (name, ground) = (&signals.name, signals.terrain.clone());
    let noisier = noisier(readings);
    let Ok(noisier) = Signals::of_series(name, &noisier, signals.duration_s(), ground) else {
        return signals; // Not without those that `signals` itself was made of.
    };
    let mut floors = Floors::default();
    for generator in Generator::all() {
        let of = |s: &Signals| generator.residuals(s, machine, &Effects::default());
        for (one, other) in of(&signals).iter().zip(of(&noisier)) {
            let share = apart(one, &other);
            if share > ORDINARY {
                let times = (1.0 + share * share - ORDINARY * ORDINARY).sqrt();
                floors.lift(generator.key(), one.signal, times);
            }
        }
    }
    signals.floors = floors;
    signals
}

/// The same readings with as much noise once more.
fn noisier(all: &BTreeMap<Channel, Series>) -> BTreeMap<Channel, Series> {
    let mut random = ChaCha8Rng::seed_from_u64(SEED);
    let mut all = all.clone();
    for channel in readings() {
        let Some(series) = all.get_mut(&channel) else { continue };
        if channel == Channel::Heading {
            *series = unwound(series); // A full turn is no noise.
        }
        // A flat density of this width has that standard deviation.
        let half = 3.0_f64.sqrt() * white_noise(series);
        if half > 0.0 {
            let add = |(at_s, value)| (at_s, value + random.random_range(-half..half));
            *series = series.iter().map(add).collect();
        }
    }
    all
}

/// Standard deviation of what parts two residuals of one signal, by its median: where noise decides
/// whether an instant is judged at all, a few samples part by more than noise does.
fn apart(one: &Residual, other: &Residual) -> f64 {
    let both = one.values.iter().zip(&other.values).map(|(a, b)| (a - b).abs());
    let mut apart: Vec<f64> = both.filter(|apart| apart.is_finite()).collect();
    apart.sort_by(f64::total_cmp);
    apart.get(apart.len() / 2).map_or(0.0, |median| NORMAL_PER_MEDIAN * median)
}

/// What sensors say; commands and currents are exact.
fn readings() -> Vec<Channel> {
    let wheels: [fn(Wheel) -> Channel; 5] = [
        Channel::Stroke,
        Channel::WheelSpeed,
        Channel::CylinderLoad,
        Channel::BorePressure,
        Channel::RodPressure,
    ];
    let mut all: Vec<Channel> = wheels.iter().flat_map(|make| PerWheel::from_fn(*make).0).collect();
    all.extend(PumpSide::ALL.map(Channel::PumpPressure));
    all.extend([Channel::FrontJoint, Channel::RearJoint, Channel::Roll, Channel::Pitch]);
    all.extend([Channel::East, Channel::North, Channel::Heading]);
    all
}

/// Standard deviation of a reading's white noise, in its own unit; 0 where it stands still as a rule.
///
/// Of three readings in a row, the middle one less the mean of the others has no value in it and no slope,
/// only noise (Rice, Bandwidth Choice for Nonparametric Regression, 1984, and its kin).
#[allow(clippy::cast_precision_loss, clippy::cast_possible_truncation, clippy::cast_sign_loss)]
fn white_noise(series: &Series) -> f64 {
    let values: Vec<f64> = series.iter().map(|(_, value)| value).collect();
    let bends: Vec<f64> = values.windows(3).map(|v| v[0] - 2.0 * v[1] + v[2]).collect();
    let square =
        |stretch: &[f64]| stretch.iter().map(|b| b * b).sum::<f64>() / (6.0 * stretch.len() as f64);
    let mut squares: Vec<f64> = bends.chunks_exact(STRETCH).map(square).collect();
    squares.sort_by(f64::total_cmp);
    let at = (squares.len() as f64 * CALM_SHARE) as usize;
    let sigma = squares.get(at).map_or(0.0, |square| square.sqrt());
    let steps = values.windows(2).map(|v| (v[1] - v[0]).abs()).filter(|step| *step > 0.0);
    let step = steps.fold(f64::INFINITY, f64::min);
    if sigma > STEP_SHARE * step { sigma } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use rand::{Rng, SeedableRng};

    use super::*;

    /// A reading that swings by 0.1 within 13 s, with white noise, cut to steps.
    fn reading(sigma: f64, step: f64, seed: u64) -> Series {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let mut noise = || (0..12).map(|_| random.random_range(-0.5..0.5)).sum::<f64>();
        let value = |at_s: f64, noise: f64| 0.05 * (0.5 * at_s).sin() + sigma * noise;
        (0..3000_u32)
            .map(|i| f64::from(i) * 0.01)
            .map(|at_s| (at_s, (value(at_s, noise()) / step).floor() * step))
            .collect()
    }

    proptest! {
        #[test]
        fn noise_is_found_under_what_moves(sigma in 1e-3..1e-1_f64, seed in any::<u64>()) {
            let found = white_noise(&reading(sigma, 1e-5, seed));
            prop_assert!((0.7..1.2).contains(&(found / sigma)), "{found} of {sigma}");
        }

        #[test]
        fn what_moves_in_steps_has_no_noise(step in 1e-4..1e-2_f64) {
            prop_assert_eq!(white_noise(&reading(0.0, step, 1)), 0.0);
        }
    }

    #[test]
    fn what_stands_still_or_is_short_has_no_noise() {
        let still =
            |count: u32| (0..count).map(|i| (f64::from(i) * 0.01, 0.17)).collect::<Series>();
        assert_eq!([white_noise(&still(3000)), white_noise(&still(2))], [0.0; 2]);
    }
}
