//! The part of a log in which everything that a diagnosis reads is there: a message that begins late or stops
//! early was not measured before or after, and its first or last value says nothing of that.

use crate::FieldLog;
use crate::diagnosis::sampled;

/// How long a value may be held before its first sample or after its last, s: the slowest message that is
/// read comes ten times a second.
const HELD_MAX_S: f64 = 1.0;

/// `log` from where all that is read has begun to where some of it stops, and one sentence on what was
/// left out; the log itself where that is nothing. What is never there is for others to say.
pub(super) fn attended(log: FieldLog) -> (FieldLog, Option<String>) {
    let end_s = log.duration_s();
    let spans = sampled().filter_map(|channel| {
        let series = log.series(channel)?;
        let (first_s, _) = series.iter().next()?;
        Some((channel, [first_s, series.end_s()?]))
    });
    let spans: Vec<_> = spans.collect();
    let begins = spans.iter().max_by(|(_, a), (_, b)| a[0].total_cmp(&b[0]));
    let stops = spans.iter().min_by(|(_, a), (_, b)| a[1].total_cmp(&b[1]));
    let begins = begins.filter(|(_, span)| span[0] > HELD_MAX_S);
    let stops = stops.filter(|(_, span)| end_s - span[1] > HELD_MAX_S);
    if begins.is_none() && stops.is_none() {
        return (log, None);
    }
    let late = begins.map(|(channel, [at_s, _])| format!("{channel} begins at {at_s:.1} s"));
    let early = stops.map(|(channel, [_, at_s])| format!("{channel} stops at {at_s:.1} s"));
    let why = [late, early].into_iter().flatten().collect::<Vec<_>>().join(" and ");
    let from_s = begins.map_or(0.0, |(_, span)| span[0]);
    let to_s = stops.map_or(end_s, |(_, span)| span[1]).max(from_s);
    let note = format!(
        "{}: {why} of a log of {end_s:.1} s; only {from_s:.1} to {to_s:.1} s of it are looked at.",
        log.name()
    );
    (log.within([from_s, to_s]), Some(note))
}
