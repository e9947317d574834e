//! The gap by what the machine was doing.

use xt28_machine::{Machine, Wheel};

use super::{Pair, rms};
use crate::diagnosis::evidence::{BEND_RAD, SHUT};
use crate::diagnosis::excitation::UNLOADED_N;
use crate::diagnosis::generator::SAMPLES_PER_RESIDUAL;
use crate::diagnosis::inquiry::Inquiry;
use crate::diagnosis::signals::{DT_S, Signals};

/// Regimes of the arm that a row is about, the first of all; other rows have none there.
pub const OF_ARM: usize = 7;
/// What a machine may be doing, in the order of a row's cells.
pub const REGIMES: [&str; 12] = [
    "valve shut",
    "extends",
    "retracts",
    "near an end",
    "hangs free",
    "light load",
    "heavy load",
    "several arms",
    "stands",
    "changes speed",
    "straight on",
    "in a bend",
];

/// Closer than this to an end of its stroke an arm may meet it, m.
const NEAR_END_M: f64 = 0.02;
/// Shares of its usual load below which an arm carries little, and above which much.
const USUAL: [f64; 2] = [0.8, 1.2];
/// Slower than this the machine stands, m/s.
const STANDS_M_S: f64 = 0.05;
/// A change of speed above this is not a steady drive, m/s2.
const STEADY_M_S2: f64 = 0.1;

/// One generator's gaps, regime by regime: a row of the map.
#[derive(Clone, Debug, PartialEq)]
pub struct RegimeGaps {
    /// The generator.
    pub name: String,
    /// Its gap in each of [`REGIMES`], floors; `None` where that did not happen or does not apply.
    pub cells: [Option<f64>; REGIMES.len()],
    /// Its gap over everything.
    pub all: Option<f64>,
}

/// A row for each generator, over all runs.
pub(super) fn map(inquiry: &Inquiry, pairs: &[Pair]) -> Vec<RegimeGaps> {
    let mut rows: Vec<RegimeGaps> = Vec::new();
    for first in pairs.iter().filter(|pair| pair.run == 0) {
        let same = || pairs.iter().filter(|pair| pair.generator == first.generator);
        let wheel = first.generator.wheel();
        let usual_n = wheel.map_or(f64::NAN, |wheel| usual_load_n(inquiry, wheel));
        let gap = |regime: Option<usize>| {
            rms(same().flat_map(|pair| {
                let signals = &inquiry.runs[pair.run].signals;
                let machine = &inquiry.machine;
                pair.before.iter().flat_map(move |residual| {
                    residual.values.iter().enumerate().filter_map(move |(k, value)| {
                        let at = Moment { signals, machine, wheel, usual_n, i: instant(k) };
                        let within = regime.is_none_or(|regime| at.is(regime));
                        within.then_some(*value)
                    })
                })
            }))
        };
        rows.push(RegimeGaps {
            name: first.generator.to_string(),
            cells: core::array::from_fn(|regime| gap(Some(regime))),
            all: gap(None),
        });
    }
    rows
}

/// Sample of the log in the middle of sample `k` of a residual.
const fn instant(k: usize) -> usize {
    k * SAMPLES_PER_RESIDUAL + SAMPLES_PER_RESIDUAL / 2
}

/// The load in the middle of all that an arm carried off the air, over all runs, N; not a number where
/// it never did.
fn usual_load_n(inquiry: &Inquiry, wheel: Wheel) -> f64 {
    let loads = inquiry.runs.iter().flat_map(|run| &run.signals.cylinder_load_n[wheel]);
    let mut loads: Vec<f64> = loads.copied().filter(|load| *load >= UNLOADED_N).collect();
    loads.sort_by(f64::total_cmp);
    loads.get(loads.len() / 2).copied().unwrap_or(f64::NAN)
}

/// A moment of one log, as one generator sees it.
struct Moment<'a> {
    signals: &'a Signals,
    machine: &'a Machine,
    /// The wheel whose arm the generator drives.
    wheel: Option<Wheel>,
    /// What that arm usually carries, N.
    usual_n: f64,
    /// Sample of the log.
    i: usize,
}

impl Moment<'_> {
    /// Whether the machine is in a regime, by its place in [`REGIMES`].
    fn is(&self, regime: usize) -> bool {
        if self.i >= self.signals.len {
            return false;
        }
        if regime < OF_ARM {
            return self.wheel.is_some_and(|wheel| self.arm_is(wheel, regime));
        }
        self.machine_is(regime - OF_ARM)
    }

    /// Whether an arm is in one of its regimes.
    fn arm_is(&self, wheel: Wheel, regime: usize) -> bool {
        let opening = self.signals.opening[wheel][self.i];
        let load_n = self.signals.cylinder_load_n[wheel][self.i];
        let ends = NEAR_END_M..self.machine.arms.stroke_max_m - NEAR_END_M;
        match regime {
            0 => opening.abs() < SHUT,
            1 => opening >= SHUT,
            2 => opening <= -SHUT,
            3 => !ends.contains(&self.signals.stroke_m[wheel][self.i]),
            4 => load_n < UNLOADED_N,
            5 => load_n >= UNLOADED_N && load_n < USUAL[0] * self.usual_n,
            _ => load_n > USUAL[1] * self.usual_n,
        }
    }

    /// Whether the machine is in one of its regimes.
    fn machine_is(&self, regime: usize) -> bool {
        let (s, i) = (self.signals, self.i);
        let radius_m = self.machine.wheels.radius_m;
        let speed_m_s = s.mean_wheel_speed_rad_s(i) * radius_m;
        let (from, to) = (i.saturating_sub(20), (i + 20).min(s.len - 1));
        let change_m_s2 = (s.mean_wheel_speed_rad_s(to) - s.mean_wheel_speed_rad_s(from))
            * radius_m
            / ((to - from).max(1) as f64 * DT_S);
        let (stands, steady) = (speed_m_s.abs() < STANDS_M_S, change_m_s2.abs() < STEADY_M_S2);
        let bent = s.joint_rad.iter().any(|joint| joint[i].abs() > BEND_RAD);
        match regime {
            0 => s.opening.iter().filter(|(_, opening)| opening[i].abs() >= SHUT).count() > 1,
            1 => stands && steady,
            2 => !steady,
            3 => !stands && steady && !bent,
            _ => !stands && steady && bent,
        }
    }
}
