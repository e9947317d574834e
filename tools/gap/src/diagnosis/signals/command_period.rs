//! How far apart commands are sent.

use super::{Signals, median};

/// Period of either command, s (the wire contract).
pub(in crate::diagnosis) const PERIOD_S: f64 = 0.01;
/// Commands that mostly come this many periods apart or more are of a gateway that has another: a bus that
/// loses a third of them leaves most where they were.
const ANOTHER: f64 = 1.5;

/// The periods of the commands to the arms and to the drive of a run, s: that of the wire contract, or what
/// most of them are apart where that is more by half.
#[must_use]
pub(in crate::diagnosis) fn command_periods_s(signals: &Signals) -> [f64; 2] {
    signals.command_times_s.each_ref().map(|times_s| period_s(times_s))
}

fn period_s(times_s: &[f64]) -> f64 {
    let apart_s = median(times_s.windows(2).map(|pair| pair[1] - pair[0])).unwrap_or(PERIOD_S);
    let whole_s = (apart_s * 1e3).round() * 1e-3;
    if whole_s > ANOTHER * PERIOD_S { whole_s } else { PERIOD_S }
}
