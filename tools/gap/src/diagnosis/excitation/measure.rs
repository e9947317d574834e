//! What a set of runs made the machine do, block by block.

use std::collections::BTreeMap;

use xt28_machine::{Machine, PerWheel, Wheel};
use xt28_sim::Effects;
use xt28_sim::effects::Scope;

use super::super::floor::Signal;
use super::super::generator::{Generator, Residual, SAMPLES_PER_RESIDUAL, STEP_S};
use super::super::signals::{DT_S, Samples, Signals};

/// An opening below this is a closed valve: the ECU's currents have no smaller step that flows.
const CLOSED: f64 = 0.01;
/// A cylinder that carries less has its wheel in the air, N.
pub(in crate::diagnosis) const UNLOADED_N: f64 = 5.0e3;
/// Throttle below this is let go.
const LET_GO: f64 = 0.02;
/// A demand that changes within this many samples steps: half a second, in which nobody tells its delay from
/// its ramp (assumed).
const STEP_SAMPLES: usize = 50;
/// Wheels slower than this stand, rad/s.
const STANDS_RAD_S: f64 = 0.05;

/// What one arm did, the most over all runs, and for how long in all it could be judged.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct ArmUse {
    /// Range of its stroke, m.
    pub(super) moves_m: f64,
    /// The lesser of the ways that it went out and in, m.
    pub(super) turns_m: f64,
    /// Range of its stroke while throttle was let go and the wheels stood where how the machine stands is judged, m.
    pub(super) moves_standing_m: f64,
    /// Range of its load, N.
    pub(super) load_range_n: f64,
    /// Longest time with the valve shut under load, s.
    pub(super) holds_s: f64,
    /// Longest time without load and the valve shut, s.
    pub(super) unloaded_s: f64,
    /// For how long in all its stroke could be judged, s: not while a chamber is drained.
    pub(super) judged_s: f64,
    /// The same of what its controller does: in manual position alone.
    pub(super) controlled_s: f64,
}

/// What the machine did, the most over all runs.
#[derive(Clone, Debug)]
pub(super) struct Excitation {
    pub(super) arms: PerWheel<ArmUse>,
    /// Largest sum of the openings of all arms' valves.
    pub(super) openings: f64,
    /// Range of the front joint while the wheels turned, rad.
    pub(super) steers_rad: f64,
    /// Largest throttle, 0 to 1.
    pub(super) throttle: f64,
    /// Largest step of the throttle.
    pub(super) throttle_step: f64,
    /// Way rolled in one run, m.
    pub(super) rolls_m: f64,
    /// Changes of any command.
    pub(super) commands: usize,
    /// Fixes of a receiver.
    pub(super) fixes: usize,
    /// For how long in all each signal of the whole machine could be judged, s.
    pub(super) judged_s: BTreeMap<Signal, f64>,
}

impl Excitation {
    pub(super) fn of<'a>(
        runs: impl Iterator<Item = &'a Signals> + Clone,
        machine: &Machine,
    ) -> Self {
        let most = |of: &dyn Fn(&Signals) -> f64| runs.clone().map(of).fold(0.0, f64::max);
        let whole: Vec<Vec<Residual>> = runs.clone().map(|s| of_whole(s, machine)).collect();
        Self {
            arms: PerWheel::from_fn(|wheel| arm(runs.clone().zip(&whole), machine, wheel)),
            openings: most(&openings),
            steers_rad: most(&|s| {
                let turning = |&i: &usize| s.mean_wheel_speed_rad_s(i).abs() > STANDS_RAD_S;
                range((0..s.len).filter(turning).map(|i| s.joint_rad[0][i]))
            }),
            throttle: most(&|s| s.throttle.iter().fold(0.0, |most, t| t.abs().max(most))),
            throttle_step: most(&|s| {
                let changes = [1, STEP_SAMPLES].map(|apart| change(&s.throttle, apart));
                changes[0].max(changes[1])
            }),
            rolls_m: most(&|s| {
                let speeds = (0..s.len).map(|i| s.mean_wheel_speed_rad_s(i).abs());
                let turned_rad = speeds.filter(|speed| *speed > STANDS_RAD_S).sum::<f64>() * DT_S;
                turned_rad * machine.wheels.radius_m
            }),
            commands: runs.clone().map(commands).sum(),
            fixes: runs.clone().map(|s| s.fixes.len()).sum(),
            judged_s: judged_s(&whole),
        }
    }

    /// What was done in these runs and in those of `other`.
    pub(super) fn with(&self, other: &Self) -> Self {
        let mut judged_s = self.judged_s.clone();
        for (signal, more_s) in &other.judged_s {
            *judged_s.entry(*signal).or_insert(0.0) += more_s;
        }
        Self {
            arms: PerWheel::from_fn(|w| self.arms[w].with(other.arms[w])),
            openings: self.openings.max(other.openings),
            steers_rad: self.steers_rad.max(other.steers_rad),
            throttle: self.throttle.max(other.throttle),
            throttle_step: self.throttle_step.max(other.throttle_step),
            rolls_m: self.rolls_m.max(other.rolls_m),
            commands: self.commands + other.commands,
            fixes: self.fixes + other.fixes,
            judged_s,
        }
    }

    /// The same as far as arms at `scope` are concerned: the others did whatever one asks.
    pub(super) fn at(&self, scope: Scope) -> Self {
        let arms =
            PerWheel::from_fn(|w| if scope.contains(w) { self.arms[w] } else { ArmUse::ANY });
        Self { arms, ..self.clone() }
    }
}

