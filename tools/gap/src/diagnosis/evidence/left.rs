//! What one signal leaves, and what that costs.

use super::SCALE_SAMPLES;
use super::bumps::Bumps;
use crate::diagnosis::floor::Signal;
use crate::diagnosis::generator::Generator;

/// What one signal leaves.
#[derive(Clone, Copy, Debug)]
pub struct Left {
    /// Who watches it.
    pub generator: Generator,
    /// The signal.
    pub signal: Signal,
    /// Mean square in units of the floor; about one where nothing but the floor is left.
    pub square: f64,
    /// The same without the samples that leave most, one in twenty-five: one bump is no law. Told by
    /// [`super::Evidence::left`] and [`super::Evidence::unbent`]; elsewhere it is `square`.
    pub steady: f64,
    /// The third largest of its bumps at its peak, floors: what comes again and again is a law after
    /// all. Told as `steady` is, zero elsewhere.
    pub recurring: f64,
    /// Independent samples.
    pub samples: f64,
}

impl Left {
    /// A signal that leaves `square` all along, without bumps.
    pub(in crate::diagnosis) const fn evenly(
        generator: Generator,
        signal: Signal,
        square: f64,
        samples: f64,
    ) -> Self {
        Self { generator, signal, square, steady: square, recurring: 0.0, samples }
    }

    /// What the signal costs, nats.
    pub(in crate::diagnosis) fn cost(&self) -> f64 {
        0.5 * cost_of_squares(self.square * self.samples, self.samples)
    }
}

/// What each signal leaves, with its bumps.
pub(super) fn with_bumps(mut all: Vec<Left>, bumps: impl Iterator<Item = Bumps>) -> Vec<Left> {
    for (left, Bumps { steady, recurring }) in all.iter_mut().zip(bumps) {
        (left.steady, left.recurring) = (steady, recurring);
    }
    all
}

/// What it costs that a signal of `samples` independent samples leaves `square`, its scale at its best.
pub(super) fn cost_of_squares(square: f64, samples: f64) -> f64 {
    let above = SCALE_SAMPLES + square.max(samples);
    let believed = SCALE_SAMPLES + samples;
    square.min(samples) + believed * (above / believed).ln()
}
