//! ISO-TP (ISO 15765-2:2016, classic CAN, normal addressing): messages of up to 4095 bytes in
//! frames of eight.
//!
//! Sans-IO: payloads of frames go in with the time they arrived, payloads to be sent come out, and
//! whoever holds the endpoint puts identifiers on them. Buffers are fixed; nothing allocates, and
//! no payload makes it panic. A fault of the other side is counted and named, never an `Err`.

mod pdu;
mod receiver;
mod sender;

use core::time::Duration;

use xt28_machine::SimTime;

use self::pdu::Pdu;
use self::receiver::Receiver;
use self::sender::Sender;

/// Longest message that a 12-bit length can say, bytes.
pub const MESSAGE_MAX: usize = 4095;
/// Time allowed between a first or last frame of a block and the flow control for it (`N_Bs`).
pub const FLOW_CONTROL_TIMEOUT: Duration = Duration::from_millis(1000);
/// Time allowed between two consecutive frames of a message (`N_Cr`).
pub const CONSECUTIVE_TIMEOUT: Duration = Duration::from_millis(1000);
/// Flow controls `wait` in a row that a sender puts up with (`N_WFTmax`).
pub const WAITS_MAX: u8 = 10;
/// What fills a frame behind its payload (ISO 15765-2, 10.4.2.1: it stuffs no bits).
pub const PADDING: u8 = 0xCC;

/// The payload of a frame to be sent, padded to eight bytes.
pub type FrameData = [u8; 8];

/// What this side asks of senders in its flow control.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FlowLimits {
    /// Consecutive frames between two flow controls; 0 for no further ones.
    pub block_size: u8,
    /// Least time between two consecutive frames (`STmin`).
    pub separation: Duration,
}

/// Why a message did not get through.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Failure {
    /// No flow control came in time (`N_TIMEOUT_Bs`).
    NoFlowControl,
    /// No further consecutive frame came in time (`N_TIMEOUT_Cr`).
    NoConsecutive,
    /// A consecutive frame was missing or came twice (`N_WRONG_SN`).
    Sequence,
    /// A new message began within one (`N_UNEXP_PDU`).
    Interrupted,
    /// The other side has no room for the message (`N_BUFFER_OVFLW`), or we have none for its.
    Overflow,
    /// A flow control with a status that is none (`N_INVALID_FS`).
    FlowStatus,
    /// The other side asked to wait too often (`N_WFT_OVRN`).
    Waits,
}

/// Why a message is not taken to be sent.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SendError {
    /// One is on its way.
    #[error("a message is still being sent; wait until it is through")]
    Busy,
    /// It has no byte, or more than the buffer.
    #[error("a message of {0} bytes; send 1 up to the buffer's size")]
    Length(usize),
}

/// One end of a connection: takes messages of up to `RX` bytes and sends such of up to `TX`.
#[derive(Clone, Debug)]
pub struct Endpoint<const RX: usize, const TX: usize> {
    receiver: Receiver<RX>,
    sender: Sender<TX>,
    failure: Option<Failure>,
}

impl<const RX: usize, const TX: usize> Endpoint<RX, TX> {
    /// An idle endpoint that asks `limits` of the other side.
    #[must_use]
    pub const fn new(limits: FlowLimits) -> Self {
        Self { receiver: Receiver::new(limits), sender: Sender::new(), failure: None }
    }

    /// Takes the payload of a frame. Gives the message that it completes, if any.
    pub fn on_frame(&mut self, now: SimTime, data: &[u8]) -> Option<&[u8]> {
        self.expire(now);
        let outcome = match Pdu::parse(data)? {
            Pdu::FlowControl { status, block_size, separation } => {
                self.sender.on_flow_control(now, status, block_size, separation)
            }
            pdu => self.receiver.on_pdu(now, &pdu),
        };
        self.failure = outcome.err().or(self.failure);
        // A message that broke into another may be complete in itself.
        self.receiver.take_message()
    }

    /// Begins to send `message`.
    ///
    /// # Errors
    /// [`SendError`]; nothing is sent then.
    pub fn send(&mut self, message: &[u8]) -> Result<(), SendError> {
        self.sender.start_with(message.len(), |buffer| buffer.copy_from_slice(message))
    }

    /// The payload that is to leave at `now`, if any; call until there is none.
    pub fn poll(&mut self, now: SimTime) -> Option<FrameData> {
        self.expire(now);
        self.receiver.take_flow_control().or_else(|| self.sender.poll(now))
    }

    /// True while a message is on its way out.
    #[must_use]
    pub const fn is_sending(&self) -> bool {
        self.sender.is_busy()
    }

    /// What last went wrong, once.
    pub const fn take_failure(&mut self) -> Option<Failure> {
        self.failure.take()
    }