impl ArmUse {
    /// Everything, for as long as one likes.
    const ANY: Self = Self {
        moves_m: f64::INFINITY,
        turns_m: f64::INFINITY,
        moves_standing_m: f64::INFINITY,
        load_range_n: f64::INFINITY,
        holds_s: f64::INFINITY,
        unloaded_s: f64::INFINITY,
        judged_s: f64::INFINITY,
        controlled_s: f64::INFINITY,
    };

    /// What it did in these runs and in others.
    fn with(self, other: Self) -> Self {
        Self {
            moves_m: self.moves_m.max(other.moves_m),
            turns_m: self.turns_m.max(other.turns_m),
            moves_standing_m: self.moves_standing_m.max(other.moves_standing_m),
            load_range_n: self.load_range_n.max(other.load_range_n),
            holds_s: self.holds_s.max(other.holds_s),
            unloaded_s: self.unloaded_s.max(other.unloaded_s),
            judged_s: self.judged_s + other.judged_s,
            controlled_s: self.controlled_s + other.controlled_s,
        }
    }
}

/// What the generators say of a run that watch the whole machine.
fn of_whole(s: &Signals, machine: &Machine) -> Vec<Residual> {
    let all = [Generator::Drive, Generator::Stance, Generator::Travel];
    all.into_iter().flat_map(|of| of.residuals(s, machine, &Effects::default())).collect()
}

/// For how long a signal could be judged in a run, s.
#[allow(clippy::cast_precision_loss)]
fn told_s(residual: &Residual) -> f64 {
    residual.values.iter().filter(|value| value.is_finite()).count() as f64 * STEP_S
}

/// For how long the signals of the whole machine could be judged in all runs, s.
fn judged_s(runs: &[Vec<Residual>]) -> BTreeMap<Signal, f64> {
    let mut all = BTreeMap::new();
    for residual in runs.iter().flatten() {
        *all.entry(residual.signal).or_insert(0.0) += told_s(residual);
    }
    all
}

/// What the arm of `wheel` did in runs, each beside what is said of the whole machine.
fn arm<'a, 'b>(
    runs: impl Iterator<Item = (&'a Signals, &'b Vec<Residual>)>,
    machine: &Machine,
    wheel: Wheel,
) -> ArmUse {
    let mut all = ArmUse::default();
    for (s, whole) in runs {
        let (stroke, opening) = (&s.stroke_m[wheel], &s.opening[wheel]);
        let load = &s.cylinder_load_n[wheel];
        let (mut out_m, mut in_m) = (0.0, 0.0);
        for i in 1..s.len {
            let step = stroke[i] - stroke[i - 1];
            if opening[i].abs() > CLOSED {
                if step > 0.0 { out_m += step } else { in_m -= step }
            }
        }
        let weight = whole.iter().find(|residual| residual.signal == Signal::Weight);
        // Not on ground that is no plane.
        let is_weighed = |i: usize| {
            let at = weight.and_then(|weight| weight.values.get(i / SAMPLES_PER_RESIDUAL));
            at.is_some_and(|newtons| newtons.is_finite())
        };
        let stands = |&i: &usize| {
            s.throttle[i].abs() < LET_GO
                && s.mean_wheel_speed_rad_s(i).abs() < STANDS_RAD_S
                && is_weighed(i)
        };
        let shut = |i: usize| opening[i].abs() < CLOSED;
        let judged_s = |generator: Generator| -> f64 {
            generator.residuals(s, machine, &Effects::default()).iter().map(told_s).sum()
        };
        let one = ArmUse {
            moves_m: range(stroke.iter().copied()),
            turns_m: f64::min(out_m, in_m),
            moves_standing_m: range((0..s.len).filter(stands).map(|i| stroke[i])),
            load_range_n: range(load.iter().copied()),
            holds_s: longest_s(s.len, |i| shut(i) && load[i] > UNLOADED_N),
            unloaded_s: longest_s(s.len, |i| shut(i) && load[i] < UNLOADED_N),
            judged_s: judged_s(Generator::ArmStroke(wheel)),
            controlled_s: judged_s(Generator::ArmEcu(wheel)),
        };
        all = all.with(one);
    }
    all
}

/// The largest change over so many samples.
fn change(values: &[f64], apart: usize) -> f64 {
    let pairs = values.iter().zip(values.iter().skip(apart));
    pairs.fold(0.0, |most, (from, to)| (to - from).abs().max(most))
}

fn range(values: impl Iterator<Item = f64>) -> f64 {
    let (low, high) =
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
    (high - low).max(0.0)
}

/// Longest time in one piece for which something holds, s.
#[allow(clippy::cast_precision_loss)]
fn longest_s(len: usize, holds: impl Fn(usize) -> bool) -> f64 {
    let (mut now, mut most) = (0_usize, 0_usize);
    for i in 0..len {
        now = if holds(i) { now + 1 } else { 0 };
        most = most.max(now);
    }
    most as f64 * DT_S
}

fn openings(s: &Signals) -> f64 {
    let sum = |i: usize| s.opening.iter().map(|(_, opening)| opening[i].abs()).sum::<f64>();
    (0..s.len).map(sum).fold(0.0, f64::max)
}

fn commands(s: &Signals) -> usize {
    let changes = |samples: &Samples| samples.windows(2).filter(|pair| pair[0] != pair[1]).count();
    let arms: usize = s.target_stroke_m.iter().map(|(_, samples)| changes(samples)).sum();
    arms + changes(&s.throttle) + changes(&s.target_joint_rad)
}
