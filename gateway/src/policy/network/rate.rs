//! How often a network is asked, which is how often it was in training.

use core::time::Duration;

use xt28_machine::SimTime;

use crate::Pace;

/// Rates in Hz that come out even at ticks of 10 ms.
const EVEN_HZ: [u32; 5] = [10, 20, 25, 50, 100];

/// When a network is asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Rate {
    /// At each GNSS fix.
    Fix,
    /// So far apart, whatever the receiver does.
    Every(Duration),
}

impl Rate {
    /// A rate of `hz`, where ticks have it.
    pub(super) fn of_hz(hz: u32) -> Option<Self> {
        EVEN_HZ.contains(&hz).then(|| Self::Every(Duration::from_secs(1) / hz))
    }

    pub(super) const fn pace(self) -> Pace {
        match self {
            Self::Fix => Pace::Fix,
            Self::Every(_) => Pace::Tick,
        }
    }

    /// Whether one that was asked `last` is to be asked `now`; a tick that came late makes none of the others late.
    pub(super) fn is_due(self, last: Option<SimTime>, now: SimTime) -> bool {
        let (Self::Every(period), Some(last)) = (self, last) else { return true };
        let nth = |at: SimTime| u128::from(at.as_nanos()) / period.as_nanos();
        nth(now) > nth(last)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_network_is_asked_as_often_as_its_file_says() {
        for (hz, asked) in [(100, 100), (25, 25), (10, 10)] {
            let rate = Rate::of_hz(hz).unwrap();
            let mut last = None;
            let mut count = 0;
            for tick in 0..100 {
                // A host that is late by up to 3 ms.
                let at = SimTime::from_nanos(tick * 10_000_000 + tick * 7_919_317 % 3_000_000);
                if rate.is_due(last, at) {
                    (last, count) = (Some(at), count + 1);
                }
            }
            assert_eq!(count, asked, "{hz} Hz");
        }
        assert_eq!([0, 8, 30, 1000].map(Rate::of_hz), [None; 4]);
        assert!(Rate::Fix.is_due(Some(SimTime::ZERO), SimTime::ZERO));
        assert_eq!([Rate::Fix.pace(), Rate::of_hz(50).unwrap().pace()], [Pace::Fix, Pace::Tick]);
    }
}
