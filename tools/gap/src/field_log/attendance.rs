//! How well a message of a log keeps its period and its form, and which of its frames are there twice.

use xt28_dbc::Frame;
use xt28_machine::SimTime;

use super::gaps::{Arrivals, GAP_PERIODS, Gaps};
use crate::FaultKind;
use crate::decoder::{Tap, Unread};

/// A frame that repeats the one before, alive counter and all, within this share of the period was
/// logged twice: the sender would have counted on.
const SAME_COUNT_PERIODS: f64 = 0.75;
/// The same without a counter, where a reading may well be the same twice in a row.
const SAME_READING_PERIODS: f64 = 0.25;
/// A frame within this share of the period was sent by another, or written late.
const EARLY_PERIODS: f64 = 0.75;
/// So many of those are no strays.
const EARLY_MIN: u64 = 50;

/// What is known of one message so far.
#[derive(Default)]
pub(super) struct Attendance {
    last: Option<Heard>,
    frames: u64,
    repeats: u64,
    repeat_line: u64,
    gaps: Gaps,
    arrivals: Arrivals,
    short: Option<(u64, usize, u64)>,
    long: Option<(u64, usize, u64)>,
    spoiled: Option<(u64, f64, u64)>,
    /// Frames that came early, and the line of the first.
    early: Option<(u64, u64)>,
}

/// The latest frame that was no repeat.
struct Heard {
    at: SimTime,
    frame: Frame,
    /// When the one before it came.
    before: Option<SimTime>,
    /// Whether the one before it said something else, as a counter that counts does.
    is_news: bool,
}

impl Attendance {
    /// Whether the frame that came `at` is the one before once more, which it then notes.
    ///
    /// Nobody sends three frames in the time of one and a half, so without a counter that counts the
    /// repeat must be one too many: a logger that writes frames late, two at a time, repeats none.
    pub(super) fn is_repeat(&mut self, tap: &Tap, at: SimTime, line: u64, frame: &Frame) -> bool {
        let (Some(last), Some(period)) = (&self.last, tap.period()) else { return false };
        if last.frame.data() != frame.data() {
            return false;
        }
        let periods = |since: SimTime| (at - since).as_secs_f64() / period.as_secs_f64();
        let is_repeat = if tap.counts() && last.is_news {
            periods(last.at) < SAME_COUNT_PERIODS
        } else {
            periods(last.at) < SAME_READING_PERIODS
                && last.before.is_some_and(|before| periods(before) < GAP_PERIODS)
        };
        if is_repeat {
            if self.repeats == 0 {
                self.repeat_line = line;
            }
            self.repeats += 1;
        }
        is_repeat
    }

    /// Notes a frame, which came `at`, `at_s` s after the first of the log.
    pub(super) fn note(&mut self, tap: &Tap, at: SimTime, at_s: f64, line: u64, frame: &Frame) {
        let found = frame.data().len();
        match tap.unread(frame) {
            Some(Unread::Short) => self.short.get_or_insert((line, found, 0)).2 += 1,
            Some(Unread::Crc) => self.spoiled.get_or_insert((line, at_s, 0)).2 += 1,
            None if found > tap.bytes() => self.long.get_or_insert((line, found, 0)).2 += 1,
            None => {}
        }
        self.frames += 1;
        let before = self.last.as_ref().map(|last| last.at);
        match (before, tap.period()) {
            (Some(before), Some(period)) => {
                let away_s = (at - before).as_secs_f64();
                self.gaps.note([at_s, away_s], period.as_secs_f64(), line);
                if away_s < EARLY_PERIODS * period.as_secs_f64() {
                    self.early.get_or_insert((line, 0)).1 += 1;
                }
            }
            (None, Some(_)) => {}
            (_, None) => {
                self.arrivals.note(at, at_s, line);
                self.early.get_or_insert((line, 0)).1 += 1;
            }
        }
        let is_news = self.last.as_ref().is_some_and(|last| last.frame.data() != frame.data());
        self.last = Some(Heard { at, frame: *frame, before, is_news });
    }

    /// The line from which on it may have two senders: there are enough frames before they are due, or the
    /// database does not say when that is.
    pub(super) fn crowded_from(&self) -> Option<u64> {
        self.early.filter(|(_, frames)| *frames >= EARLY_MIN).map(|(line, _)| line)
    }

    /// What is missing of it.
    fn missing(&self, tap: &Tap) -> Gaps {
        if tap.period().is_some() { self.gaps.clone() } else { self.arrivals.gaps() }
    }

    /// How many frames are missing, and of how many.
    pub(super) fn lost(&self, tap: &Tap) -> [u64; 2] {
        let lost = self.missing(tap).lost();
        [lost, self.frames + lost]
    }

    pub(super) fn faults(&self, tap: &Tap) -> impl Iterator<Item = (u64, FaultKind)> {
        let message = || tap.name().to_owned();
        let missing = self.missing(tap);
        let dropped = missing.all.first().map(|first| first.line).map(|line| {
            let due = self.frames + missing.lost();
            let is_held = tap.channels().any(|channel| !channel.is_fix());
            (line, FaultKind::Dropped { message: message(), gaps: missing.all, due, is_held })
        });
        let repeated = (self.repeats > 0).then(|| {
            let (frames, of) = (self.repeats, self.frames + self.repeats);
            (self.repeat_line, FaultKind::Repeated { message: message(), frames, of })
        });
        let wanted = tap.bytes();
        let short = self.short.map(|(line, found, frames)| {
            (line, FaultKind::WrongLength { message: message(), found, wanted, frames })
        });
        let long = self.long.map(|(line, found, frames)| {
            (line, FaultKind::Padded { message: message(), found, wanted, frames })
        });
        let spoiled = self.spoiled.map(|(line, at_s, frames)| {
            (line, FaultKind::BadCrc { message: message(), at_s, frames })
        });
        [dropped, repeated, short, long, spoiled].into_iter().flatten()
    }
}
