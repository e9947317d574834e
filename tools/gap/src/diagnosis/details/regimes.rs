//! The gap by what the machine was doing.

use xt28_machine::{Machine, Wheel};

use super::{Pair, STEP_S, rms, wheel_of};
use crate::diagnosis::excitation::UNLOADED_N;
use crate::diagnosis::inquiry::Inquiry;
use crate::diagnosis::signals::{DT_S, Signals};

/// Regimes of the arm that a row is about, the first of all; other rows have none there.
pub const OF_ARM: usize = 5;
/// What a machine may be doing, in the order of a row's cells.
pub const REGIMES: [&str; 10] = [
    "valve shut",
    "extends",
    "retracts",
    "near an end",
    "hangs free",
    "several arms",
    "stands",
    "changes speed",
    "straight on",
    "in a bend",
];

/// An opening below this is a shut valve.
const SHUT: f64 = 0.01;
/// Closer than this to an end of its stroke an arm may meet it, m.
const NEAR_END_M: f64 = 0.02;
/// Slower than this the machine stands, m/s.
const STANDS_M_S: f64 = 0.05;
/// A change of speed above this is not a steady drive, m/s2.
const STEADY_M_S2: f64 = 0.1;
/// A joint beyond this makes a bend, rad.
const BEND_RAD: f64 = 0.05;

/// One generator's gaps.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// The generator.
    pub name: String,
    /// Its gap in each of [`REGIMES`], floors; `None` where that did not happen or does not apply.
    pub cells: [Option<f64>; REGIMES.len()],
    /// Its gap over everything.
    pub all: Option<f64>,
}

/// A row for each generator, over all runs.
pub(super) fn map(inquiry: &Inquiry, pairs: &[Pair]) -> Vec<Row> {
    let mut rows: Vec<Row> = Vec::new();
    for first in pairs.iter().filter(|pair| pair.run == 0) {
        let same = || pairs.iter().filter(|pair| pair.generator == first.generator);
        let wheel = wheel_of(first.generator);
        let gap = |regime: Option<usize>| {
            rms(same().flat_map(|pair| {
                let signals = &inquiry.runs[pair.run].signals;
                let machine = &inquiry.machine;
                pair.before.iter().flat_map(move |residual| {
                    residual.values.iter().enumerate().filter_map(move |(k, value)| {
                        let within = regime
                            .is_none_or(|regime| is(signals, machine, wheel, instant(k), regime));
                        within.then_some(*value)
                    })
                })
            }))
        };
        rows.push(Row {
            name: first.generator.to_string(),
            cells: core::array::from_fn(|regime| gap(Some(regime))),
            all: gap(None),
        });
    }
    rows
}

/// Sample of the log in the middle of sample `k` of a residual.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
fn instant(k: usize) -> usize {
    const STRIDE: usize = (STEP_S / DT_S + 0.5) as usize;
    k * STRIDE + STRIDE / 2
}

/// Whether the machine is in a regime at sample `i` of a log.
fn is(s: &Signals, machine: &Machine, wheel: Option<Wheel>, i: usize, regime: usize) -> bool {
    if i >= s.len {
        return false;
    }
    let arm = |of: &dyn Fn(Wheel) -> bool| wheel.is_some_and(of);
    let radius_m = machine.wheels.radius_m;
    let speed_m_s = s.mean_wheel_speed_rad_s(i) * radius_m;
    let (from, to) = (i.saturating_sub(20), (i + 20).min(s.len - 1));
    let change_m_s2 = (s.mean_wheel_speed_rad_s(to) - s.mean_wheel_speed_rad_s(from)) * radius_m
        / ((to - from).max(1) as f64 * DT_S);
    let (stands, steady) = (speed_m_s.abs() < STANDS_M_S, change_m_s2.abs() < STEADY_M_S2);
    let bent = s.joint_rad.iter().any(|joint| joint[i].abs() > BEND_RAD);
    let ends = NEAR_END_M..machine.arms.stroke_max_m - NEAR_END_M;
    match regime {
        0 => arm(&|w| s.opening[w][i].abs() < SHUT),
        1 => arm(&|w| s.opening[w][i] >= SHUT),
        2 => arm(&|w| s.opening[w][i] <= -SHUT),
        3 => arm(&|w| !ends.contains(&s.stroke_m[w][i])),
        4 => arm(&|w| s.cylinder_load_n[w][i] < UNLOADED_N),
        5 => s.opening.iter().filter(|(_, opening)| opening[i].abs() >= SHUT).count() > 1,
        6 => stands && steady,
        7 => !steady,
        8 => !stands && steady && !bent,
        _ => !stands && steady && bent,
    }
}
