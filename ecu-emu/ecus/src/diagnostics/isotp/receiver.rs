//! The receiving half: frames into one message.

use xt28_machine::SimTime;

use super::pdu::{FlowStatus, IN_CONSECUTIVE, Pdu, flow_control};
use super::{CONSECUTIVE_TIMEOUT, Failure, FlowLimits, FrameData};

/// Takes one message at a time into a buffer of `N` bytes.
#[derive(Clone, Debug)]
pub(super) struct Receiver<const N: usize> {
    limits: FlowLimits,
    buffer: [u8; N],
    /// Bytes of the message in the buffer so far.
    received: usize,
    state: State,
    flow_control: Option<FlowStatus>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum State {
    Idle,
    /// The buffer holds a whole message.
    Complete,
    /// Waits for `sequence` of a message of `length` bytes since `since`.
    Within {
        length: usize,
        sequence: u8,
        block_left: u8,
        since: SimTime,
    },
}

impl<const N: usize> Receiver<N> {
    pub(super) const fn new(limits: FlowLimits) -> Self {
        let (buffer, state) = ([0; N], State::Idle);
        Self { limits, buffer, received: 0, state, flow_control: None }
    }

    /// Takes anything but a flow control.
    pub(super) fn on_pdu(&mut self, now: SimTime, pdu: &Pdu<'_>) -> Result<(), Failure> {
        let within = matches!(self.state, State::Within { .. });
        match *pdu {
            Pdu::Single(data) => {
                self.flow_control = None;
                self.state = State::Idle;
                self.received = 0;
                self.store(data)?;
                self.state = State::Complete;
                if within { Err(Failure::Interrupted) } else { Ok(()) }
            }
            Pdu::First { length, data } => {
                self.state = State::Idle;
                self.received = 0;
                let Some(length) = usize::try_from(length).ok().filter(|length| *length <= N)
                else {
                    self.flow_control = Some(FlowStatus::Overflow);
                    return Err(Failure::Overflow);
                };
                self.store(data)?;
                self.flow_control = Some(FlowStatus::Continue);
                let block_left = self.limits.block_size;
                self.state = State::Within { length, sequence: 1, block_left, since: now };
                if within { Err(Failure::Interrupted) } else { Ok(()) }
            }
            Pdu::Consecutive { sequence, data } => self.on_consecutive(now, sequence, data),
            Pdu::FlowControl { .. } => Ok(()),
        }
    }

    fn on_consecutive(&mut self, now: SimTime, sequence: u8, data: &[u8]) -> Result<(), Failure> {
        let State::Within { length, sequence: due, block_left, .. } = self.state else {
            // One that nobody waits for is ignored (9.8.3).
            return Ok(());
        };
        let left = length - self.received;
        // All but the last are full.
        let part = data.get(..left.min(IN_CONSECUTIVE)).filter(|_| sequence == due);
        let Some(part) = part else {
            // Nobody is to go on with a message that is given up.
            (self.state, self.flow_control) = (State::Idle, None);
            return Err(Failure::Sequence);
        };
        self.store(part)?;
        if self.received == length {
            self.state = State::Complete;
            return Ok(());
        }
        let block_left = match block_left {
            0 => 0,
            1 => {
                self.flow_control = Some(FlowStatus::Continue);
                self.limits.block_size
            }
            left => left - 1,
        };
        let sequence = (due + 1) % 16;
        self.state = State::Within { length, sequence, block_left, since: now };
        Ok(())
    }

    /// Appends to the buffer; only a buffer smaller than a frame can be too small for it.
    fn store(&mut self, data: &[u8]) -> Result<(), Failure> {
        let end = self.received + data.len();
        let room = self.buffer.get_mut(self.received..end).ok_or(Failure::Overflow)?;
        room.copy_from_slice(data);
        self.received = end;
        Ok(())
    }

    /// Gives up a message whose next frame stays away.
    pub(super) fn expire(&mut self, now: SimTime) -> Option<Failure> {
        let State::Within { since, .. } = self.state else { return None };
        if now.since(since) <= CONSECUTIVE_TIMEOUT {
            return None;
        }
        self.state = State::Idle;
        self.flow_control = None;
        Some(Failure::NoConsecutive)
    }

    /// The flow control that is due.
    pub(super) fn take_flow_control(&mut self) -> Option<FrameData> {
        let FlowLimits { block_size, separation } = self.limits;
        self.flow_control.take().map(|status| flow_control(status, block_size, separation))
    }

    /// The message, once it is whole; the receiver is idle again.
    pub(super) fn take_message(&mut self) -> Option<&[u8]> {
        let complete = self.state == State::Complete;
        if complete {
            self.state = State::Idle;
        }
        complete.then(|| &self.buffer[..self.received])
    }
}
