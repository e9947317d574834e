//! Gaps in the row of a cyclic message, whether the database says its period or the row itself does.

use std::time::Duration;

use xt28_machine::SimTime;

/// A frame this many periods after the last of its kind came after a gap. Below two, so that one lost
/// frame is seen; above one, so that jitter is not.
pub(super) const GAP_PERIODS: f64 = 1.5;
/// Frames from which on a row tells its own period.
const ROW_MIN: usize = 50;
/// Share of its intervals that are about the one in the middle where a message is cyclic; one that is sent
/// when there is news keeps no period.
const REGULAR: f64 = 0.75;

/// What is missing of one message, in order of time.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Gaps {
    pub(super) all: Vec<Gap>,
}

impl Gaps {
    /// Notes that a frame came `at_s` after the first of the log, `away_s` after the one before it.
    pub(super) fn note(&mut self, [at_s, away_s]: [f64; 2], period_s: f64, line: u64) {
        let gap = |frames| Gap { span_s: [at_s - away_s, at_s], frames, line };
        self.all.extend(missing(away_s / period_s).map(gap));
    }

    /// Frames that would have filled them.
    pub(super) fn lost(&self) -> u64 {
        self.all.iter().map(|gap| gap.frames).sum()
    }
}

/// A time without frames of a cyclic message.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gap {
    /// From the frame before to the one after, s from the log's first frame.
    pub span_s: [f64; 2],
    /// Frames that would have filled it.
    pub frames: u64,
    /// Line of the frame after it.
    pub line: u64,
}

impl Gap {
    /// How long it is, s.
    #[must_use]
    pub fn length_s(&self) -> f64 {
        self.span_s[1] - self.span_s[0]
    }

    /// What of it is in a part of the log; `None` where nothing is missing there.
    #[allow(clippy::cast_precision_loss)] // tens of thousands
    pub(crate) fn within(&self, [from_s, to_s]: [f64; 2]) -> Option<Self> {
        let span_s = [self.span_s[0].max(from_s), self.span_s[1].min(to_s)];
        let periods = (self.frames + 1) as f64 * (span_s[1] - span_s[0]) / self.length_s();
        missing(periods).map(|frames| Self { span_s, frames, ..*self })
    }
}

/// Frames that are missing where the next comes after so many periods; `None` where none is.
fn missing(periods: f64) -> Option<u64> {
    // A whole number of periods, some tens of thousands at most.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let frames = (periods.round() as u64).saturating_sub(1).max(1);
    (periods > GAP_PERIODS).then_some(frames)
}

/// When the frames came of a message of which no database says how often it comes.
#[derive(Clone, Debug, Default)]
pub(super) struct Arrivals {
    came: Vec<(SimTime, f64, u64)>,
}

impl Arrivals {
    /// Notes a frame, which came `at`, `at_s` s after the first of the log, and its line.
    pub(super) fn note(&mut self, at: SimTime, at_s: f64, line: u64) {
        self.came.push((at, at_s, line));
    }

    /// What is missing by the row's own period; nothing where it keeps none.
    pub(super) fn gaps(&self) -> Gaps {
        let mut gaps = Gaps::default();
        let Some(period) = self.period() else { return gaps };
        for pair in self.came.windows(2) {
            let ((before, ..), (at, at_s, line)) = (pair[0], pair[1]);
            gaps.note([at_s, (at - before).as_secs_f64()], period.as_secs_f64(), line);
        }
        gaps
    }

    /// The interval in the middle of all, where most are about as long.
    #[allow(clippy::cast_precision_loss)]
    fn period(&self) -> Option<Duration> {
        if self.came.len() < ROW_MIN {
            return None;
        }
        let mut apart: Vec<Duration> = self.came.windows(2).map(|w| w[1].0 - w[0].0).collect();
        apart.sort_unstable();
        let middle = apart[apart.len() / 2];
        let about = |by: &&Duration| **by >= middle / 2 && **by <= middle.mul_f64(GAP_PERIODS);
        let regular = apart.iter().filter(about).count() as f64;
        (!middle.is_zero() && regular >= REGULAR * apart.len() as f64).then_some(middle)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(at_ms: impl Iterator<Item = u64>) -> Gaps {
        let mut arrivals = Arrivals::default();
        for (line, ms) in (1..).zip(at_ms) {
            arrivals.note(SimTime::from_micros(1000 * ms), 1e-3 * ms as f64, line);
        }
        arrivals.gaps()
    }

    #[test]
    fn a_row_that_keeps_a_period_tells_its_gaps() {
        let lost = [30, 60, 61];
        let gaps = row((0..100).filter(|k| !lost.contains(k)).map(|k| 20 * k + k % 3));
        let [one, two] = &gaps.all[..] else { panic!("{gaps:?}") };
        assert_eq!((one.frames, one.line, two.frames, gaps.lost()), (1, 31, 2, 3), "{gaps:?}");
        assert!((two.length_s() - 0.06).abs() < 0.003);
        assert!((two.span_s[0] - 20.0 * 0.059).abs() < 0.003);
        assert_eq!(row((0..100).map(|k| 20 * k)), Gaps::default());
    }

    #[test]
    fn a_part_of_a_log_has_the_part_of_a_gap_that_is_in_it() {
        let gap = Gap { span_s: [2.0, 2.1], frames: 9, line: 7 };
        assert_eq!(gap.within([0.0, 5.0]), Some(gap));
        let half = gap.within([2.05, 5.0]).unwrap();
        assert_eq!((half.span_s, half.frames, half.line), ([2.05, 2.1], 4, 7));
        assert_eq!(gap.within([0.0, 2.01]), None, "a period is no gap");
        assert_eq!(gap.within([3.0, 5.0]), None);
    }

    #[test]
    fn what_is_sent_when_there_is_news_has_no_gaps() {
        assert_eq!(row((0..100).map(|k| k * k)), Gaps::default());
        assert_eq!(row([0, 10, 20, 90].into_iter()), Gaps::default());
        assert_eq!(row((0..100).map(|_| 5)), Gaps::default());
    }
}
