//! When an effect sets in: at one instant of every run, or once on the day, for good.
//!
//! What a script puts into each run sets in anew in each. A machine that breaks does so once: the runs
//! before know nothing of it, and the runs after know nothing else. The day is what was recorded of it,
//! one run after the other without what lies between them, in the order of their stamps.

use super::signals::Signals;

/// What one that comes once must gain beyond one that comes in every run or was always there, nats, and as a share of
/// what that gains: there are as many more instants for it as there are runs, and a model that is not quite the machine
/// is a little better at any other time than always.
const ONCE_MIN: f64 = 12.0;
const ONCE_SHARE: f64 = 0.1;

/// What an effect must gain to be taken to set in once where it gains `other` nats otherwise, beyond that.
pub(super) fn once_least(other: f64) -> f64 {
    ONCE_MIN + ONCE_SHARE * other.max(0.0)
}

/// When an effect sets in; before that it is not there.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Onset {
    /// Not before this instant of every run, s.
    every_run_s: f64,
    /// Not before this instant of the day, s of recording.
    once_s: f64,
}

impl Onset {
    /// There from the first frame of the first run on.
    pub const ALWAYS: Self = Self { every_run_s: 0.0, once_s: 0.0 };

    /// At `at_s` s of every run anew; there from the start of each where that is 0.
    #[must_use]
    pub const fn in_every_run(at_s: f64) -> Self {
        Self { every_run_s: at_s, once_s: 0.0 }
    }

    /// Once, `at_s` s into the day's recording.
    #[must_use]
    pub const fn once(at_s: f64) -> Self {
        Self { every_run_s: 0.0, once_s: at_s }
    }

    /// Whether anything was recorded before it.
    #[must_use]
    pub fn is_late(self) -> bool {
        self.every_run_s > 0.0 || self.once_s > 0.0
    }

    /// Whether it comes once on the day, and not in every run.
    #[must_use]
    pub fn is_once(self) -> bool {
        self.once_s > 0.0
    }

    /// When a run that began `began_s` s into the day has it, s of that run: 0 from its start, never where that is
    /// beyond its end.
    #[must_use]
    pub fn in_run(self, began_s: f64) -> f64 {
        self.every_run_s.max(self.once_s - began_s)
    }

    /// Not before either.
    #[must_use]
    pub const fn later(self, other: Self) -> Self {
        Self {
            every_run_s: self.every_run_s.max(other.every_run_s),
            once_s: self.once_s.max(other.once_s),
        }
    }

    /// Another of its kind, `by_s` s later, but not before the start.
    #[must_use]
    pub fn moved(self, by_s: f64) -> Self {
        self.at((self.at_s() + by_s).max(0.0))
    }

    /// Another of its kind, at `at_s` s of every run or of the day.
    #[must_use]
    pub fn at(self, at_s: f64) -> Self {
        if self.is_once() { Self::once(at_s) } else { Self::in_every_run(at_s) }
    }

    /// Instant of every run, or of the day, s.
    #[must_use]
    pub fn at_s(self) -> f64 {
        if self.is_once() { self.once_s } else { self.every_run_s }
    }

    /// To put one before the other: what is once comes after what comes in every run.
    #[must_use]
    pub(super) fn order(&self, other: &Self) -> core::cmp::Ordering {
        let by_day = self.once_s.total_cmp(&other.once_s);
        by_day.then(self.every_run_s.total_cmp(&other.every_run_s))
    }
}

/// When the first of several effects sets in.
#[derive(Clone, Debug, Default)]
pub(super) struct FirstOnset(Vec<Onset>);

impl FirstOnset {
    /// Of none there from the start.
    pub(super) fn of(onsets: impl IntoIterator<Item = Onset>) -> Self {
        Self(onsets.into_iter().collect())
    }

    /// When a run that began `began_s` s into the day has the first of them, s of that run; 0 of none.
    pub(super) fn in_run(&self, began_s: f64) -> f64 {
        let each = self.0.iter().map(|onset| onset.in_run(began_s));
        each.reduce(f64::min).unwrap_or_default()
    }
}

