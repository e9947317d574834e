//! Whether commands and readings of the arms are of the same wheels: a mapping that swaps two wheels
//! makes every arm look broken.

use core::fmt;

use xt28_machine::{Machine, PerWheel, Wheel};
use xt28_sim::effects::Lag;

use super::COMPARED_EVERY;
use super::load_scale::pressed_n;
use crate::diagnosis::signals::{DT_S, MANUAL_POSITION, Samples, Signals};

/// How fast an arm follows its target, s: 1 / (0.004 per mm times 212 mm/s), the paper's PI.
const FOLLOWS_S: f64 = 1.18;
/// A correlation above this says that one moves the other, ...
const MOVES: f64 = 0.9;
/// ... and below this that it does not. In between nothing is said: faults lie there.
const MOVES_NOT: f64 = 0.6;
/// Targets of two arms that never differ by more are alike, m.
const ALIKE_M: f64 = 0.01;
/// Pressures that miss their own load by less, N, are their own: loads come at another rate, and those of
/// two arms may be alike ...
const PRESSED_N: f64 = 2.0e3;
/// ... and so are those that miss another's by more than this share of that.
const PRESSED_SHARE: f64 = 0.25;

/// Wheels that look swapped.
#[derive(Clone, Debug, PartialEq)]
pub struct Swap {
    /// What is commanded, and what is read.
    pub between: [&'static str; 2],
    /// The wheel of a command, and the wheel whose reading follows it.
    pub pairs: Vec<(Wheel, Wheel)>,
}

/// Wheels whose readings follow the commands of another and not their own, or whose pressures make the
/// load that another's frame tells; `None` where every reading follows its own command, or where the
/// commands do not tell.
#[must_use]
pub fn swapped_wheels(runs: &[Signals], machine: &Machine) -> Option<Swap> {
    let targets = |s: &Signals, w: Wheel| followed(s, w);
    let strokes = |s: &Signals, w: Wheel| s.stroke_m[w].clone();
    let openings = |s: &Signals, w: Wheel| s.opening[w].clone();
    let rates = |s: &Signals, w: Wheel| s.stroke_rate_m_s[w].clone();
    compare(runs, ["target", "stroke"], &targets, &strokes)
        .or_else(|| compare(runs, ["valve current", "stroke"], &openings, &rates))
        .or_else(|| mispressed(runs, machine))
}

/// What a stroke should be on its way to its target, m.
pub(super) fn followed(s: &Signals, wheel: Wheel) -> Samples {
    let targets = &s.target_stroke_m[wheel];
    let mut followed = Lag::new(targets.first().copied().unwrap_or_default());
    targets.iter().map(|target| followed.step(*target, FOLLOWS_S, DT_S)).collect()
}

/// Whether targets count at sample `i`.
#[allow(clippy::float_cmp)] // A mode is a whole number.
pub(super) fn is_told(s: &Signals, i: usize) -> bool {
    s.arm_mode[i] == MANUAL_POSITION
}

/// Axles whose two arms are never commanded otherwise than each other: no log of these shows there
/// whether left and right are in their places.
#[must_use]
pub(in crate::diagnosis) fn axles_alike<'a>(
    runs: impl Iterator<Item = &'a Signals> + Clone,
) -> Vec<&'static str> {
    let apart = |s: &Signals, [right, left]: [Wheel; 2]| {
        let manual = |i: &usize| s.arm_mode[*i] == MANUAL_POSITION;
        let targets = [&s.target_stroke_m[right], &s.target_stroke_m[left]];
        (0..s.len).filter(manual).any(|i| (targets[0][i] - targets[1][i]).abs() > ALIKE_M)
    };
    let axles = [
        ("front", [Wheel::Fr, Wheel::Fl]),
        ("middle", [Wheel::Mr, Wheel::Ml]),
        ("rear", [Wheel::Br, Wheel::Bl]),
    ];
    let alike = axles.into_iter().filter(|(_, wheels)| !runs.clone().any(|s| apart(s, *wheels)));
    alike.map(|(name, _)| name).collect()
}

/// Wheels whose pressures make the load that the frame of another tells, and not their own. The ECU makes
/// one of the other, so that they agree on every machine, sound or not.
fn mispressed(runs: &[Signals], machine: &Machine) -> Option<Swap> {
    let apart_n =
        PerWheel::from_fn(|w| PerWheel::from_fn(|v| pressures_off_n(runs, machine, [w, v])));
    let meant = |w: Wheel| {
        let own_n = apart_n[w][w];
        let others = Wheel::ALL.into_iter().filter(|v| *v != w);
        let nearest = others.min_by(|a, b| apart_n[w][*a].total_cmp(&apart_n[w][*b]))?;
        let is_others = own_n > PRESSED_N && apart_n[w][nearest] < PRESSED_SHARE * own_n;
        is_others.then_some((w, nearest))
    };
    let pairs = closed(Wheel::ALL.into_iter().filter_map(meant).collect());
    (!pairs.is_empty()).then_some(Swap { between: ["pressures", "load"], pairs })
}

