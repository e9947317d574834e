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

/// What is missing of one message.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Gaps {
    /// How many there are.
    pub(super) gaps: u64,
    /// Frames that would have filled them.
    pub(super) lost: u64,
    /// The longest, s.
    pub(super) longest_s: f64,
    /// Line of the frame after the first.
    pub(super) line: u64,
}

impl Gaps {
    /// Notes that a frame came `away_s` after the one before it.
    pub(super) fn note(&mut self, away_s: f64, period_s: f64, line: u64) {
        let periods = away_s / period_s;
        if periods <= GAP_PERIODS {
            return;
        }
        if self.gaps == 0 {
            self.line = line;
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

/// When the frames came of a message of which no database says how often it comes.
#[derive(Clone, Debug, Default)]
pub(super) struct Arrivals {
    came: Vec<(SimTime, u64)>,
}

impl Arrivals {
    /// Notes a frame and its line.
    pub(super) fn note(&mut self, at: SimTime, line: u64) {
        self.came.push((at, line));
    }

    /// What is missing by the row's own period; nothing where it keeps none.
    pub(super) fn gaps(&self) -> Gaps {
        let mut gaps = Gaps::default();
        let Some(period) = self.period() else { return gaps };
        for pair in self.came.windows(2) {
            let ((before, _), (at, line)) = (pair[0], pair[1]);
            gaps.note((at - before).as_secs_f64(), period.as_secs_f64(), line);
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
            arrivals.note(SimTime::from_micros(1000 * ms), line);
        }
        arrivals.gaps()
    }

    #[test]
    fn a_row_that_keeps_a_period_tells_its_gaps() {
        let lost = [30, 60, 61];
        let gaps = row((0..100).filter(|k| !lost.contains(k)).map(|k| 20 * k + k % 3));
        assert_eq!((gaps.gaps, gaps.lost, gaps.line), (2, 3, 31), "{gaps:?}");
        assert!((gaps.longest_s - 0.06).abs() < 0.003);
        assert_eq!(row((0..100).map(|k| 20 * k)), Gaps::default());
    }

    #[test]
    fn what_is_sent_when_there_is_news_has_no_gaps() {
        assert_eq!(row((0..100).map(|k| k * k)), Gaps::default());
        assert_eq!(row([0, 10, 20, 90].into_iter()), Gaps::default());
        assert_eq!(row((0..100).map(|_| 5)), Gaps::default());
    }
}
