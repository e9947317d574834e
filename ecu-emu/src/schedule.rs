//! When ticks are due: every 10 ms on an absolute schedule, put off by what the program was held up for.

use std::fmt;
use std::time::{Duration, Instant};

use xt28_machine::SimTime;

/// A tick that is later than this is not made up for: as many ticks at once as an ECU goes without a command.
const PUT_OFF: Duration = Duration::from_millis(30);
/// What came while a tick was later than this is stale: the gateway has given up on its senders as well.
pub(crate) const STALE: Duration = Duration::from_millis(100);

/// The wall time of every tick, and how late they were.
///
/// A short delay is made up for, so that the machine's time stays the wall's. A longer one (a debugger,
/// SIGSTOP, a machine with other things to do) is no time for the machine, and everything in it goes on from
/// where it was: made up for, a second's halt would put a second's frames on the bus at once.
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

    /// Time on the wall since the tick of time zero, where the machine has `now`.
    pub(crate) fn on_the_wall(&self, now: SimTime) -> SimTime {
        now + self.halted
    }

    /// Whether what is taken off a bus `at` this instant, before the tick of `now`, may be too old to be heard.
    pub(crate) fn is_stale(&self, now: SimTime, at: Instant) -> bool {
        self.lateness(now, at) > STALE
    }

    /// Notes that the tick of `now` begins `at` this instant, and puts off what follows if that is too late.
    pub(crate) fn begin(&mut self, now: SimTime, at: Instant) {
        let late = self.lateness(now, at);
        self.ticks += 1;
        self.late += late;
        self.worst = self.worst.max(late);
        if late > PUT_OFF {
            self.start += late;
            self.halts += 1;
            self.halted += late;
        }
    }

    fn lateness(&self, now: SimTime, at: Instant) -> Duration {
        at.saturating_duration_since(self.due(now))
    }
}

impl fmt::Display for Schedule {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mean = self.late.checked_div(self.ticks).unwrap_or_default();
        write!(f, "{} ticks, late {mean:.0?} on average, {:.0?} at worst", self.ticks, self.worst)?;
        if self.halts > 0 {
            let (seconds, halts) = (self.halted.as_secs_f64(), self.halts);
            write!(f, "; put off by {seconds:.2} s in {halts} halt(s)")?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MS: fn(u64) -> Duration = Duration::from_millis;
    const AT: fn(u64) -> SimTime = SimTime::from_millis;

    #[test]
    fn a_delay_is_made_up_for() {
        let start = Instant::now();
        let mut schedule = Schedule::new(start);
        let late = start + MS(45);
        assert!(!schedule.is_stale(AT(20), late));
        schedule.begin(AT(20), late);
        assert_eq!(schedule.due(AT(30)), start + MS(30), "at once");
        assert_eq!(schedule.on_the_wall(AT(30)), AT(30));
        assert_eq!(schedule.to_string(), "1 ticks, late 25ms on average, 25ms at worst");
    }

    #[test]
    fn three_ticks_are_the_most_that_is_made_up_for_and_a_tenth_of_a_second_the_most_that_is_heard()
    {
        let start = Instant::now();
        let put_off = [30, 31].map(|ms| {
            let mut schedule = Schedule::new(start);
            schedule.begin(AT(0), start + MS(ms));
            schedule.due(AT(0)) > start
        });
        assert_eq!(put_off, [false, true]);
        let schedule = Schedule::new(start);
        assert_eq!([100, 101].map(|ms| schedule.is_stale(AT(0), start + MS(ms))), [false, true]);
    }

    #[test]
    fn a_halt_is_not() {
        let start = Instant::now();
        let mut schedule = Schedule::new(start);
        let after = start + MS(5030);
        assert!(schedule.is_stale(AT(30), after));
        schedule.begin(AT(30), after);
        assert!(!schedule.is_stale(AT(40), after));
        assert_eq!(schedule.due(AT(40)), after + MS(10));
        assert_eq!(schedule.time(after + MS(10)), AT(40));
        assert_eq!(schedule.on_the_wall(AT(40)), AT(5040));
        let said = "1 ticks, late 5s on average, 5s at worst; put off by 5.00 s in 1 halt(s)";
        assert_eq!(schedule.to_string(), said);
    }
}
