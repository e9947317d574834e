//! Frames back in order of time, where a logger merged several sources and wrote some a little late.

use std::collections::BTreeMap;
use std::time::Duration;

use xt28_dbc::Frame;
use xt28_machine::SimTime;

/// Sources that one log merges (interfaces, topics, what a node sent and heard) lie no further apart.
pub(super) const WINDOW: Duration = Duration::from_millis(100);

/// Holds frames back until nothing older can come any more. Frames of one instant stay as they came.
#[derive(Default)]
pub(super) struct Order {
    waiting: BTreeMap<(SimTime, u64), Frame>,
    latest: SimTime,
}

/// Where a frame stands to those before it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Place {
    /// Not before the latest.
    Next,
    /// This much before the latest, and put in order.
    Late(Duration),
    /// So far before the latest that another clock gave its time; it is not taken.
    Past(Duration),
}

impl Order {
    /// Takes the frame of a line, unless its time is of another clock.
    pub(super) fn put(&mut self, at: SimTime, line: u64, frame: Frame) -> Place {
        let place = match self.latest - at {
            by if by > WINDOW => return Place::Past(by),
            by if at < self.latest => Place::Late(by),
            _ => Place::Next,
        };
        self.latest = self.latest.max(at);
        self.waiting.insert((at, line), frame);
        place
    }

    /// The oldest frame with its line, once all that could come before it are there.
    pub(super) fn due(&mut self) -> Option<(SimTime, u64, Frame)> {
        let oldest = self.waiting.first_entry()?;
        // Strictly: a frame that is as old as the window allows may still come.
        if self.latest - oldest.key().0 <= WINDOW {
            return None;
        }
        let ((at, line), frame) = oldest.remove_entry();
        Some((at, line, frame))
    }

    /// The oldest frame with its line, when no more will come.
    pub(super) fn rest(&mut self) -> Option<(SimTime, u64, Frame)> {
        self.waiting.pop_first().map(|((at, line), frame)| (at, line, frame))
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use xt28_dbc::CanId;

    use super::*;

    fn frame() -> Frame {
        Frame::new(CanId::Standard(1), &[]).unwrap()
    }

    /// What comes out of stamps in ms, and how many were not taken.
    fn sorted(stamps_ms: &[u64]) -> (Vec<(u64, u64)>, usize) {
        let (mut order, mut out, mut past) = (Order::default(), Vec::new(), 0);
        for (line, &ms) in (1..).zip(stamps_ms) {
            past += usize::from(matches!(
                order.put(SimTime::from_millis(ms), line, frame()),
                Place::Past(_)
            ));
            out.extend(std::iter::from_fn(|| order.due()));
        }
        out.extend(std::iter::from_fn(|| order.rest()));
        (out.into_iter().map(|(at, line, _)| (at.as_nanos() / 1_000_000, line)).collect(), past)
    }

    #[test]
    fn what_comes_a_little_late_is_put_in_order_and_what_comes_far_too_late_is_not_taken() {
        let (out, past) = sorted(&[500, 400, 499, 500, 399, 700, 650, 599, 600]);
        let wanted = [(400, 2), (499, 3), (500, 1), (500, 4), (600, 9), (650, 7), (700, 6)];
        assert_eq!((out.as_slice(), past), (&wanted[..], 2));
    }

    proptest! {
        #[test]
        fn any_stamps_come_out_in_order_each_once(stamps in prop::collection::vec(0_u64..1_000, 0..60)) {
            let (out, past) = sorted(&stamps);
            prop_assert!(out.is_sorted());
            prop_assert_eq!(out.len() + past, stamps.len());
        }

        #[test]
        fn nothing_is_lost_of_sources_that_lie_within_the_window(
            late_ms in prop::collection::vec(0_u64..=100, 0..200),
        ) {
            let stamps: Vec<u64> =
                (0..).zip(&late_ms).map(|(i, late_ms)| 1_000 + 3 * i - late_ms).collect();
            prop_assert_eq!(sorted(&stamps).1, 0);
        }
    }
}
