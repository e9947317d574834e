//! Messages of more than eight bytes out (SAE J1939-21, 5.10): to all by BAM, to one by RTS/CTS.
//!
//! One message at a time, as the standard demands of a sender. Nothing longer than a frame is taken
//! in: no group that we listen to is.

use core::time::Duration;

use xt28_dbc::Frame;
use xt28_machine::SimTime;

use super::id::{GLOBAL, Id, pgn};

/// Longest message: two lamp bytes and a code in each slot of the fault memory fit well.
pub(crate) const MESSAGE_MAX: usize = 400;
const IN_PACKET: usize = 7;
/// Between two packets of a broadcast: 50 to 200 ms are allowed on the wire, so a task period more
/// than the least, for the first of two may be held up by a busy bus.
const BROADCAST_GAP: Duration = Duration::from_millis(60);
/// After a request to send, or the last packet asked for (T3).
const ANSWER_TIMEOUT: Duration = Duration::from_millis(1250);
/// After the peer said to hold on (T4).
const HOLD_TIMEOUT: Duration = Duration::from_millis(1050);

const RTS: u8 = 0x10;
const CTS: u8 = 0x11;
const END: u8 = 0x13;
const BAM: u8 = 0x20;
const ABORT: u8 = 0xFF;
const ABORT_NO_RESOURCES: u8 = 2;
const ABORT_TIMEOUT: u8 = 3;
const ABORT_CTS_WHILE_SENDING: u8 = 4;

/// The sending side.
#[derive(Clone, Debug)]
pub(crate) struct Transport {
    buffer: [u8; MESSAGE_MAX],
    length: usize,
    pgn: u32,
    to: u8,
    state: State,
    /// An abort that is to leave: to whom, of which group, why.
    abort: Option<(u8, u32, u8)>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum State {
    Idle,
    /// The announcement is to leave.
    Announce,
    /// Packet `next` (from 1) of a broadcast leaves at `due`.
    Broadcast {
        next: u8,
        due: SimTime,
    },
    /// Waits for the peer until then.
    Waits {
        until: SimTime,
    },
    /// Packets `next` to `last` may leave.
    Sends {
        next: u8,
        last: u8,
    },
}

impl Transport {
    pub(crate) const fn new() -> Self {
        let buffer = [0; MESSAGE_MAX];
        Self { buffer, length: 0, pgn: 0, to: GLOBAL, state: State::Idle, abort: None }
    }

    pub(crate) fn is_idle(&self) -> bool {
        self.state == State::Idle
    }

    /// Begins a message of 9 to 400 bytes to `to`; an idle transport only.
    pub(crate) fn start(&mut self, pgn: u32, to: u8, message: &[u8]) {
        debug_assert!(self.is_idle() && message.len() > 8);
        self.length = message.len().min(MESSAGE_MAX);
        self.buffer[..self.length].copy_from_slice(&message[..self.length]);
        (self.pgn, self.to, self.state) = (pgn, to, State::Announce);
    }

    /// The peer's word on connection management.
    pub(crate) fn on_control(&mut self, now: SimTime, from: u8, data: &[u8]) {
        let &[control, a, b, _, _, p, q, r] = data else { return };
        let of = u32::from_le_bytes([p, q, r, 0]);
        if control == RTS {
            self.abort = Some((from, of, ABORT_NO_RESOURCES));
            return;
        }
        if from != self.to || of != self.pgn || matches!(self.state, State::Idle | State::Announce)
        {
            return;
        }
        let packets = self.packets();
        match (control, self.state) {
            (CTS, State::Waits { .. }) if a == 0 => {
                self.state = State::Waits { until: now + HOLD_TIMEOUT };
            }
            (CTS, State::Waits { .. }) if (1..=packets).contains(&b) => {
                let last = b.saturating_add(a - 1).min(packets);
                self.state = State::Sends { next: b, last };
            }
            (CTS, State::Sends { .. }) => {
                self.abort = Some((from, of, ABORT_CTS_WHILE_SENDING));
                self.state = State::Idle;
            }
            (END | ABORT, _) => self.state = State::Idle,
            _ => {}
        }
    }

    /// The frame that is to leave at `now` from address `from`.
    pub(crate) fn poll(&mut self, now: SimTime, from: u8) -> Option<Frame> {
        if let State::Waits { until } = self.state
            && now > until
        {
            self.abort = Some((self.to, self.pgn, ABORT_TIMEOUT));
            self.state = State::Idle;
        }
        if let Some((to, of, why)) = self.abort.take() {
            return control(from, to, [ABORT, why, 0xFF, 0xFF, 0xFF], of);
        }
        let packets = self.packets();
        match self.state {
            State::Announce => {
                #[allow(clippy::cast_possible_truncation)] // at most 400
                let [low, high] = (self.length as u16).to_le_bytes();
                let kind = if self.to == GLOBAL {
                    self.state = State::Broadcast { next: 1, due: now + BROADCAST_GAP };
                    BAM
                } else {
                    self.state = State::Waits { until: now + ANSWER_TIMEOUT };
                    RTS
                };
                control(from, self.to, [kind, low, high, packets, 0xFF], self.pgn)
            }
            State::Broadcast { next, due } if now >= due => {
                self.state = if next == packets {
                    State::Idle
                } else {
                    State::Broadcast { next: next + 1, due: now + BROADCAST_GAP }
                };
                self.packet(from, next)
            }
            State::Sends { next, last } => {
                self.state = if next == last {
                    State::Waits { until: now + ANSWER_TIMEOUT }
                } else {
                    State::Sends { next: next + 1, last }
                };
                self.packet(from, next)
            }
            State::Idle | State::Broadcast { .. } | State::Waits { .. } => None,
        }
    }

