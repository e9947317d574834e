//! When ticks are due: every 10 ms on an absolute schedule, put off by what the program was halted for.

use std::fmt;
use std::time::{Duration, Instant};

use xt28_machine::SimTime;

/// A tick that is later than this is not made up for (assumed: more than a busy machine makes one wait,
/// less than somebody takes to stop a program and let it go on).
const HALT: Duration = Duration::from_secs(1);

/// The wall time of every tick, and how late they were.
///
/// A short delay is made up for, so that the machine's time stays the wall's. A halt (a debugger, SIGSTOP) is
/// no time for the machine, and everything in it goes on from where it was: made up for, a minute's halt
/// would put a minute's frames on the bus at once.
#[derive(Debug)]
pub(crate) struct Schedule {
    start: Instant,
    ticks: u32,
    late: Duration,
    worst: Duration,
    halts: u32,
    halted: Duration,
}

impl Schedule {
    /// The tick of time zero is due at `start`.
    pub(crate) fn new(start: Instant) -> Self {
        let zero = Duration::ZERO;
        Self { start, ticks: 0, late: zero, worst: zero, halts: 0, halted: zero }
    }

    /// When the tick of `now` is due.
    pub(crate) fn due(&self, now: SimTime) -> Instant {
        self.start + now.since(SimTime::ZERO)
    }

    /// The machine's time at an instant.
    pub(crate) fn time(&self, at: Instant) -> SimTime {
        let since = at.saturating_duration_since(self.start).as_nanos();
        SimTime::from_nanos(u64::try_from(since).unwrap_or(u64::MAX))
    }

    /// Whether the program was halted, if the tick of `now` has not begun `at` this instant.
    pub(crate) fn is_halted(&self, now: SimTime, at: Instant) -> bool {
        at.saturating_duration_since(self.due(now)) > HALT
    }

    /// Has the tick of `now` due `at` this instant, and what follows as much later.
    pub(crate) fn put_off(&mut self, now: SimTime, at: Instant) {
        let by = at.saturating_duration_since(self.due(now));
        self.start += by;
        self.halts += 1;
        self.halted += by;
    }

    /// Notes that the tick of `now` begins `at` this instant.
    pub(crate) fn begin(&mut self, now: SimTime, at: Instant) {
        let late = at.saturating_duration_since(self.due(now));
        self.ticks += 1;
        self.late += late;
        self.worst = self.worst.max(late);
    }
}

impl fmt::Display for Schedule {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mean = self.late.checked_div(self.ticks).unwrap_or_default();
        write!(f, "{} ticks, late {mean:.0?} on average, {:.0?} at worst", self.ticks, self.worst)?;
        if self.halts > 0 {
            let (times, seconds) = (self.halts, self.halted.as_secs_f64());
            write!(
                f,
                "; halted {times} time(s), {seconds:.1} s that the machine knows nothing of"
            )?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MS: fn(u64) -> Duration = Duration::from_millis;

    #[test]
    fn a_delay_is_made_up_for_and_a_halt_is_not() {
        let start = Instant::now();
        let mut schedule = Schedule::new(start);
        let now = SimTime::from_millis(20);
        assert_eq!(schedule.due(now), start + MS(20));
        let late = start + MS(900);
        assert!(!schedule.is_halted(now, late));
        schedule.begin(now, late);
        assert_eq!(schedule.due(SimTime::from_millis(30)), start + MS(30), "at once");

        let after = start + MS(5030);
        let now = SimTime::from_millis(30);
        assert!(schedule.is_halted(now, after));
        schedule.put_off(now, after);
        assert!(!schedule.is_halted(now, after));
        assert_eq!(schedule.due(now), after);
        assert_eq!(schedule.due(SimTime::from_millis(40)), after + MS(10));
        assert_eq!(schedule.time(after + MS(10)), SimTime::from_millis(40));
        schedule.begin(now, after);
        let said = schedule.to_string();
        assert_eq!(
            said,
            "2 ticks, late 440ms on average, 880ms at worst; \
             halted 1 time(s), 5.0 s that the machine knows nothing of"
        );
    }
}