/// Root mean square of what the pressures of `wheel` make less the load that the frame tells of `other`, N;
/// zero where no log has pressures.
#[allow(clippy::cast_precision_loss)]
fn pressures_off_n(runs: &[Signals], machine: &Machine, [wheel, other]: [Wheel; 2]) -> f64 {
    let (mut squares, mut count) = (0.0, 0_usize);
    for s in runs {
        let pressures =
            pressed_n(s, machine, wheel).zip(&s.cylinder_load_n[other]).step_by(COMPARED_EVERY);
        for (made_n, load_n) in pressures {
            (squares, count) = (squares + (made_n - load_n).powi(2), count + 1);
        }
    }
    (squares / count.max(1) as f64).sqrt()
}

type Of<'a> = &'a dyn Fn(&Signals, Wheel) -> Samples;

/// Over all runs, then run by run: in most scripts the arms of an axle go together, and a run in which they
/// do hides one in which they do not.
fn compare(runs: &[Signals], between: [&'static str; 2], cause: Of, effect: Of) -> Option<Swap> {
    let each = runs.iter().map(std::slice::from_ref);
    let mut sets = std::iter::once(runs).chain(each);
    sets.find_map(|runs| compared(runs, between, cause, effect))
}

fn compared(runs: &[Signals], between: [&'static str; 2], cause: Of, effect: Of) -> Option<Swap> {
    let (causes, effects) = (gather(runs, cause), gather(runs, effect));
    let r = PerWheel::from_fn(|w| PerWheel::from_fn(|v| correlation(&causes[w], &effects[v])));
    let follower = |w: Wheel| {
        let other =
            |v: &Wheel| *v != w && r[w][w] < MOVES_NOT && r[*v][*v] < MOVES_NOT && r[w][*v] > MOVES;
        Wheel::ALL.into_iter().filter(other).max_by(|a, b| r[w][*a].total_cmp(&r[w][*b]))
    };
    let pairs = closed(Wheel::ALL.into_iter().filter_map(|w| Some((w, follower(w)?))).collect());
    (!pairs.is_empty()).then_some(Swap { between, pairs })
}

/// Those of `pairs` that make another order: one in which every wheel is somebody's.
fn closed(mut pairs: Vec<(Wheel, Wheel)>) -> Vec<(Wheel, Wheel)> {
    loop {
        let before = pairs.clone();
        let closed = |(w, v): &(Wheel, Wheel)| {
            before.iter().any(|(_, to)| to == w) && before.iter().any(|(from, _)| from == v)
        };
        pairs.retain(closed);
        if pairs.len() == before.len() {
            return pairs;
        }
    }
}

/// Samples in manual position, a few a second, each less the mean of the six wheels: what all arms do
/// alike tells none from another. Then less the mean of its run.
#[allow(clippy::cast_precision_loss)]
fn gather(runs: &[Signals], of: Of) -> PerWheel<Samples> {
    let mut all = PerWheel::from_fn(|_| Samples::new());
    for s in runs {
        let wheels = PerWheel::from_fn(|w| of(s, w));
        let used: Vec<usize> =
            (0..s.len).step_by(COMPARED_EVERY).filter(|i| is_told(s, *i)).collect();
        let apart = |w: Wheel, i: usize| {
            wheels[w][i] - wheels.iter().map(|(_, samples)| samples[i]).sum::<f64>() / 6.0
        };
        for w in Wheel::ALL {
            let mean = used.iter().map(|i| apart(w, *i)).sum::<f64>() / used.len().max(1) as f64;
            all[w].extend(used.iter().map(|i| apart(w, *i) - mean));
        }
    }
    all
}

/// Pearson's coefficient of centred samples; zero where one of them does not move.
fn correlation(a: &Samples, b: &Samples) -> f64 {
    let dot = |a: &Samples, b: &Samples| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let scale = (dot(a, a) * dot(b, b)).sqrt();
    if scale > 0.0 { dot(a, b) / scale } else { 0.0 }
}

impl fmt::Display for Swap {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [command, reading] = self.between;
        for (i, (commanded, follows)) in self.pairs.iter().enumerate() {
            let comma = if i > 0 { ", " } else { "" };
            write!(f, "{comma}the {reading} of {follows} follows the {command} of {commanded}")?;
        }
        Ok(())
    }
}
