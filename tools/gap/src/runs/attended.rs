//! The part of a log in which everything that a diagnosis reads is there: what a message that begins late,
//! stops early or stays away held meanwhile was not measured, and says nothing of the machine.

use crate::diagnosis::{needed, sampled};
use crate::{Channel, Decoder, FieldLog};

/// How long a value may be held, s: the slowest message that is read comes ten times a second.
const HELD_MAX_S: f64 = 1.0;
/// How long nothing at all may come, s: a hundred frames and more are due in that time. A logger that paused
/// and a clock that jumped look the same, and over a jump every rate is wrong.
const SILENCE_MAX_S: f64 = 0.15;
/// What can be done without may cost half of what is needed; what comes and goes more than that is done without.
const WORTH: f64 = 0.5;

/// A time in which something was not measured.
struct Hole {
    span_s: [f64; 2],
    what: String,
}

/// A part of a log, and what bounds it.
struct Part {
    span_s: [f64; 2],
    bounds: Vec<String>,
}

/// The longest part of `log` in which all that is read is there, but for what comes and goes and can be done
/// without; and a sentence each on what was left out. What is never there is for others to say.
pub(super) fn attended(log: FieldLog, decoder: &Decoder) -> (FieldLog, Vec<String>) {
    let (all, least) = (Part::longest(&log, sampled()), Part::longest(&log, needed()));
    let spares = all.length_s() < WORTH * least.length_s();
    let part = if spares { least } else { all };
    let spared: Vec<(Channel, Hole)> = sampled()
        .filter(|channel| spares && needed().all(|needed| needed != *channel))
        .filter_map(|channel| Some((channel, part.hole_in(holes_of(&log, channel))?)))
        .collect();
    let mut notes = Vec::new();
    if !part.bounds.is_empty() {
        let (name, why, [from_s, to_s]) = (log.name(), part.bounds.join(" and "), part.span_s);
        let whole_s = log.duration_s();
        notes.push(format!(
            "{name}: {why} of a log of {whole_s:.1} s; only {from_s:.1} to {to_s:.1} s of it are looked at."
        ));
    }
    if let [(_, hole), others @ ..] = &spared[..] {
        let (name, what) = (log.name(), &hole.what);
        let more = match others.len() {
            0 => String::new(),
            n => format!(", as {n} more that come and go"),
        };
        notes.push(format!("{name}: {what}{more}; it is looked at without."));
    }
    let log = if part.bounds.is_empty() { log } else { log.within(part.span_s) };
    let spared: Vec<Channel> = spared.into_iter().map(|(channel, _)| channel).collect();
    let unread = messages_of_none_but(&spared, decoder);
    (log.without_losses_of(&unread).without(&spared), notes)
}

/// Messages of `spared` channels that no other is read from: it is told of those that they are done without, and
/// not as well that a value is held in them.
fn messages_of_none_but<'a>(spared: &[Channel], decoder: &'a Decoder) -> Vec<&'a str> {
    let fixes = Channel::all().into_iter().filter(|channel| channel.is_fix());
    let read = sampled().chain(fixes).filter(|channel| !spared.contains(channel));
    let read: Vec<&str> = read.filter_map(|channel| decoder.message_of(channel)).collect();
    let all = spared.iter().filter_map(|channel| decoder.message_of(*channel));
    all.filter(|message| !read.contains(message)).collect()
}

impl Part {
    /// The longest in which those of `channels` that are there at all are measured.
    fn longest(log: &FieldLog, channels: impl Iterator<Item = Channel>) -> Self {
        let end_s = log.duration_s();
        let mut holes: Vec<Hole> = channels.flat_map(|channel| holes_of(log, channel)).collect();
        holes.extend(silences(log));
        holes.sort_by(|a, b| a.span_s[0].total_cmp(&b.span_s[0]));
        let (mut best_s, mut bounds) = ([0.0, 0.0], [None; 2]);
        let (mut from_s, mut before) = (0.0, None);
        for hole in holes.iter().map(Some).chain([None]) {
            let to_s = hole.map_or(end_s, |hole| hole.span_s[0]);
            if to_s - from_s > best_s[1] - best_s[0] {
                (best_s, bounds) = ([from_s, to_s], [before, hole]);
            }
            if let Some(ends_s) = hole.map(|hole| hole.span_s[1]).filter(|ends_s| *ends_s > from_s)
            {
                (from_s, before) = (ends_s, hole);
            }
        }
        let bounds = bounds.into_iter().flatten().map(|hole| hole.what.clone()).collect();
        Self { span_s: best_s, bounds }
    }

    fn length_s(&self) -> f64 {
        self.span_s[1] - self.span_s[0]
    }

    /// The first of `holes` that is in it.
    fn hole_in(&self, holes: Vec<Hole>) -> Option<Hole> {
        let [from_s, to_s] = self.span_s;
        holes.into_iter().find(|hole| hole.span_s[0] < to_s && hole.span_s[1] > from_s)
    }
}

/// Where a channel that is there at all was not measured.
fn holes_of(log: &FieldLog, channel: Channel) -> Vec<Hole> {
    let (mut holes, end_s) = (Vec::new(), log.duration_s());
    let times_s = times_s(log, channel);
    let (Some(&first_s), Some(&last_s)) = (times_s.first(), times_s.last()) else { return holes };
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
    holes
}

/// Where nothing at all that is read came.
fn silences(log: &FieldLog) -> Vec<Hole> {
    let mut all_s: Vec<f64> = sampled().flat_map(|channel| times_s(log, channel)).collect();
    all_s.sort_by(f64::total_cmp);
    let told = |span_s: [f64; 2]| Hole {
        span_s,
        what: format!(
            "nothing was logged from {:.2} to {:.2} s (the logger paused, or its clock went ahead)",
            span_s[0], span_s[1]
        ),
    };
    pauses(&all_s, SILENCE_MAX_S).map(told).collect()
}

fn times_s(log: &FieldLog, channel: Channel) -> Vec<f64> {
    let series = log.series(channel).into_iter();
    series.flat_map(|series| series.iter().map(|(at_s, _)| at_s)).collect()
}

/// Where two of `times_s` that follow one another are more than `most_s` apart.
fn pauses(times_s: &[f64], most_s: f64) -> impl Iterator<Item = [f64; 2]> {
    let pairs = times_s.windows(2).map(|pair| [pair[0], pair[1]]);
    pairs.filter(move |[before_s, after_s]| after_s - before_s > most_s)
}
