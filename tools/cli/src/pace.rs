//! Wall time: what ticks cost, and pacing them on an absolute schedule.

use std::thread;
use std::time::{Duration, Instant};

/// A stopwatch that can also hold a run back to wall time.
pub(crate) struct Pace {
    start: Instant,
    realtime: bool,
    lateness_max: Duration,
}

impl Pace {
    /// Starts now.
    pub(crate) fn start(realtime: bool) -> Self {
        Self { start: Instant::now(), realtime, lateness_max: Duration::ZERO }
    }

    /// Time since the start.
    pub(crate) fn elapsed(&self) -> Duration {
        self.start.elapsed()
    }

    /// In real time, sleeps until `due` after the start; a tick that is late is not made up for by
    /// the ones after it, since the schedule is absolute.
    pub(crate) fn wait_until(&mut self, due: Duration) {
        if !self.realtime {
            return;
        }
        if let Some(early) = due.checked_sub(self.elapsed()) {
            thread::sleep(early);
        }
        let late = self.elapsed().saturating_sub(due);
        self.lateness_max = self.lateness_max.max(late);
    }

    /// Takes the schedule to have begun so much later: the run was held up, and is not late for it.
    pub(crate) fn begin_later(&mut self, by: Duration) {
        self.start += by;
    }

    /// How late the latest tick was, ms; only in real time.
    pub(crate) fn lateness_max_ms(&self) -> Option<f64> {
        self.realtime.then_some(self.lateness_max.as_secs_f64() * 1e3)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_latest_tick_is_told_though_later_ones_were_in_time() {
        let mut pace = Pace::start(true);
        thread::sleep(Duration::from_millis(30));
        pace.wait_until(Duration::ZERO);
        pace.wait_until(pace.elapsed() + Duration::from_millis(1));
        assert!(pace.elapsed() >= Duration::from_millis(31));
        assert!(pace.lateness_max_ms().unwrap() >= 30.0);
        let mut free = Pace::start(false);
        free.wait_until(Duration::from_secs(3_600));
        assert_eq!(free.lateness_max_ms(), None);
    }
}
