//! A node on a J1939 network: its address, its trouble codes, and the answers it owes.

mod address_claim;
pub(crate) mod id;
pub mod name;
mod transport;
mod trouble_message;

use core::time::Duration;

use xt28_dbc::{Frame, Outbox};
use xt28_machine::SimTime;

use self::address_claim::AddressClaim;
use self::id::{GLOBAL, Id, pgn};
use self::name::Name;
use self::transport::Transport;
use self::trouble_message::TroubleMessage;
use super::fault_memory::{Entry, FaultMemory};

/// DM1 comes at least this often.
pub const DM1_PERIOD: Duration = Duration::from_secs(1);
/// Answers that wait for the transport.
const WAITING_MAX: usize = 4;

/// One of our two nodes.
#[derive(Clone, Debug)]
pub(crate) struct Node {
    claim: AddressClaim,
    transport: Transport,
    dm1_due: SimTime,
    /// Requests not answered yet: who asked, to whom (us or all), for what.
    requests: [Option<Request>; WAITING_MAX],
}

#[derive(Clone, Copy, Debug)]
struct Request {
    pgn: u32,
    from: u8,
    to: u8,
}

/// Answers to a request that is not answered with the group itself.
#[derive(Clone, Copy, Debug)]
enum Acknowledgement {
    Positive = 0,
    Negative = 1,
}

impl Node {
    /// A node just switched on.
    pub(crate) const fn new(name: &Name, address: u8) -> Self {
        Self {
            claim: AddressClaim::new(name, address),
            transport: Transport::new(),
            dm1_due: SimTime::ZERO,
            requests: [None; WAITING_MAX],
        }
    }

    /// The node's address, while it has one.
    pub(crate) const fn address(&self) -> Option<u8> {
        self.claim.address()
    }

    /// A frame from the network.
    pub(crate) fn on_frame(&mut self, now: SimTime, id: Id, data: &[u8]) {
        let ours = id.to == GLOBAL || Some(id.to) == self.address();
        match id.pgn {
            pgn::ADDRESS_CLAIMED => {
                if let Ok(name) = data.try_into() {
                    self.claim.on_claim(now, id.from, name);
                }
            }
            // A node without an address still answers who it is.
            pgn::REQUEST if ours => {
                let &[a, b, c, ..] = data else { return };
                self.on_request(now, u32::from_le_bytes([a, b, c, 0]), id);
            }
            pgn::TRANSPORT_CONTROL if ours && id.to != GLOBAL => {
                self.transport.on_control(now, id.from, data);
            }
            _ => {}
        }
    }

    fn on_request(&mut self, now: SimTime, pgn: u32, id: Id) {
        if pgn == pgn::ADDRESS_CLAIMED {
            self.claim.on_request(now);
            return;
        }
        // A full list forgets the newest: its sender asks again.
        if let Some(slot) = self.requests.iter_mut().find(|slot| slot.is_none()) {
            *slot = Some(Request { pgn, from: id.from, to: id.to });
        }
    }

    /// Puts what is to leave at `now` into `out`.
    pub(crate) fn tick(&mut self, now: SimTime, memory: &mut FaultMemory, out: &mut Outbox) {
        if let Some(frame) = self.claim.poll(now) {
            out.push(frame);
        }
        let Some(address) = self.address() else {
            self.requests = [None; WAITING_MAX];
            return;
        };
        if let Some(frame) = self.transport.poll(now, address) {
            out.push(frame);
        }
        for slot in 0..WAITING_MAX {
            let Some(request) = self.requests[slot] else { continue };
            if self.answer(request, address, memory, out) {
                self.requests[slot] = None;
            }
        }
        // News that come while the transport is busy are told once it is free.
        if self.transport.is_idle() && (memory.take_news(now) || now >= self.dm1_due) {
            self.dm1_due = now + DM1_PERIOD;
            let mut dm1 = TroubleMessage::new(active(memory), active(memory));
            self.say(pgn::DM1, GLOBAL, dm1.bytes(), address, out);
        }
    }

    /// False while the answer has to wait.
    fn answer(
        &mut self,
        request: Request,
        address: u8,
        memory: &mut FaultMemory,
        out: &mut Outbox,
    ) -> bool {
        let Request { pgn, from, to } = request;
        // To a question to all, all answer to all, and none says no (J1939-21, 5.4.2).
        let (reader, alone) = if to == GLOBAL { (GLOBAL, false) } else { (from, true) };
        let said = match pgn {
            pgn::DM1 | pgn::DM2 if !self.transport.is_idle() => return false,
            pgn::DM1 => {
                let mut dm1 = TroubleMessage::new(active(memory), active(memory));
                self.say(pgn, reader, dm1.bytes(), address, out);
                return true;
            }
            pgn::DM2 => {
                let before = memory.entries().filter(Entry::was_active);
                let mut dm2 = TroubleMessage::new(active(memory), before);
                self.say(pgn, reader, dm2.bytes(), address, out);
                return true;
            }
            pgn::DM3 => {
                memory.clear(Entry::was_active);
                Acknowledgement::Positive
            }
            pgn::DM11 => {
                memory.clear(Entry::is_active);
                Acknowledgement::Positive
            }
            _ => Acknowledgement::Negative,
        };
        if alone {
            out.push(acknowledge(said, pgn, from, address));
        }
        true
    }

    /// A message to `to`: a frame, or the transport's business.
    fn say(&mut self, pgn: u32, to: u8, message: &[u8], address: u8, out: &mut Outbox) {
        if message.len() > 8 {
            self.transport.start(pgn, to, message);
        } else {
            let id = Id { priority: 6, pgn, to: GLOBAL, from: address };
            if let Some(frame) = Frame::new(id.can(), message) {
                out.push(frame);
            }
        }
    }
}

/// The codes that fail now.
fn active(memory: &FaultMemory) -> impl Iterator<Item = Entry> {
    memory.entries().filter(Entry::is_active)
}

/// J1939-21, 5.4.4: to all, with the one meant in byte 4.
fn acknowledge(said: Acknowledgement, pgn: u32, to: u8, from: u8) -> Frame {
    let [a, b, c, _] = pgn.to_le_bytes();
    let id = Id { priority: 6, pgn: pgn::ACKNOWLEDGEMENT, to: GLOBAL, from };
    let data = [said as u8, 0xFF, 0xFF, 0xFF, to, a, b, c];
    Frame::new(id.can(), &data).expect("eight bytes")
}
