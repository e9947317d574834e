//! How long the runs are, in units of the test drives for which instants are spaced, and where they lie on the day.

use super::Evidence;
use crate::diagnosis::onset::{Onset, on_the_day};
use crate::diagnosis::signals::Signals;

/// Length of the scripted test drives at most, s.
const DRIVE_S: f64 = 33.0;
/// A run shorter than this share of one is looked at more closely; as if it had the second at least.
const SHORT: f64 = 0.75;
const SHORTEST: f64 = 0.2;

impl Evidence<'_> {
    /// By how much the longest run is longer than a test drive, or shorter. Instants at which something may set in lie as
    /// much further apart, so that they reach as far into it, or closer.
    pub(in crate::diagnosis) fn stretch(&self) -> f64 {
        let longest_s = self.runs.iter().map(Signals::duration_s).fold(0.0, f64::max);
        let drives = longest_s / DRIVE_S;
        if drives < SHORT { drives.max(SHORTEST) } else { drives.max(1.0) }
    }

    /// The runs that it is evidence of.
    pub(in crate::diagnosis) const fn runs(&self) -> &[Signals] {
        self.runs
    }

    /// Starts of all runs but the first on the day, s of it; none where nobody knows which run was first.
    pub(in crate::diagnosis) fn starts_on_the_day_s(&self) -> Vec<f64> {
        on_the_day(self.runs).into_iter().skip(1).map(|[from_s, _]| from_s).collect()
    }

    /// Onsets on the day, `step_s` apart in every run, at the start of each but the first among them; none where nobody
    /// knows which run was first, or where one run is all there is.
    pub(in crate::diagnosis) fn onsets_on_the_day(&self, step_s: f64) -> Vec<Onset> {
        let of = |[from_s, to_s]: [f64; 2]| {
            let steps = (0_u32..).map(move |k| from_s + f64::from(k) * step_s);
            steps.take_while(move |at_s| *at_s < to_s).filter(|at_s| *at_s > 0.0).map(Onset::once)
        };
        on_the_day(self.runs).into_iter().flat_map(of).collect()
    }

    /// End of the last run on the day, s.
    pub(in crate::diagnosis) fn last_of_the_day_s(&self) -> f64 {
        on_the_day(self.runs).last().map_or(0.0, |[_, to_s]| *to_s)
    }
}
