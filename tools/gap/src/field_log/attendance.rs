//! How well a message of a log keeps its period and its form.

use xt28_dbc::Frame;
use xt28_machine::SimTime;

use crate::FaultKind;
use crate::decoder::{Tap, Unread};

/// A frame this many periods after the last of its kind came after a gap. Below two, so that one lost
/// frame is seen; above one, so that jitter is not.
const GAP_PERIODS: f64 = 1.5;

/// What is known of one message so far.
#[derive(Default)]
pub(super) struct Attendance {
    last: Option<SimTime>,
    gaps: u64,
    lost: u64,
    longest_s: f64,
    gap_line: u64,
    short: Option<(u64, usize, u64)>,
    long: Option<(u64, usize, u64)>,
    spoiled: Option<(u64, f64, u64)>,
}

impl Attendance {
    /// Notes a frame, which came `at`, `at_s` s after the first of the log.
    pub(super) fn note(&mut self, tap: &Tap, at: SimTime, at_s: f64, line: u64, frame: &Frame) {
        let found = frame.data().len();
        match tap.unread(frame) {
            Some(Unread::Short) => self.short.get_or_insert((line, found, 0)).2 += 1,
            Some(Unread::Crc) => self.spoiled.get_or_insert((line, at_s, 0)).2 += 1,
            None if found > tap.bytes() => self.long.get_or_insert((line, found, 0)).2 += 1,
            None => {}
        }
        if let (Some(last), Some(period)) = (self.last, tap.period()) {
            let away_s = (at - last).as_secs_f64();
            let periods = away_s / period.as_secs_f64();
            if periods > GAP_PERIODS {
                if self.gaps == 0 {
                    self.gap_line = line;
                }
                self.gaps += 1;
                // A whole number of periods, some tens of thousands at most.
                #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
                {
                    self.lost += (periods.round() as u64).saturating_sub(1).max(1);
                }
                self.longest_s = self.longest_s.max(away_s);
            }
        }
        self.last = Some(at);
    }

    pub(super) fn faults(&self, tap: &Tap) -> impl Iterator<Item = (u64, FaultKind)> {
        let message = || tap.name().to_owned();
        let dropped = (self.gaps > 0).then(|| {
            let (gaps, frames, longest_s) = (self.gaps, self.lost, self.longest_s);
            (self.gap_line, FaultKind::Dropped { message: message(), gaps, frames, longest_s })
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
        [dropped, short, long, spoiled].into_iter().flatten()
    }
}
