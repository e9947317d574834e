//! How busy the bus is: over the whole run and over a sliding window.

use std::collections::VecDeque;

/// Adds up the time the bus is taken, intermission included: a saturated bus is at 1.
#[derive(Clone, Debug)]
pub(super) struct LoadMeter {
    window_ns: u64,
    /// When frames took the bus and let it go, oldest first, back to the start of the window.
    taken: VecDeque<(u64, u64)>,
    /// Nanoseconds of all frames begun.
    total_ns: u64,
}

impl LoadMeter {
    pub(super) fn new(window_ns: u64) -> Self {
        Self { window_ns, taken: VecDeque::new(), total_ns: 0 }
    }

    /// A frame takes the bus from `from_ns` until `until_ns`.
    pub(super) fn take(&mut self, from_ns: u64, until_ns: u64) {
        let window_start = from_ns.saturating_sub(self.window_ns);
        while self.taken.front().is_some_and(|&(_, until)| until <= window_start) {
            self.taken.pop_front();
        }
        self.taken.push_back((from_ns, until_ns));
        self.total_ns += until_ns - from_ns;
    }

    /// Share of the time since the start, 0 to 1.
    pub(super) fn total(&self, now_ns: u64) -> f64 {
        // Of a frame still on the bus only what has passed counts.
        let ahead = self.taken.back().map_or(0, |&(_, until)| until.saturating_sub(now_ns));
        share(self.total_ns - ahead, now_ns)
    }

    /// Share of the last window, or of the time since the start while that is shorter, 0 to 1.
    pub(super) fn window(&self, now_ns: u64) -> f64 {
        let start = now_ns.saturating_sub(self.window_ns);
        let busy = self
            .taken
            .iter()
            .rev()
            .take_while(|&&(_, until)| until > start)
            .map(|&(from, until)| until.min(now_ns) - from.clamp(start, now_ns))
            .sum();
        share(busy, now_ns - start)
    }
}

#[allow(clippy::cast_precision_loss)] // a ratio for people; the sums stay exact
fn share(busy_ns: u64, span_ns: u64) -> f64 {
    if span_ns == 0 { 0.0 } else { busy_ns as f64 / span_ns as f64 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_window_forgets_and_the_total_does_not() {
        let mut load = LoadMeter::new(1_000);
        load.take(0, 500);
        load.take(2_000, 2_250);
        assert_eq!(load.window(2_250), 0.25);
        assert_eq!(load.total(2_250), 750.0 / 2_250.0);
        assert_eq!(load.window(10_000), 0.0);
    }

    #[test]
    fn a_frame_cut_by_either_end_counts_in_part() {
        let mut load = LoadMeter::new(1_000);
        load.take(500, 1_500);
        assert_eq!(load.window(1_000), 0.5);
        assert_eq!(load.window(2_000), 0.5);
        assert_eq!(load.total(1_000), 0.5);
    }

    #[test]
    fn no_time_is_no_load() {
        let load = LoadMeter::new(1_000);
        assert_eq!((load.total(0), load.window(0)), (0.0, 0.0));
    }
}
