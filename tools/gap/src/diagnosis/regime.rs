//! What an arm is doing at each residual sample, so that a gap can be shown by regime.

use core::fmt;

use xt28_machine::{Machine, Wheel};

use super::signals::Signals;

/// Samples of a log that make one sample of a residual.
const STRIDE: usize = 10;
/// Opening above which a valve counts as open: one milliampere over its starting current.
const OPEN: f64 = 2.0e-3;
/// Distance from a stroke's end that counts as near, m (assumed).
const NEAR_END_M: f64 = 0.02;

/// Which way an arm's valve is open.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[allow(missing_docs)]
pub enum Direction {
    Closed,
    Extending,
    Retracting,
}

/// What an arm is doing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Regime {
    /// Of its valve.
    pub direction: Direction,
    /// Whether the wheel hangs on the arm instead of carrying.
    pub hangs: bool,
    /// Whether the cylinder is near one of its ends.
    pub near_end: bool,
    /// Whether another arm or a joint takes oil at the same time.
    pub shares_pump: bool,
}

impl Regime {
    /// Regimes of the arm of `wheel`, one for each residual sample of the run.
    #[must_use]
    pub fn of_run(signals: &Signals, machine: &Machine, wheel: Wheel) -> Vec<Self> {
        (0..signals.len / STRIDE)
            .map(|k| Self::at(signals, machine, wheel, k * STRIDE + STRIDE / 2))
            .collect()
    }

    fn at(signals: &Signals, machine: &Machine, wheel: Wheel, i: usize) -> Self {
        let is_open = |opening: f64| opening.abs() > OPEN;
        let opening = signals.opening[wheel][i];
        let stroke_m = signals.stroke_m[wheel][i];
        let arms = Wheel::ALL.iter().any(|&w| w != wheel && is_open(signals.opening[w][i]));
        let joints = signals.steer_opening.iter().any(|joint| is_open(joint[i]));
        Self {
            direction: match opening {
                o if !is_open(o) => Direction::Closed,
                o if o > 0.0 => Direction::Extending,
                _ => Direction::Retracting,
            },
            hangs: signals.cylinder_load_n[wheel][i] < 0.0,
            near_end: !(NEAR_END_M..machine.arms.stroke_max_m - NEAR_END_M).contains(&stroke_m),
            shares_pump: arms || joints,
        }
    }
}

impl fmt::Display for Regime {
    /// As a report says it.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self.direction {
            Direction::Closed => "valve closed",
            Direction::Extending => "extending",
            Direction::Retracting => "retracting",
        })?;
        f.write_str(if self.hangs { ", wheel hanging" } else { ", under load" })?;
        if self.near_end {
            f.write_str(", near its end")?;
        }
        if self.shares_pump {
            f.write_str(", others moving")?;
        }
        Ok(())
    }
}
