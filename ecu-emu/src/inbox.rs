//! What becomes of a frame between the bus and the ECUs: lost, late, or neither.

use core::time::Duration;
use std::collections::VecDeque;

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use xt28_dbc::Frame;
use xt28_machine::SimTime;
use xt28_sim::effects::BusEffects;

/// Frames on their way to the ECUs.
#[derive(Clone, Debug)]
pub(crate) struct Inbox {
    effects: BusEffects,
    random: ChaCha8Rng,
    waiting: VecDeque<(SimTime, Frame)>,
}

impl Inbox {
    /// A way on which frames fare as `effects` say, drawn from `seed`.
    pub(crate) fn new(effects: BusEffects, seed: Option<u64>) -> Self {
        // A stream of its own: sensor noise is drawn from the same seed.
        let mut random = ChaCha8Rng::seed_from_u64(seed.unwrap_or(0));
        random.set_stream(1);
        Self { effects, random, waiting: VecDeque::new() }
    }

    /// Whether frames arrive at once and all of them do.
    pub(crate) fn is_direct(&self) -> bool {
        self.effects == BusEffects::default()
    }

    /// A frame that left the bus at `now`.
    pub(crate) fn put(&mut self, now: SimTime, frame: &Frame) {
        let lost = self.random.random::<f64>() < self.effects.frame_loss.share;
        let late_s = self.random.random::<f64>() * self.effects.command_jitter.latest_s;
        if lost {
            return;
        }
        let at = now + Duration::from_secs_f64(late_s);
        // None overtakes another: a frame that is held up holds up those behind it.
        let at = self.waiting.back().map_or(at, |(before, _)| at.max(*before));
        self.waiting.push_back((at, *frame));
    }

    /// The next frame that is there by `now`, with the time at which it came.
    pub(crate) fn take_due(&mut self, now: SimTime) -> Option<(SimTime, Frame)> {
        if self.waiting.front().is_some_and(|(at, _)| *at <= now) {
            self.waiting.pop_front()
        } else {
            None
        }
    }
}

#[cfg(test)]
mod tests {
    use xt28_dbc::CanId;
    use xt28_sim::effects::{CommandJitter, FrameLoss};

    use super::*;

    fn frame(n: u8) -> Frame {
        Frame::new(CanId::standard(0x123).unwrap(), &[n]).unwrap()
    }

    /// Times and first bytes of what arrives of 1000 frames, one every 10 ms.
    fn arrivals(effects: BusEffects) -> Vec<(SimTime, u8)> {
        let mut inbox = Inbox::new(effects, Some(3));
        let mut out = Vec::new();
        for n in 0..1100_u64 {
            let now = SimTime::from_millis(10 * n);
            if n < 1000 {
                inbox.put(now, &frame((n % 256) as u8));
            }
            while let Some((at, frame)) = inbox.take_due(now) {
                out.push((at, frame.data()[0]));
            }
        }
        out
    }

    #[test]
    fn a_share_of_the_frames_is_lost_and_the_same_ones_each_time() {
        let effects = BusEffects { frame_loss: FrameLoss { share: 0.2 }, ..Default::default() };
        let some = arrivals(effects);
        assert!((750..850).contains(&some.len()), "{}", some.len());
        assert_eq!(some, arrivals(effects));
    }

    #[test]
    fn late_frames_come_in_order_and_within_their_time() {
        let command_jitter = CommandJitter { latest_s: 0.05 };
        let late = arrivals(BusEffects { command_jitter, ..Default::default() });
        assert_eq!(late.len(), 1000);
        assert!(late.is_sorted_by_key(|(at, _)| *at));
        for (n, (at, byte)) in late.iter().enumerate() {
            assert_eq!(usize::from(*byte), n % 256);
            let late_s = at.as_secs_f64() - n as f64 * 0.01;
            assert!((-1e-9..=0.05 + 1e-9).contains(&late_s), "{late_s}");
        }
    }

    #[test]
    fn without_effects_the_way_is_direct() {
        assert!(Inbox::new(BusEffects::default(), None).is_direct());
    }
}
