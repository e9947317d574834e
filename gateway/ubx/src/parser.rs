//! The streaming parser: bytes in any portions in, messages out, faults counted, never a panic.

use crate::frame::{HEADER, Message, PAYLOAD_MAX, SYNC, TRAILER, checksum};
use crate::{NavHpPosLlh, NavPvt, NavRelPosNed};

/// What the parser met so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Messages given out.
    pub messages: u64,
    /// Frames with a right checksum of a kind not used here.
    pub other: u64,
    /// Frames of a used kind with a length or version that is not.
    pub malformed: u64,
    /// Frames whose checksum was wrong.
    pub bad_checksum: u64,
    /// Headers that asked for more than a frame can hold.
    pub oversize: u64,
    /// Bytes skipped while looking for the start of a frame.
    pub skipped_bytes: u64,
}

/// Finds UBX frames in a byte stream. After any fault it goes on one byte behind the false start, so
/// that a true frame inside a broken one is not lost.
#[derive(Clone, Debug, Default)]
pub struct Parser {
    buffer: Vec<u8>,
    /// Bytes of `buffer` that are done with; removed at the next push.
    done: usize,
    counts: Counts,
}

impl Parser {
    /// An empty parser.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Takes more of the stream; the iterator gives the messages completed by it. Messages not drawn
    /// from the iterator come with the next push.
    pub fn push(&mut self, bytes: &[u8]) -> Messages<'_> {
        self.buffer.drain(..self.done);
        self.done = 0;
        self.buffer.extend_from_slice(bytes);
        Messages { parser: self }
    }

    /// What was met so far.
    #[must_use]
    pub const fn counts(&self) -> Counts {
        self.counts
    }

    fn next_message(&mut self) -> Option<Message> {
        loop {
            self.seek_sync();
            let rest = &self.buffer[self.done..];
            let header: [u8; HEADER] = rest.get(..HEADER)?.try_into().ok()?;
            let length = usize::from(u16::from_le_bytes([header[4], header[5]]));
            if length > PAYLOAD_MAX {
                self.counts.oversize += 1;
                self.skip();
                continue;
            }
            let frame = rest.get(..HEADER + length + TRAILER)?;
            let (covered, sum) = frame[SYNC.len()..].split_at(HEADER - SYNC.len() + length);
            if sum != checksum(covered) {
                self.counts.bad_checksum += 1;
                self.skip();
                continue;
            }
            let payload = &frame[HEADER..HEADER + length];
            let decoded = decode(header[2], header[3], payload);
            self.done += HEADER + length + TRAILER;
            match decoded {
                Decoded::Message(message) => {
                    self.counts.messages += 1;
                    return Some(message);
                }
                Decoded::Malformed => self.counts.malformed += 1,
                Decoded::Other => self.counts.other += 1,
            }
        }
    }

    /// Moves to the next byte pair that starts a frame, or to what may become one.
    fn seek_sync(&mut self) {
        let rest = &self.buffer[self.done..];
        let start = (0..rest.len())
            .find(|&at| rest[at] == SYNC[0] && rest.get(at + 1).is_none_or(|&b| b == SYNC[1]))
            .unwrap_or(rest.len());
        self.done += start;
        self.counts.skipped_bytes += start as u64;
    }

    /// Past a false start.
    fn skip(&mut self) {
        self.done += 1;
        self.counts.skipped_bytes += 1;
    }
}

/// The messages that a push completed.
#[derive(Debug)]
pub struct Messages<'a> {
    parser: &'a mut Parser,
}

impl Iterator for Messages<'_> {
    type Item = Message;

    fn next(&mut self) -> Option<Message> {
        self.parser.next_message()
    }
}

enum Decoded {
    Message(Message),
    Malformed,
    Other,
}

fn decode(class: u8, id: u8, payload: &[u8]) -> Decoded {
    let message = match (class, id) {
        (NavPvt::CLASS, NavPvt::ID) => NavPvt::decode(payload).map(Message::Pvt),
        (NavHpPosLlh::CLASS, NavHpPosLlh::ID) => {
            NavHpPosLlh::decode(payload).map(Message::HpPosLlh)
        }
        (NavRelPosNed::CLASS, NavRelPosNed::ID) => {
            NavRelPosNed::decode(payload).map(Message::RelPosNed)
        }
        _ => return Decoded::Other,
    };
    message.map_or(Decoded::Malformed, Decoded::Message)
}
