//! Which of our frames left, and which wait: the log has what was on the bus.

use std::collections::VecDeque;

use xt28_dbc::Frame;

/// Frames given to the socket that have neither left nor been thrown away, in their order.
#[derive(Debug, Default)]
pub(crate) struct Departures {
    waiting: VecDeque<Frame>,
    /// How many had left when it was last asked.
    left: u64,
}

impl Departures {
    /// A frame that the socket has taken on.
    pub(crate) fn add(&mut self, frame: &Frame) {
        self.waiting.push_back(*frame);
    }

    /// True while a frame waits for the kernel.
    pub(crate) fn wait(&self) -> bool {
        !self.waiting.is_empty()
    }

    /// The frames that left since the last call, where `left` have in all and `still_wait` wait. The socket
    /// throws away all that wait or nothing, so the newest are those that still do. To be asked before each
    /// frame that is added: one that leaves at once is else taken for one that was thrown away.
    pub(crate) fn settle(&mut self, left: u64, still_wait: usize) -> Vec<Frame> {
        let now = usize::try_from(left.saturating_sub(self.left)).unwrap_or(usize::MAX);
        self.left = left;
        let gone = self.waiting.drain(..now.min(self.waiting.len())).collect();
        let discarded = self.waiting.len().saturating_sub(still_wait);
        self.waiting.drain(..discarded);
        gone
    }
}

#[cfg(test)]
mod tests {
    use xt28_dbc::CanId;

    use super::*;

    fn frame(n: u8) -> Frame {
        Frame::new(CanId::Standard(1), &[n]).unwrap()
    }

    fn numbers(frames: &[Frame]) -> Vec<u8> {
        frames.iter().map(|frame| frame.data()[0]).collect()
    }

    #[test]
    fn a_frame_is_told_when_it_leaves_and_never_when_it_is_thrown_away() {
        let mut departures = Departures::default();
        (1..=4).for_each(|n| departures.add(&frame(n)));
        assert_eq!(numbers(&departures.settle(1, 3)), [1]);
        assert_eq!(numbers(&departures.settle(1, 3)), [0; 0]);
        assert_eq!(numbers(&departures.settle(2, 2)), [2]);
        // What waited is thrown away, and another one comes and waits.
        departures.add(&frame(5));
        assert_eq!(numbers(&departures.settle(2, 1)), [0; 0]);
        assert!(departures.wait());
        assert_eq!(numbers(&departures.settle(3, 0)), [5]);
        assert!(!departures.wait());
        // Thrown away, and the next one leaves at once: asked in between, it is not taken for the old one.
        departures.add(&frame(6));
        assert_eq!(numbers(&departures.settle(3, 0)), [0; 0]);
        departures.add(&frame(7));
        assert_eq!(numbers(&departures.settle(4, 0)), [7]);
    }
}
