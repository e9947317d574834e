//! The part of a log in which everything that a diagnosis reads is there: what a message that begins late,
//! stops early or stays away held meanwhile was not measured, and says nothing of the machine.

use crate::FieldLog;
use crate::diagnosis::sampled;

/// How long a value may be held, s: the slowest message that is read comes ten times a second.
const HELD_MAX_S: f64 = 1.0;
/// How long nothing at all may come, s: a hundred frames and more are due in that time. A logger that paused
/// and a clock that jumped look the same, and over a jump every rate is wrong.
const SILENCE_MAX_S: f64 = 0.15;

/// A time in which something was not measured.
struct Hole {
    span_s: [f64; 2],
    what: String,
}

/// The longest part of `log` in which all that is read is there, and one sentence on what was left out; the
/// log itself where that is nothing. What is never there is for others to say.
pub(super) fn attended(log: FieldLog) -> (FieldLog, Option<String>) {
    let end_s = log.duration_s();
    let mut holes = holes(&log, end_s);
    if holes.is_empty() {
        return (log, None);
    }
    holes.sort_by(|a, b| a.span_s[0].total_cmp(&b.span_s[0]));
    let (mut best_s, mut bounds) = ([0.0, 0.0], [None; 2]);
    let (mut from_s, mut before) = (0.0, None);
    for hole in holes.iter().map(Some).chain([None]) {
        let to_s = hole.map_or(end_s, |hole| hole.span_s[0]);
        if to_s - from_s > best_s[1] - best_s[0] {
            (best_s, bounds) = ([from_s, to_s], [before, hole]);
        }
        if let Some(ends_s) = hole.map(|hole| hole.span_s[1]).filter(|ends_s| *ends_s > from_s) {
            (from_s, before) = (ends_s, hole);
        }
    }
    let why: Vec<&str> = bounds.into_iter().flatten().map(|hole| hole.what.as_str()).collect();
    let (name, why, [from_s, to_s]) = (log.name(), why.join(" and "), best_s);
    let note = format!(
        "{name}: {why} of a log of {end_s:.1} s; only {from_s:.1} to {to_s:.1} s of it are looked at."
    );
    (log.within(best_s), Some(note))
}

/// Where something that is read was not measured, a channel after the other.
fn holes(log: &FieldLog, end_s: f64) -> Vec<Hole> {
    let mut holes = Vec::new();
    let mut all_s: Vec<f64> = Vec::new();
    for channel in sampled() {
        let Some(series) = log.series(channel) else { continue };
        let times_s: Vec<f64> = series.iter().map(|(at_s, _)| at_s).collect();
        let (Some(&first_s), Some(&last_s)) = (times_s.first(), times_s.last()) else { continue };
        if first_s > HELD_MAX_S {
            let what = format!("{channel} begins at {first_s:.1} s");
            holes.push(Hole { span_s: [0.0, first_s], what });
        }
        holes.extend(pauses(&times_s, HELD_MAX_S).map(|span_s| Hole {
            span_s,
            what: format!("{channel} is away from {:.1} to {:.1} s", span_s[0], span_s[1]),
        }));
        if end_s - last_s > HELD_MAX_S {
            let what = format!("{channel} stops at {last_s:.1} s");
            holes.push(Hole { span_s: [last_s, end_s], what });
        }
        all_s.extend(times_s);
    }
    all_s.sort_by(f64::total_cmp);
    holes.extend(pauses(&all_s, SILENCE_MAX_S).map(|span_s| Hole {
        span_s,
        what: format!("nothing was logged from {:.2} to {:.2} s", span_s[0], span_s[1]),
    }));
    holes
}

/// Where two of `times_s` that follow one another are more than `most_s` apart.
fn pauses(times_s: &[f64], most_s: f64) -> impl Iterator<Item = [f64; 2]> {
    let pairs = times_s.windows(2).map(|pair| [pair[0], pair[1]]);
    pairs.filter(move |[before_s, after_s]| after_s - before_s > most_s)
}