/// Says of each of `runs` where on the day it began, by when each was stamped to begin, s. Where one has no stamp, or
/// two of one time, nobody knows which was first, and all are said to begin as the day does.
pub(super) fn put_in_order(runs: &mut [(&mut Signals, Option<f64>)]) {
    let mut order: Vec<(f64, usize)> =
        runs.iter().enumerate().filter_map(|(k, (_, stamp_s))| Some(((*stamp_s)?, k))).collect();
    order.sort_by(|a, b| a.0.total_cmp(&b.0));
    let ends_s = |(stamp_s, k): (f64, usize)| stamp_s + runs[k].0.duration_s();
    let is_known =
        order.len() == runs.len() && order.windows(2).all(|pair| ends_s(pair[0]) <= pair[1].0);
    let mut began_s = 0.0;
    for (_, k) in order.into_iter().filter(|_| is_known) {
        let signals = &mut *runs[k].0;
        signals.began_s = began_s;
        began_s += signals.duration_s();
    }
}

/// From when to when each of `runs` is on the day, s of recording, the first first; nothing where nobody knows, or
/// where there is one alone.
pub(super) fn on_the_day<'s>(runs: impl IntoIterator<Item = &'s Signals>) -> Vec<[f64; 2]> {
    let mut spans: Vec<[f64; 2]> =
        runs.into_iter().map(|run| [run.began_s, run.began_s + run.duration_s()]).collect();
    spans.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let is_known = spans.len() > 1 && spans.windows(2).all(|pair| pair[0][0] < pair[1][0]);
    if is_known { spans } else { Vec::new() }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;
    use crate::{Channel, Series, Terrain};

    fn run(seconds: i32) -> Signals {
        let still: Series = (0..seconds * 10).map(|k| (0.1 * f64::from(k), 0.0)).collect();
        let all: BTreeMap<Channel, Series> =
            Channel::all().into_iter().map(|channel| (channel, still.clone())).collect();
        Signals::of_series("made up", &all, f64::from(seconds), Terrain::Flat).unwrap()
    }

    #[test]
    fn what_breaks_once_is_not_there_before_and_always_after() {
        let once = Onset::once(45.0);
        assert_eq!([0.0, 30.0, 60.0].map(|began_s| once.in_run(began_s)), [45.0, 15.0, 0.0]);
        let each = Onset::in_every_run(8.0);
        assert_eq!([0.0, 30.0, 60.0].map(|began_s| each.in_run(began_s)), [8.0; 3]);
        let both = once.later(each);
        assert_eq!([0.0, 30.0, 60.0].map(|began_s| both.in_run(began_s)), [45.0, 15.0, 8.0]);
        assert!(both.is_late() && !Onset::ALWAYS.is_late());
        assert_eq!(once.moved(-1.5), Onset::once(43.5));
        assert_eq!(each.moved(-9.0), Onset::ALWAYS);
    }

    #[test]
    fn the_first_of_several_is_another_one_in_another_run() {
        let first = FirstOnset::of([Onset::once(45.0), Onset::in_every_run(8.0)]);
        assert_eq!([0.0, 60.0].map(|began_s| first.in_run(began_s)), [8.0, 0.0]);
        assert_eq!(FirstOnset::default().in_run(3.0), 0.0);
    }

    #[test]
    fn runs_are_in_order_where_their_stamps_say_so() {
        let began = |stamps: [Option<f64>; 3]| {
            let mut runs = [30, 20, 40].map(run);
            let mut stamped: Vec<_> = runs.iter_mut().zip(stamps).collect();
            put_in_order(&mut stamped);
            (runs.each_ref().map(|run| run.began_s), on_the_day(&runs).len())
        };
        assert_eq!(began([Some(900.0), Some(100.0), Some(500.0)]), ([60.0, 0.0, 20.0], 3));
        // One without a stamp, two at one time.
        assert_eq!(began([Some(900.0), None, Some(500.0)]), ([0.0; 3], 0));
        assert_eq!(began([Some(900.0), Some(100.0), Some(110.0)]), ([0.0; 3], 0));
    }
}
