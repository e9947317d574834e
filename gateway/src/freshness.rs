//! When input came in that is read now: after a halt it has waited, nobody knows how long.

use core::time::Duration;

use xt28_safety::Limits;

/// A gap between two looks that is a halt (a debugger, SIGSTOP), not a busy machine: the safety kernel takes
/// what its limits lean on for stale after it.
const HALT: Duration = Duration::from_nanos(Limits::XT28.sensors.span_ns());
/// How long after a halt input counts as old: a terminal hands out what has waited in portions, some of them a
/// tick apart.
const SETTLE: Duration = Duration::from_millis(200);

/// The run's looks for input.
///
/// Sockets and terminals keep what comes while the program stands still, the oldest of it. Taken for fresh, a
/// position of ten seconds ago would be driven by.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Freshness {
    /// The last look after which nothing was left.
    looked: Duration,
    /// As of when input counts, and until when it does so.
    old: Option<[Duration; 2]>,
}

impl Freshness {
    /// When input that is taken `now` came in, at the earliest after a halt.
    pub(crate) fn came_in(&mut self, now: Duration) -> Duration {
        self.notice(now);
        match self.old {
            Some([as_of, until]) if now < until => as_of,
            _ => now,
        }
    }

    /// When the last look began that left nothing.
    pub(crate) const fn last_look(&self) -> Duration {
        self.looked
    }

    /// A look that began `at` this time has left nothing.
    pub(crate) fn looked(&mut self, at: Duration) {
        self.notice(at);
        self.looked = at;
    }

    fn notice(&mut self, now: Duration) {
        if now.saturating_sub(self.looked) > HALT {
            self.old = Some([self.looked, now + SETTLE]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MS: fn(u64) -> Duration = Duration::from_millis;

    #[test]
    fn what_is_read_in_time_is_as_old_as_it_is() {
        let mut freshness = Freshness::default();
        for tick in 1..100 {
            assert_eq!(freshness.came_in(MS(10 * tick)), MS(10 * tick));
            freshness.looked(MS(10 * tick));
        }
        assert_eq!(freshness.came_in(MS(1080)), MS(1080), "a busy machine");
    }

    #[test]
    fn what_waited_through_a_halt_counts_as_of_its_beginning() {
        for something_waits in [false, true] {
            let mut freshness = Freshness::default();
            freshness.looked(MS(90));
            if something_waits {
                assert_eq!(freshness.came_in(MS(5000)), MS(90));
            }
            freshness.looked(MS(5000));
            // A terminal's second portion.
            assert_eq!(freshness.came_in(MS(5010)), MS(90));
            freshness.looked(MS(5010));
            freshness.looked(MS(5100));
            assert_eq!(freshness.came_in(MS(5199)), MS(90));
            freshness.looked(MS(5199));
            assert_eq!(freshness.came_in(MS(5200)), MS(5200));
        }
    }
}
