//! When a cause set in, as people are told: how far into every run, or into the one in which it came for good.

use core::fmt;

use serde::Serialize;

use super::onset::Onset;
use super::signals::Signals;

/// What is told of a cause that comes in every run, and of one that comes once before it is known in which.
const EVERY_RUN: &str = "every run";
const THE_DAY: &str = "the day's recording";
/// Less than this into a run is its start, s.
const AT_START_S: f64 = 0.05;

/// An effect that set in while one was looking.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Beginning {
    /// Which run it begins in: "every run", or the name of the one in which it came for good.
    pub run: String,
    /// Instant in it, s.
    pub at_s: f64,
    /// The same as it is reckoned with; no part of the JSON.
    #[serde(skip)]
    pub onset: Onset,
}

impl Beginning {
    /// Of an effect of that onset, where that is not before all runs. In which run one comes that comes once is yet to
    /// be said.
    #[must_use]
    pub fn of(onset: Onset) -> Option<Self> {
        let run = if onset.is_once() { THE_DAY } else { EVERY_RUN };
        onset.is_late().then(|| Self { run: run.to_owned(), at_s: onset.at_s(), onset })
    }

    /// The same by the run of `runs` in which it comes, where it comes once.
    pub(super) fn told_by<'s>(&mut self, runs: impl IntoIterator<Item = &'s Signals>) {
        let begun = |run: &&Signals| run.began_s <= self.onset.at_s();
        let last = runs.into_iter().filter(begun).max_by(|a, b| a.began_s.total_cmp(&b.began_s));
        if let (true, Some(run)) = (self.onset.is_once(), last) {
            self.run.clone_from(&run.name);
            self.at_s = self.onset.at_s() - run.began_s;
        }
    }
}

/// As in "begins 8.0 s into every run".
impl fmt::Display for Beginning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { run, at_s, onset } = self;
        let for_good = if onset.is_once() { ", for good" } else { "" };
        if *at_s < AT_START_S {
            write!(f, "with {run}{for_good}")
        } else {
            write!(f, "{at_s:.1} s into {run}{for_good}")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_said_where_it_came_and_whether_it_stays() {
        let told =
            |onset, run: &str, at_s| Beginning { run: run.to_owned(), at_s, onset }.to_string();
        assert_eq!(Beginning::of(Onset::ALWAYS), None);
        let each = Beginning::of(Onset::in_every_run(8.04)).unwrap();
        assert_eq!(each.to_string(), "8.0 s into every run");
        let once = Onset::once(70.0);
        assert_eq!(told(once, "run-3-s_turn.log", 10.0), "10.0 s into run-3-s_turn.log, for good");
        assert_eq!(told(once, "run-3-s_turn.log", 0.0), "with run-3-s_turn.log, for good");
    }
}
