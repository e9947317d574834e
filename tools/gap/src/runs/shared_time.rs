//! Whether two logs hold one stretch of time: parts of a recording that were cut so that they overlap are two files
//! and one run, and what is held out in one is fitted in the other.

use crate::{Channel, FieldLog, Series};

/// Readings in a row by which a stretch is found again; sensors' noise alone makes each its own.
const ROW: usize = 50;
/// How many of those must differ from the one before: a machine that stands reads the same on any day.
const CHANGES: usize = 20;
/// Rows of a log that are looked for, at most, at least so many readings apart.
const ROWS: usize = 256;
const ROWS_APART: usize = 25;
/// Stretches that agree on their shift by less are one, s: two loggers do not stamp alike.
const ALIKE_S: f64 = 0.02;
/// Rows that have to agree on it.
const ROWS_MIN: usize = 3;
/// Share of the readings that change within what two logs would share which has to be in both: of two runs that
/// only begin alike, as a simulator without noise makes them, the rest is not.
const SHARE: f64 = 0.9;
/// Changed readings on which that stands.
const READINGS_MIN: usize = 200;
/// Readings are compared so much after they came, s: both have come then.
const AFTER_S: f64 = 0.002;

/// A stretch of time that is in two logs, s of each.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct SharedTime {
    /// From when to when in the one.
    pub(super) first_s: [f64; 2],
    /// From when to when in the other.
    pub(super) again_s: [f64; 2],
}

/// What both logs hold of one time, by their readings alone: stamps may have been set anew.
pub(super) fn shared_time(first: &FieldLog, again: &FieldLog) -> Option<SharedTime> {
    let busiest = readings(again).max_by_key(|(_, series)| changes(series).count())?;
    let later_s = later_s(first.series(busiest.0)?, busiest.1)?;
    let from_s = (-later_s).max(0.0);
    let to_s = again.duration_s().min(first.duration_s() - later_s);
    let (mut changed, mut alike) = (0_usize, 0_usize);
    for (channel, series) in readings(again) {
        let Some(other) = first.series(channel) else { continue };
        for (at_s, value) in changes(series).filter(|(at_s, _)| (from_s..to_s).contains(at_s)) {
            changed += 1;
            alike += usize::from(other.at(at_s + later_s + AFTER_S) == Some(value));
        }
    }
    #[allow(clippy::cast_precision_loss)]
    let is_one = changed >= READINGS_MIN && alike as f64 >= SHARE * changed as f64;
    is_one.then_some(SharedTime {
        first_s: [from_s + later_s, to_s + later_s],
        again_s: [from_s, to_s],
    })
}

/// What a log read of its machine; what it was told is the same in every run of a script.
fn readings(log: &FieldLog) -> impl Iterator<Item = (Channel, &Series)> {
    log.all_series().iter().map(|(channel, all)| (*channel, all)).filter(|(c, _)| !c.is_command())
}

/// Samples that differ from the one before.
fn changes(series: &Series) -> impl Iterator<Item = (f64, f64)> {
    series.iter().zip(series.iter().skip(1)).filter(|(a, b)| a.1 != b.1).map(|(_, b)| b)
}

/// How much later than in `again` its rows stand in `first`, s; nothing where too few agree.
fn later_s(first: &Series, again: &Series) -> Option<f64> {
    let [(first_s, first), (again_s, again)]: [(Vec<f64>, Vec<f64>); 2] =
        [first, again].map(|series| series.iter().unzip());
    let apart = (again.len() / ROWS).max(ROWS_APART);
    let rows = again.windows(ROW).enumerate().step_by(apart);
    let telling =
        rows.filter(|(_, row)| row.windows(2).filter(|pair| pair[0] != pair[1]).count() >= CHANGES);
    let found = telling.filter_map(|(k, row)| {
        let there = first.windows(ROW).position(|other| other == row)?;
        Some(first_s[there] - again_s[k])
    });
    let mut shifts_s: Vec<f64> = found.collect();
    shifts_s.sort_by(f64::total_cmp);
    let agreed = |k: usize| shifts_s[k..].partition_point(|s| s - shifts_s[k] < ALIKE_S);
    let best = (0..shifts_s.len()).max_by_key(|k| agreed(*k))?;
    (agreed(best) >= ROWS_MIN).then(|| shifts_s[best + agreed(best) / 2])
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;

    /// A log of a machine whose readings no two instants share, from `from_s` to `to_s` of its day.
    fn log(from_s: f64, to_s: f64, noise: impl Fn(f64) -> f64) -> FieldLog {
        let instants = (0..6000).map(|k| 0.01 * f64::from(k));
        let within = instants.filter(|at_s| (from_s..=to_s).contains(at_s));
        let samples: Vec<(f64, f64)> = within.map(|at_s| (at_s - from_s, noise(at_s))).collect();
        let all = [Channel::Roll, Channel::Pitch].map(|c| (c, samples.iter().copied().collect()));
        FieldLog::of_series("a", BTreeMap::from(all), to_s - from_s)
    }

    /// What no instant of a day says twice.
    fn noisy(day: f64) -> impl Fn(f64) -> f64 {
        move |at_s| ((at_s + 100.0 * day) * 1234.567).sin()
    }

    #[test]
    fn parts_of_one_recording_are_known_by_what_they_read() {
        let shared = shared_time(&log(0.0, 20.0, noisy(0.0)), &log(12.0, 30.0, noisy(0.0)));
        let SharedTime { first_s, again_s } = shared.expect("8 s are in both");
        let near = |a: [f64; 2], b: [f64; 2]| (0..2).all(|k| (a[k] - b[k]).abs() < 0.02);
        assert!(
            near(first_s, [12.0, 20.0]) && near(again_s, [0.0, 8.0]),
            "{first_s:?} {again_s:?}"
        );
        let [whole, part] = [log(0.0, 30.0, noisy(0.0)), log(9.0, 15.0, noisy(0.0))];
        assert!(shared_time(&whole, &part).is_some() && shared_time(&part, &whole).is_some());
    }

    #[test]
    fn parts_that_only_meet_and_other_days_are_not() {
        let first = log(0.0, 20.0, noisy(0.0));
        assert_eq!(shared_time(&first, &log(20.0, 40.0, noisy(0.0))), None);
        assert_eq!(shared_time(&first, &log(12.0, 30.0, noisy(1.0))), None);
    }

    /// A simulator without noise does the same until it is told something else, and a machine at rest always.
    #[test]
    fn runs_that_only_begin_alike_or_stand_still_are_two() {
        let turned = |at_s: f64| noisy(0.0)(at_s) + if at_s > 8.0 { 0.1 } else { 0.0 };
        assert_eq!(shared_time(&log(0.0, 20.0, noisy(0.0)), &log(0.0, 20.0, turned)), None);
        let still = |_: f64| 0.5;
        assert_eq!(shared_time(&log(0.0, 20.0, still), &log(10.0, 30.0, still)), None);
    }
}
