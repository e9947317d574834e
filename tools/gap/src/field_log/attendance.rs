//! How well a message of a log keeps its period and its form.

use xt28_dbc::Frame;
use xt28_machine::SimTime;

use crate::FaultKind;
use crate::decoder::Tap;

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
    wrong_length: Option<(u64, usize, u64)>,
}

impl Attendance {
    pub(super) fn note(&mut self, tap: &Tap, at: SimTime, line: u64, frame: &Frame) {
        let found = frame.data().len();
        if found != tap.bytes() {
            self.wrong_length.get_or_insert((line, found, 0)).2 += 1;
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
        let length = self.wrong_length.map(|(line, found, frames)| {
            let wanted = tap.bytes();
            (line, FaultKind::WrongLength { message: message(), found, wanted, frames })
        });
        dropped.into_iter().chain(length)
    }
}