    #[allow(clippy::cast_possible_truncation)] // 400 bytes are 58 packets
    const fn packets(&self) -> u8 {
        self.length.div_ceil(IN_PACKET) as u8
    }

    /// Packet `number`, from 1; what is missing of the last one is FF.
    fn packet(&self, from: u8, number: u8) -> Option<Frame> {
        let begin = IN_PACKET * usize::from(number - 1);
        let part = &self.buffer[begin..self.length.min(begin + IN_PACKET)];
        let mut data = [0xFF; 8];
        data[0] = number;
        data[1..=part.len()].copy_from_slice(part);
        let id = Id { priority: 7, pgn: pgn::TRANSPORT_DATA, to: self.to, from };
        Frame::new(id.can(), &data)
    }
}

fn control(from: u8, to: u8, head: [u8; 5], of: u32) -> Option<Frame> {
    let [p, q, r, _] = of.to_le_bytes();
    let [a, b, c, d, e] = head;
    let id = Id { priority: 7, pgn: pgn::TRANSPORT_CONTROL, to, from };
    Frame::new(id.can(), &[a, b, c, d, e, p, q, r])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(ms: u64) -> SimTime {
        SimTime::from_millis(ms)
    }

    fn text(frame: Option<Frame>) -> String {
        frame.map_or_else(|| "nothing".to_owned(), |frame| format!("{frame:?}"))
    }

    #[test]
    fn a_broadcast_keeps_its_pace() {
        let mut transport = Transport::new();
        transport.start(pgn::DM1, GLOBAL, &[1, 2, 3, 4, 5, 6, 7, 8, 9, 10]);
        assert_eq!(text(transport.poll(at(0), 0x28)), "1CECFF28#200A0002FFCAFE00");
        assert_eq!(text(transport.poll(at(59), 0x28)), "nothing");
        assert_eq!(text(transport.poll(at(60), 0x28)), "1CEBFF28#0101020304050607");
        assert_eq!(text(transport.poll(at(119), 0x28)), "nothing");
        assert_eq!(text(transport.poll(at(120), 0x28)), "1CEBFF28#0208090AFFFFFFFF");
        assert!(transport.is_idle());
    }

    #[test]
    fn a_connection_sends_what_its_peer_asks_for() {
        let mut transport = Transport::new();
        transport.start(pgn::DM2, 0xF9, &(1..=20).collect::<Vec<_>>());
        assert_eq!(text(transport.poll(at(0), 0x28)), "1CECF928#10140003FFCBFE00");
        assert_eq!(text(transport.poll(at(10), 0x28)), "nothing");
        transport.on_control(at(20), 0xF9, &[CTS, 0, 0xFF, 0xFF, 0xFF, 0xCB, 0xFE, 0]);
        transport.on_control(at(900), 0xF9, &[CTS, 2, 1, 0xFF, 0xFF, 0xCB, 0xFE, 0]);
        assert_eq!(text(transport.poll(at(900), 0x28)), "1CEBF928#0101020304050607");
        assert_eq!(text(transport.poll(at(900), 0x28)), "1CEBF928#0208090A0B0C0D0E");
        assert_eq!(text(transport.poll(at(900), 0x28)), "nothing");
        transport.on_control(at(910), 0xF9, &[CTS, 9, 3, 0xFF, 0xFF, 0xCB, 0xFE, 0]);
        assert_eq!(text(transport.poll(at(910), 0x28)), "1CEBF928#030F1011121314FF");
        transport.on_control(at(920), 0xF9, &[END, 20, 0, 3, 0xFF, 0xCB, 0xFE, 0]);
        assert!(transport.is_idle());
    }

    #[test]
    fn a_silent_peer_is_told_and_left() {
        let mut transport = Transport::new();
        transport.start(pgn::DM2, 0xF9, &[0; 20]);
        transport.poll(at(0), 0x28);
        assert_eq!(text(transport.poll(at(1250), 0x28)), "nothing");
        assert_eq!(text(transport.poll(at(1251), 0x28)), "1CECF928#FF03FFFFFFCBFE00");
        assert!(transport.is_idle());
    }

    /// T4: a peer that said to hold on is waited for a little less long than one that said nothing.
    #[test]
    fn a_peer_that_never_goes_on_is_told_and_left() {
        let mut transport = Transport::new();
        transport.start(pgn::DM2, 0xF9, &[0; 20]);
        transport.poll(at(0), 0x28);
        transport.on_control(at(1000), 0xF9, &[CTS, 0, 0xFF, 0xFF, 0xFF, 0xCB, 0xFE, 0]);
        assert_eq!(text(transport.poll(at(2050), 0x28)), "nothing");
        assert_eq!(text(transport.poll(at(2051), 0x28)), "1CECF928#FF03FFFFFFCBFE00");
        assert!(transport.is_idle());
    }

    #[test]
    fn a_long_message_to_us_is_refused() {
        let mut transport = Transport::new();
        transport.on_control(at(0), 0xF9, &[RTS, 20, 0, 3, 0xFF, 0xCB, 0xFE, 0]);
        assert_eq!(text(transport.poll(at(0), 0x28)), "1CECF928#FF02FFFFFFCBFE00");
    }
}