    /// Ends what has waited for too long.
    fn expire(&mut self, now: SimTime) {
        if let Some(why) = self.receiver.expire(now).or_else(|| self.sender.expire(now)) {
            self.failure = Some(why);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIMITS: FlowLimits = FlowLimits { block_size: 2, separation: Duration::ZERO };

    fn at(ms: u64) -> SimTime {
        SimTime::from_millis(ms)
    }

    fn endpoint() -> Endpoint<64, 64> {
        Endpoint::new(LIMITS)
    }

    #[test]
    fn seven_bytes_are_one_padded_frame_and_eight_are_two() {
        let mut end = endpoint();
        end.send(&[0x3E, 0x00]).unwrap();
        assert_eq!(end.poll(at(0)), Some([2, 0x3E, 0, 0xCC, 0xCC, 0xCC, 0xCC, 0xCC]));
        assert_eq!(end.poll(at(0)), None);
        end.send(&[1, 2, 3, 4, 5, 6, 7, 8]).unwrap();
        assert_eq!(end.poll(at(0)), Some([0x10, 8, 1, 2, 3, 4, 5, 6]));
        assert_eq!(end.poll(at(5)), None, "waits for flow control");
        assert_eq!(end.on_frame(at(6), &[0x30, 0, 0]), None);
        assert_eq!(end.poll(at(6)), Some([0x21, 7, 8, 0xCC, 0xCC, 0xCC, 0xCC, 0xCC]));
        assert!(!end.is_sending());
    }

    #[test]
    fn a_receiver_asks_for_blocks_and_gives_the_message() {
        let mut end = endpoint();
        assert_eq!(end.on_frame(at(0), &[0x10, 21, 1, 2, 3, 4, 5, 6]), None);
        assert_eq!(end.poll(at(0)), Some([0x30, 2, 0, 0xCC, 0xCC, 0xCC, 0xCC, 0xCC]));
        assert_eq!(end.poll(at(0)), None);
        assert_eq!(end.on_frame(at(1), &[0x21, 7, 8, 9, 10, 11, 12, 13]), None);
        assert_eq!(end.poll(at(1)), None);
        assert_eq!(end.on_frame(at(2), &[0x22, 14, 15, 16, 17, 18, 19, 20]), None);
        assert_eq!(end.poll(at(2)).map(|fc| fc[0]), Some(0x30));
        let whole: Vec<u8> = (1..=21).collect();
        assert_eq!(end.on_frame(at(3), &[0x23, 21]), Some(&whole[..]));
    }

    #[test]
    fn what_the_other_side_does_wrong_has_a_name() {
        let mut end = endpoint();
        end.on_frame(at(0), &[0x10, 20, 1, 2, 3, 4, 5, 6]);
        end.on_frame(at(1), &[0x22, 0, 0, 0, 0, 0, 0, 0]);
        assert_eq!(end.take_failure(), Some(Failure::Sequence));
        assert_eq!(end.poll(at(1)), None, "no flow control for what is given up");
        end.on_frame(at(2), &[0x10, 65, 1, 2, 3, 4, 5, 6]);
        assert_eq!(end.take_failure(), Some(Failure::Overflow));
        assert_eq!(end.poll(at(2)).map(|fc| fc[0]), Some(0x32), "says so");
        end.on_frame(at(3), &[0x10, 20, 1, 2, 3, 4, 5, 6]);
        assert_eq!(end.on_frame(at(4), &[1, 0x3E]), Some(&[0x3E][..]));
        assert_eq!(end.take_failure(), Some(Failure::Interrupted));
        assert_eq!(end.take_failure(), None);
    }

    #[test]
    fn both_sides_give_up_after_a_second() {
        let mut end = endpoint();
        end.on_frame(at(0), &[0x10, 20, 1, 2, 3, 4, 5, 6]);
        assert_eq!(end.poll(at(1000)).map(|fc| fc[0]), Some(0x30));
        assert_eq!(end.poll(at(1001)), None);
        assert_eq!(end.take_failure(), Some(Failure::NoConsecutive));
        end.send(&[0; 20]).unwrap();
        end.poll(at(2000)).unwrap();
        assert!(end.is_sending());
        end.poll(at(3001));
        assert_eq!((end.take_failure(), end.is_sending()), (Some(Failure::NoFlowControl), false));
    }

    #[test]
    fn separation_and_waits_are_kept() {
        let mut end = endpoint();
        end.send(&[0; 40]).unwrap();
        end.poll(at(0)).unwrap();
        end.on_frame(at(900), &[0x31, 0, 0]);
        assert_eq!(end.poll(at(1500)), None, "a wait starts the time anew");
        end.on_frame(at(1600), &[0x30, 0, 20]);
        assert!(end.poll(at(1600)).is_some());
        assert_eq!(end.poll(at(1619)), None);
        assert!(end.poll(at(1620)).is_some());
        let mut end = endpoint();
        end.send(&[0; 40]).unwrap();
        end.poll(at(0)).unwrap();
        (0..=WAITS_MAX).for_each(|_| assert!(end.on_frame(at(1), &[0x31, 0, 0]).is_none()));
        assert_eq!(end.take_failure(), Some(Failure::Waits));
    }

    #[test]
    fn a_message_that_does_not_fit_is_refused() {
        let mut end = endpoint();
        assert_eq!(end.send(&[]), Err(SendError::Length(0)));
        assert_eq!(end.send(&[0; 65]), Err(SendError::Length(65)));
        end.send(&[1]).unwrap();
        assert_eq!(end.send(&[1]), Err(SendError::Busy));
    }
}
