//! The sending half: one message into frames, at the pace the receiver sets.

use core::time::Duration;

use xt28_machine::SimTime;

use super::pdu::{FlowStatus, IN_CONSECUTIVE, IN_FIRST, SINGLE_MAX, padded};
use super::{FLOW_CONTROL_TIMEOUT, Failure, FrameData, MESSAGE_MAX, SendError, WAITS_MAX};

/// Sends one message at a time from a buffer of `N` bytes.
#[derive(Clone, Debug)]
pub(super) struct Sender<const N: usize> {
    buffer: [u8; N],
    length: usize,
    sent: usize,
    sequence: u8,
    state: State,
}

#[derive(Clone, Copy, Debug)]
enum State {
    Idle,
    /// The single or first frame is to leave.
    Begin,
    /// Waits for flow control.
    Waits {
        since: SimTime,
        waits: u8,
    },
    /// Consecutive frames may leave, the next at `due`; `block_left` of them, if the receiver
    /// limits them.
    Sends {
        due: SimTime,
        separation: Duration,
        block_left: Option<u8>,
    },
}

impl<const N: usize> Sender<N> {
    pub(super) const fn new() -> Self {
        Self { buffer: [0; N], length: 0, sent: 0, sequence: 0, state: State::Idle }
    }

    pub(super) const fn is_busy(&self) -> bool {
        !matches!(self.state, State::Idle)
    }

    /// Begins a message of `length` bytes that `fill` writes.
    pub(super) fn start_with(
        &mut self,
        length: usize,
        fill: impl FnOnce(&mut [u8]),
    ) -> Result<(), SendError> {
        if self.is_busy() {
            return Err(SendError::Busy);
        }
        if !(1..=N.min(MESSAGE_MAX)).contains(&length) {
            return Err(SendError::Length(length));
        }
        fill(&mut self.buffer[..length]);
        (self.length, self.sent, self.sequence, self.state) = (length, 0, 0, State::Begin);
        Ok(())
    }

    /// The payload that is to leave at `now`.
    pub(super) fn poll(&mut self, now: SimTime) -> Option<FrameData> {
        match self.state {
            State::Begin if self.length <= SINGLE_MAX => {
                self.state = State::Idle;
                #[allow(clippy::cast_possible_truncation)] // at most 7
                Some(self.take(&[self.length as u8], SINGLE_MAX))
            }
            State::Begin => {
                self.state = State::Waits { since: now, waits: 0 };
                #[allow(clippy::cast_possible_truncation)] // at most 4095
                let [high, low] = (0x1000 | self.length as u16).to_be_bytes();
                Some(self.take(&[high, low], IN_FIRST))
            }
            State::Sends { due, separation, block_left } if now >= due => {
                self.sequence = (self.sequence + 1) % 16;
                let frame = self.take(&[0x20 | self.sequence], IN_CONSECUTIVE);
                self.state = match block_left {
                    _ if self.sent == self.length => State::Idle,
                    Some(..=1) => State::Waits { since: now, waits: 0 },
                    left => State::Sends {
                        due: now + separation,
                        separation,
                        block_left: left.map(|left| left - 1),
                    },
                };
                Some(frame)
            }
            State::Idle | State::Waits { .. } | State::Sends { .. } => None,
        }
    }

    /// The next bytes of the message, `count` at most, behind `head`.
    fn take(&mut self, head: &[u8], count: usize) -> FrameData {
        let part = &self.buffer[self.sent..self.length.min(self.sent + count)];
        let mut frame = padded(head);
        frame[head.len()..head.len() + part.len()].copy_from_slice(part);
        self.sent += part.len();
        frame
    }

    /// The receiver's word. One that nobody waits for is ignored.
    pub(super) fn on_flow_control(
        &mut self,
        now: SimTime,
        status: FlowStatus,
        block_size: u8,
        separation: Duration,
    ) -> Result<(), Failure> {
        let State::Waits { waits, .. } = self.state else { return Ok(()) };
        let failure = match status {
            FlowStatus::Continue => {
                let block_left = (block_size > 0).then_some(block_size);
                self.state = State::Sends { due: now, separation, block_left };
                return Ok(());
            }
            FlowStatus::Wait if waits < WAITS_MAX => {
                self.state = State::Waits { since: now, waits: waits + 1 };
                return Ok(());
            }
            FlowStatus::Wait => Failure::Waits,
            FlowStatus::Overflow => Failure::Overflow,
            FlowStatus::Invalid => Failure::FlowStatus,
        };
        self.state = State::Idle;
        Err(failure)
    }

    /// Gives up a message for which no flow control comes.
    pub(super) fn expire(&mut self, now: SimTime) -> Option<Failure> {
        let State::Waits { since, .. } = self.state else { return None };
        if now.since(since) <= FLOW_CONTROL_TIMEOUT {
            return None;
        }
        self.state = State::Idle;
        Some(Failure::NoFlowControl)
    }
}
