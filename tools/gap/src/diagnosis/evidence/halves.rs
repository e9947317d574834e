//! Whether a cause is of one size: the same in each half of what the machine did.
//!
//! A cause that stands for another is too large here and too small there, and fits in the mean: a scale that
//! stands for a bias is too large at high pressures and too small at low ones. What it leaves in one half is
//! then a share of what it explains, and in the other half another share. A right cause leaves what has
//! nothing to do with it.

use xt28_machine::Wheel;

use crate::diagnosis::floor::Signal;
use crate::diagnosis::generator::{Generator, STEP_S};
use crate::diagnosis::signals::{DT_S, Signals, median};

/// An opening below this is a shut valve.
pub(in crate::diagnosis) const SHUT: f64 = 0.01;
/// Wheels that turn slower than this do not drive the machine, rad/s.
const DRIVES_RAD_S: f64 = 0.02;
/// Faster than this they are fast, rad/s.
const FAST_RAD_S: f64 = 0.25;
/// A joint beyond this makes a bend, rad.
pub(in crate::diagnosis) const BEND_RAD: f64 = 0.05;

/// By what the samples of a signal are halved; what is named is in the half.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Half {
    /// The second half of every run.
    Late,
    /// Where what is explained lowers the signal.
    Lower,
    /// Where more is explained than in the root mean square.
    Large,
    /// Where the arm extends, the joint turns left or the machine drives forward; a shut valve and a machine
    /// at rest are in neither half.
    Way,
    /// Where the arm carries more than in the middle of the run.
    Load,
    /// Where the stroke is above the run's middle, the joint left of straight or the machine fast.
    Level,
    /// Where the front joint makes a bend.
    Bend,
}

impl Half {
    /// All there are.
    pub(super) const ALL: [Self; 7] =
        [Self::Late, Self::Lower, Self::Large, Self::Way, Self::Load, Self::Level, Self::Bend];
}

/// What a belief explains of one signal, and leaves, in both halves of its samples.
#[derive(Clone, Copy, Debug)]
pub struct Uneven {
    /// Who watches it.
    pub generator: Generator,
    /// The signal.
    pub signal: Signal,
    /// By what it is halved.
    pub half: Half,
    /// Squares of what is explained, floors, outside the half and in it.
    explained: [f64; 2],
    /// What is explained times what is left, in both.
    misfits: [f64; 2],
}

impl Uneven {
    /// Of no sample yet.
    pub(in crate::diagnosis) const fn new(
        generator: Generator,
        signal: Signal,
        half: Half,
    ) -> Self {
        Self { generator, signal, half, explained: [0.0; 2], misfits: [0.0; 2] }
    }

    /// Adds a sample that is in the half or not: what is explained, and what is left.
    pub(in crate::diagnosis) fn add(&mut self, is_in: bool, explained: f64, left: f64) {
        let half = usize::from(is_in);
        self.explained[half] += explained * explained;
        self.misfits[half] += explained * left;
    }

    /// Adds the same of other runs.
    pub(in crate::diagnosis) fn join(&mut self, other: &Self) {
        for half in 0..2 {
            self.explained[half] += other.explained[half];
            self.misfits[half] += other.misfits[half];
        }
    }

    /// Whether both are of one signal, halved by one thing.
    pub(in crate::diagnosis) fn is_like(&self, other: &Self) -> bool {
        (self.generator, self.signal, self.half) == (other.generator, other.signal, other.half)
    }

    /// Where the half is, in words.
    #[must_use]
    pub const fn place(&self) -> &'static str {
        let is_arm = matches!(self.generator, Generator::ArmStroke(_) | Generator::ArmEcu(_));
        let steers = matches!(
            self.generator,
            Generator::Joint(_) | Generator::SteerEcu(_) | Generator::Turning
        );
        match self.half {
            Half::Late => "late in a run",
            Half::Lower => "where it lowers that",
            Half::Large => "where it does much",
            Half::Way if is_arm => "where the arm extends",
            Half::Way if steers => "where the joint turns left",
            Half::Way => "where the machine drives forward",
            Half::Load => "where the arm carries much",
            Half::Level if is_arm => "where the arm is far out",
            Half::Level if steers => "where the joint is left of straight",
            Half::Level => "where the machine is fast",
            Half::Bend => "in a bend",
        }
    }

    /// What two sizes tell of what is left beyond what one tells, nats, with each believed to be as it is,
    /// give or take one.
    #[must_use]
    pub fn nats(&self) -> f64 {
        let told = |misfit: f64, explained: f64| 0.5 * misfit * misfit / (explained + 1.0);
        let [out, within] =
            core::array::from_fn(|half| told(self.misfits[half], self.explained[half]));
        let both = told(self.misfits.iter().sum(), self.explained.iter().sum());
        (out + within - both).max(0.0)
    }

    /// Half the squares of what is explained, floors.
    #[must_use]
    pub fn explained(&self) -> f64 {
        0.5 * self.explained.iter().sum::<f64>()
    }

    /// What the cause would have to be outside the half and in it, as a share of what it is believed to be.
    #[must_use]
    pub fn sizes(&self) -> [f64; 2] {
        core::array::from_fn(|half| 1.0 + self.misfits[half] / (self.explained[half] + 1.0))
    }
}

