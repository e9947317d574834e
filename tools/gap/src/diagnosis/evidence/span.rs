//! How long the runs are, in units of the test drives for which instants are spaced.

use super::Evidence;
use crate::diagnosis::signals::Signals;

/// Length of the scripted test drives at most, s.
const DRIVE_S: f64 = 33.0;

impl Evidence<'_> {
    /// By how much the longest run is longer than a test drive; one where none is. Instants at which something may
    /// set in lie as much further apart, so that they reach as far into it.
    pub(in crate::diagnosis) fn stretch(&self) -> f64 {
        let longest_s = self.runs.iter().map(Signals::duration_s).fold(0.0, f64::max);
        (longest_s / DRIVE_S).max(1.0)
    }
}
