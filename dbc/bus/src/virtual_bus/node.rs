//! A node on the virtual bus: its transmit queue, its receive queue and what it counts.

use std::collections::VecDeque;

use xt28_dbc::Frame;

use super::arbitration::priority;
use crate::{BusState, Received};

/// Frames a node's transmit queue holds, and its receive queue. A node that never reads, or
/// sends more than the bus carries, runs into it and counts ([`NodeCounters`]); at ten times the
/// frames of 100 ms on a saturated 1 Mbit/s bus, no node that keeps its cycle does.
pub const QUEUE_FRAMES: usize = 16_384;

/// A node of one [`super::VirtualBus`], in order of attachment.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct NodeId(pub(super) usize);

/// What a node counts since it was attached.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct NodeCounters {
    /// Frames that left completely.
    pub sent: u64,
    /// Frames put into the receive queue.
    pub received: u64,
    /// Frames refused because the transmit queue was full.
    pub transmit_overflows: u64,
    /// Frames lost because the receive queue was full.
    pub receive_overruns: u64,
}

/// A frame waiting for the bus.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pending {
    /// From when it takes part in arbitration.
    pub(super) ready_ns: u64,
    /// As the wire compares it.
    pub(super) priority: u32,
    pub(super) frame: Frame,
}

#[derive(Clone, Debug)]
pub(super) struct Node {
    pub(super) name: String,
    pub(super) state: BusState,
    pub(super) counters: NodeCounters,
    transmit: VecDeque<Pending>,
    receive: VecDeque<Received>,
}

impl Node {
    pub(super) fn new(name: &str) -> Self {
        Self {
            name: name.to_owned(),
            state: BusState::ErrorActive,
            counters: NodeCounters::default(),
            transmit: VecDeque::new(),
            receive: VecDeque::new(),
        }
    }

    /// Queues a frame behind the others.
    pub(super) fn queue(&mut self, ready_ns: u64, frame: Frame) {
        if self.transmit.len() >= QUEUE_FRAMES {
            self.counters.transmit_overflows += 1;
            return;
        }
        self.transmit.push_back(Pending { ready_ns, priority: priority(frame.id()), frame });
    }

    /// The frame that takes part in arbitration next.
    pub(super) fn head(&self) -> Option<&Pending> {
        self.transmit.front()
    }

    /// Takes the head off: it has the bus.
    pub(super) fn take_head(&mut self) -> Option<Pending> {
        self.transmit.pop_front()
    }

    pub(super) fn pending(&self) -> usize {
        self.transmit.len()
    }

    pub(super) fn deliver(&mut self, received: Received) {
        if self.receive.len() >= QUEUE_FRAMES {
            self.counters.receive_overruns += 1;
            return;
        }
        self.counters.received += 1;
        self.receive.push_back(received);
    }

    pub(super) fn take_received(&mut self) -> Option<Received> {
        self.receive.pop_front()
    }
}