/// One run as one generator sees it.
pub(super) struct Scene<'a> {
    generator: Generator,
    signals: &'a Signals,
    /// What the arm carries, N, and its stroke, m, in the middle of the run.
    middle: [f64; 2],
}

impl<'a> Scene<'a> {
    pub(super) fn new(generator: Generator, signals: &'a Signals) -> Self {
        let middle = |wheel: Wheel| {
            [&signals.cylinder_load_n[wheel], &signals.stroke_m[wheel]]
                .map(|all| median(all.iter().copied()).unwrap_or(f64::NAN))
        };
        Self { generator, signals, middle: generator.wheel().map_or([f64::NAN; 2], middle) }
    }

    /// In which half the sample at `at_s` is, where it is in one: `explained` is what is explained there, as a
    /// multiple of its root mean square.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    pub(super) fn side(&self, half: Half, at_s: f64, explained: f64) -> Option<bool> {
        let s = self.signals;
        let i = (((at_s + 0.5 * STEP_S) / DT_S) as usize).min(s.len - 1);
        match half {
            Half::Late => Some(2 * i > s.len),
            Half::Lower => Some(explained > 0.0),
            Half::Large => Some(explained.abs() > 1.0),
            Half::Way => self.way(i),
            Half::Load => {
                let wheel = self.generator.wheel()?;
                Some(s.cylinder_load_n[wheel][i] > self.middle[0])
            }
            Half::Level => self.level(i),
            Half::Bend => Some(s.joint_rad[0][i].abs() > BEND_RAD),
        }
    }

    fn way(&self, i: usize) -> Option<bool> {
        let s = self.signals;
        let (by, least) = match self.generator {
            Generator::ArmStroke(w) | Generator::ArmEcu(w) => (s.opening[w][i], SHUT),
            Generator::Joint(j) | Generator::SteerEcu(j) => (s.steer_opening[j][i], SHUT),
            Generator::Turning => (s.steer_opening[0][i], SHUT),
            _ => (s.mean_wheel_speed_rad_s(i), DRIVES_RAD_S),
        };
        (by.abs() > least).then_some(by > 0.0)
    }

    fn level(&self, i: usize) -> Option<bool> {
        let s = self.signals;
        Some(match self.generator {
            Generator::ArmStroke(w) | Generator::ArmEcu(w) => s.stroke_m[w][i] > self.middle[1],
            Generator::Joint(j) | Generator::SteerEcu(j) => s.joint_rad[j][i] > 0.0,
            Generator::Turning => s.joint_rad[0][i] > 0.0,
            _ => s.mean_wheel_speed_rad_s(i).abs() > FAST_RAD_S,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn uneven(samples: impl Iterator<Item = (bool, f64, f64)>) -> Uneven {
        let mut uneven = Uneven::new(Generator::Stance, Signal::Weight, Half::Large);
        samples.for_each(|(is_in, explained, left)| uneven.add(is_in, explained, left));
        uneven
    }

    /// Something that is explained, and whether it is large.
    fn explained() -> impl Iterator<Item = (bool, f64)> {
        let at = |i: i32| 3.0 * (0.31 * f64::from(i)).sin();
        (0..300).map(at).map(|value| (value.abs() > 2.0, value))
    }

    #[test]
    fn a_size_that_is_another_in_one_half_is_told() {
        let left = |is_large| if is_large { 0.1 } else { -0.3 };
        let other = uneven(explained().map(|(large, value)| (large, value, left(large) * value)));
        assert!(other.nats() > 10.0, "{other:?}");
        let [small, large] = other.sizes();
        assert!((small - 0.7).abs() < 0.01 && (large - 1.1).abs() < 0.01, "{small} {large}");
    }

    #[test]
    fn a_size_that_is_wrong_everywhere_is_no_other_size() {
        let one = uneven(explained().map(|(large, value)| (large, value, 0.2 * value)));
        assert!(one.nats() < 0.1, "{one:?}");
    }

    #[test]
    fn runs_tell_together_what_none_tells_alone() {
        let half = |from: usize| {
            let own = explained().skip(from).take(150);
            uneven(own.map(|(large, value)| (large, value, if large { 0.1 } else { -0.3 } * value)))
        };
        let (mut both, second) = (half(0), half(150));
        let alone = both.nats();
        both.join(&second);
        assert!(both.is_like(&second) && both.nats() > 1.5 * alone);
    }
}
