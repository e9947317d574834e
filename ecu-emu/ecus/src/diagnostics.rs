//! What a service tool talks to: J1939 (address claim, DM1, DM2, DM3, DM11) and UDS over ISO-TP.
//!
//! Each ECU holds one [`fault_memory::FaultMemory`], filled by its monitor and read by both
//! protocols. Everything is on `CAN_1`. `docs/diagnostics.md` has the tables.

mod arm_monitor;
mod arm_readings;
mod drive_monitor;
mod drive_readings;
pub mod fault_memory;
pub mod isotp;
pub mod j1939;
pub mod parts;
mod stall_check;
pub mod trouble_code;
pub mod uds;

use core::time::Duration;

use xt28_dbc::{Frame, Outbox};
use xt28_machine::SimTime;

pub(crate) use self::arm_monitor::{ArmMonitor, ArmSeen};
pub(crate) use self::arm_readings::ArmData;
pub(crate) use self::drive_monitor::{DriveMonitor, DriveSeen};
pub(crate) use self::drive_readings::DriveData;
use self::fault_memory::FaultMemory;
use self::isotp::{Endpoint, FlowLimits};
use self::j1939::Node;
use self::j1939::id::{Id, pgn};
use self::j1939::name::{self, Name};
use self::trouble_code::Part;
use self::uds::{Addressing, Identity, REPLY_MAX, Readings, Reply, Server};

/// Source address of the pendulum-arm ECU, as its status frame has it.
pub const ARM_ADDRESS: u8 = 0x28;
/// Source address of the transmission and steering ECU.
pub const DRIVE_ADDRESS: u8 = 0x29;
/// Target address of UDS requests to all ECUs (ISO 15765-2, normal fixed addressing).
pub const FUNCTIONAL_ADDRESS: u8 = 0x33;
/// What the ECUs ask of a tester that sends them more than a frame.
pub const FLOW_LIMITS: FlowLimits =
    FlowLimits { block_size: 8, separation: Duration::from_millis(1) };
/// So long after its start an ECU has heard from all who speak to it, or they are away (assumed).
const STREAMS_DUE: Duration = Duration::from_millis(500);
/// Longest request, bytes: eight identifiers, and room.
const REQUEST_MAX: usize = 64;
/// A tester's word that it is still there, and wants no answer: taken also while one is under way.
const STILL_THERE: [u8; 2] = [0x3E, 0x80];
/// ISO-TP frames that may leave in one task period, so that a long response leaves room for others.
const FRAMES_PER_TICK: usize = 8;

/// What of an ECU is its own.
pub(crate) struct Member {
    name: &'static Name,
    address: u8,
    parts: &'static [Part],
    identity: Identity,
}

/// The pendulum-arm ECU.
pub(crate) const ARM: Member = Member {
    name: &name::ARM,
    address: ARM_ADDRESS,
    parts: parts::ARM,
    identity: Identity { name: "SMS pendulum arms", serial: "028001" },
};

/// The transmission and steering ECU.
pub(crate) const DRIVE: Member = Member {
    name: &name::DRIVE,
    address: DRIVE_ADDRESS,
    parts: parts::DRIVE,
    identity: Identity { name: "DMS transmission and steering", serial: "028002" },
};

/// All of one ECU's diagnostics.
#[derive(Clone, Debug)]
pub(crate) struct Diagnostics<R> {
    memory: FaultMemory,
    node: Node,
    server: Server,
    endpoint: Endpoint<REQUEST_MAX, REPLY_MAX>,
    reply: Reply,
    /// Who is talked to.
    tester: u8,
    /// As of the last task period.
    readings: R,
}

impl<R: Readings + Default> Diagnostics<R> {
    /// Of an ECU just switched on, with an empty memory.
    pub(crate) fn new(member: &Member) -> Self {
        Self::with_memory(member, FaultMemory::new(member.parts))
    }

    /// Of an ECU that starts again: the memory lasts.
    pub(crate) fn restart(self, member: &Member) -> Self {
        let mut memory = self.memory;
        memory.begin_cycle();
        Self::with_memory(member, memory)
    }

    fn with_memory(member: &Member, memory: FaultMemory) -> Self {
        Self {
            memory,
            node: Node::new(member.name, member.address),
            server: Server::new(member.identity),
            endpoint: Endpoint::new(FLOW_LIMITS),
            reply: Reply::new(),
            tester: 0,
            readings: R::default(),
        }
    }

    /// For the monitors to report to.
    pub(crate) const fn memory(&mut self) -> &mut FaultMemory {
        &mut self.memory
    }

    /// A frame from `CAN_1`. Those of no diagnostic group are left alone.
    pub(crate) fn on_frame(&mut self, now: SimTime, frame: &Frame) {
        let Some(id) = Id::of(frame.id()) else { return };
        let address = self.node.address();
        match id.pgn {
            pgn::UDS_PHYSICAL if Some(id.to) == address => {
                // One tester at a time: an answer under way is not for another.
                if self.endpoint.is_sending() && id.from != self.tester {
                    return;
                }
                self.tester = id.from;
                self.on_physical(now, frame.data());
            }
            pgn::UDS_FUNCTIONAL if id.to == FUNCTIONAL_ADDRESS && address.is_some() => {
                self.on_functional(now, id.from, frame.data());
            }
            _ => self.node.on_frame(now, id, frame.data()),
        }
    }

    fn on_physical(&mut self, now: SimTime, data: &[u8]) {
        let busy = self.endpoint.is_sending();
        let taken = |request: &&[u8]| !busy || **request == STILL_THERE;
        let Some(request) = self.endpoint.on_frame(now, data).filter(taken) else { return };
        let known = (&self.readings, &mut self.memory);
        self.server.respond(now, request, Addressing::Physical, known, &mut self.reply);
        self.answer();
    }

    /// A request to all is a single frame (ISO 14229-2).
    fn on_functional(&mut self, now: SimTime, from: u8, data: &[u8]) {
        let Some((&length @ 1..=7, rest)) = data.split_first() else { return };
        let Some(request) = rest.get(..usize::from(length)) else { return };
        if self.endpoint.is_sending() && request != STILL_THERE {
            return;
        }
        let known = (&self.readings, &mut self.memory);
        self.server.respond(now, request, Addressing::Functional, known, &mut self.reply);
        if !self.reply.bytes().is_empty() {
            self.tester = from;
        }
        self.answer();
    }

    fn answer(&mut self) {
        // No bytes are no answer; the endpoint is idle, or the request was not taken.
        let _ = self.endpoint.send(self.reply.bytes());
    }

    /// One task period: `readings` are what may be asked for until the next.
    pub(crate) fn tick(&mut self, now: SimTime, readings: R, out: &mut Outbox) {
        self.readings = readings;
        if self.endpoint.is_sending() {
            self.server.keep_up(now);
        }
        self.server.tick(now);
        self.node.tick(now, &mut self.memory, out);
        let Some(from) = self.node.address() else { return };
        let id = Id { priority: 6, pgn: pgn::UDS_PHYSICAL, to: self.tester, from };
        for _ in 0..FRAMES_PER_TICK {
            let Some(data) = self.endpoint.poll(now) else { break };
            out.push(Frame::new(id.can(), &data).expect("eight bytes"));
        }
    }
}
