//! One stream of command frames: which are taken, and whether the last one is still good.

use xt28_dbc::e2e::{Alive, AliveCheck};
use xt28_machine::SimTime;

use crate::Refusal;
use crate::life::COMMAND_DEADLINE;

/// Lost frames that a stream may skip and stay the same stream: a third one misses the deadline.
const LOST_MAX: u8 = 2;

/// The commands that one message carries.
#[derive(Clone, Debug)]
pub(crate) struct CommandStream<T> {
    alive: AliveCheck,
    latest: Option<(SimTime, T)>,
    accepted: u8,
    frames: u32,
}

impl<T> Default for CommandStream<T> {
    fn default() -> Self {
        Self { alive: AliveCheck::default(), latest: None, accepted: 0, frames: 0 }
    }
}

impl<T: Copy> CommandStream<T> {
    /// Takes a well-formed frame's `counter` and what the ECU makes of its content. The counter
    /// moves on with a refused content too: the frame was there.
    pub(crate) fn offer(
        &mut self,
        now: SimTime,
        counter: u8,
        content: Result<T, Refusal>,
    ) -> Result<(), Refusal> {
        let fresh = self.fresh(now).is_some();
        match self.alive.check(counter) {
            Alive::Repeated => return Err(Refusal::Counter),
            // After a silence the sender may have started anew, with any counter.
            Alive::Lost(lost) if fresh && lost > LOST_MAX => return Err(Refusal::Counter),
            _ => {}
        }
        let content = content?;
        self.frames = if fresh { self.frames.saturating_add(1) } else { 1 };
        self.latest = Some((now, content));
        self.accepted = counter;
        Ok(())
    }

    /// The newest command, unless it is past its deadline.
    pub(crate) fn fresh(&self, now: SimTime) -> Option<T> {
        let (at, content) = self.latest?;
        (now.since(at) <= COMMAND_DEADLINE).then_some(content)
    }

    /// Frames taken since the stream was last lost.
    pub(crate) const fn frames(&self) -> u32 {
        self.frames
    }

    /// Counter of the last frame taken.
    pub(crate) const fn accepted(&self) -> u8 {
        self.accepted
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(ms: u64) -> SimTime {
        SimTime::from_millis(ms)
    }

    #[test]
    fn a_command_is_good_for_three_periods() {
        let mut stream = CommandStream::default();
        assert_eq!(stream.fresh(at(0)), None::<u8>);
        stream.offer(at(10), 0, Ok(7)).unwrap();
        assert_eq!(stream.fresh(at(40)), Some(7));
        assert_eq!(stream.fresh(SimTime::from_micros(40_001)), None);
    }

    #[test]
    fn repeats_and_leaps_are_refused_until_the_stream_is_lost() {
        let mut stream = CommandStream::default();
        stream.offer(at(0), 3, Ok(())).unwrap();
        assert_eq!(stream.offer(at(10), 3, Ok(())), Err(Refusal::Counter));
        assert_eq!(stream.offer(at(20), 6, Ok(())), Ok(()), "two were lost");
        assert_eq!(stream.offer(at(30), 10, Ok(())), Err(Refusal::Counter), "three were");
        assert_eq!(stream.offer(at(40), 11, Ok(())), Ok(()));
        assert_eq!(stream.frames(), 3);
        assert_eq!(stream.offer(at(100), 2, Ok(())), Ok(()), "a new start");
        assert_eq!((stream.frames(), stream.accepted()), (1, 2));
    }

    #[test]
    fn a_refused_content_keeps_the_last_good_command() {
        let mut stream = CommandStream::default();
        stream.offer(at(0), 0, Ok(1)).unwrap();
        assert_eq!(stream.offer(at(10), 1, Err(Refusal::Mode)), Err(Refusal::Mode));
        assert_eq!(stream.accepted(), 0);
        assert_eq!(stream.fresh(at(30)), Some(1));
        assert_eq!(stream.fresh(at(31)), None);
        assert_eq!(stream.offer(at(20), 2, Ok(2)), Ok(()), "the counter moved on");
    }
}
