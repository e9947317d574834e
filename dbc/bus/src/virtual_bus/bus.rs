//! The bus itself: arbitration, transmission and delivery as simulated time advances.

use core::time::Duration;
use std::collections::BTreeMap;

use xt28_dbc::{CanId, Frame};
use xt28_machine::SimTime;

use super::load::LoadMeter;
use super::node::{Node, NodeCounters, NodeId};
use super::wire_bits::{INTERMISSION_BITS, frame_bits};
use super::{Bitrate, Port};
use crate::{BusState, Received};

/// The load window unless set otherwise.
const LOAD_WINDOW: Duration = Duration::from_millis(100);

/// A bus and its nodes in simulated time. See the [module](super) for what is modelled.
///
/// ```
/// use xt28_bus::{Bitrate, VirtualBus};
/// use xt28_dbc::{CanId, Frame};
/// use xt28_machine::SimTime;
///
/// let mut bus = VirtualBus::new(Bitrate::MBIT_1);
/// let (gateway, sms) = (bus.attach("gateway"), bus.attach("sms"));
/// let frame = Frame::new(CanId::Standard(0), &[]).unwrap();
/// bus.send(gateway, SimTime::ZERO, &frame);
/// bus.advance(SimTime::from_millis(10));
/// assert_eq!(bus.receive(sms).unwrap().at, SimTime::from_micros(50)); // 50 bits, 6 of them stuffed
/// assert_eq!(bus.receive(gateway), None);
/// ```
#[derive(Clone, Debug)]
pub struct VirtualBus {
    bitrate: Bitrate,
    now_ns: u64,
    /// When the last frame's intermission is over.
    idle_from_ns: u64,
    on_wire: Option<OnWire>,
    nodes: Vec<Node>,
    load: LoadMeter,
    tap: Option<Vec<Sent>>,
    collisions: BTreeMap<CanId, Collision>,
}

/// A frame that has won arbitration and is not complete yet.
#[derive(Clone, Copy, Debug)]
struct OnWire {
    node: NodeId,
    frame: Frame,
    end_ns: u64,
}

/// A frame that was on the bus.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sent {
    /// The last bit of its end-of-frame.
    pub at: SimTime,
    /// Who sent it.
    pub node: NodeId,
    /// The frame.
    pub frame: Frame,
}

/// Two nodes arbitrated with the same identifier: on a real bus one disturbs the other, and
/// both count errors. An identifier belongs to one node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Collision {
    /// The identifier both sent.
    pub id: CanId,
    /// The first two nodes seen to do so, in order of attachment.
    pub nodes: (NodeId, NodeId),
    /// When it was first seen.
    pub first_at: SimTime,
    /// How often.
    pub count: u64,
}

impl VirtualBus {
    /// A bus without nodes, at time zero.
    #[must_use]
    pub fn new(bitrate: Bitrate) -> Self {
        Self {
            bitrate,
            now_ns: 0,
            idle_from_ns: 0,
            on_wire: None,
            nodes: Vec::new(),
            load: LoadMeter::new(nanos(LOAD_WINDOW)),
            tap: None,
            collisions: BTreeMap::new(),
        }
    }

    /// Sets the window of [`VirtualBus::load_window`]; 100 ms unless set. Set it before the run.
    #[must_use]
    pub fn with_load_window(mut self, window: Duration) -> Self {
        self.load = LoadMeter::new(nanos(window));
        self
    }

    /// Adds a node. Nodes attached earlier go first where nothing else decides.
    pub fn attach(&mut self, name: &str) -> NodeId {
        self.nodes.push(Node::new(name));
        NodeId(self.nodes.len() - 1)
    }

    /// A node's view of the bus, for code that takes any [`crate::Bus`].
    ///
    /// # Panics
    /// The node is of another bus.
    pub fn port(&mut self, node: NodeId) -> Port<'_> {
        assert!(node.0 < self.nodes.len(), "{node:?} is not attached to this bus");
        Port::new(self, node)
    }

    /// Queues a frame that takes part in arbitration from `now` on; where the bus is past `now`,
    /// from the bus's time on. A node's frames leave in the order queued.
    ///
    /// # Panics
    /// The node is of another bus.
    pub fn send(&mut self, node: NodeId, now: SimTime, frame: &Frame) {
        let ready_ns = now.as_nanos().max(self.now_ns);
        self.nodes[node.0].queue(ready_ns, *frame);
    }

    /// The oldest frame the node has not taken.
    ///
    /// # Panics
    /// The node is of another bus.
    pub fn receive(&mut self, node: NodeId) -> Option<Received> {
        self.nodes[node.0].take_received()
    }

    /// Lets time pass until `to`: frames whose end-of-frame is at or before `to` are delivered.
    ///
    /// Arbitration *at* `to` is left to the next call, so all nodes may still send at that
    /// instant, in any order, and the wire alone decides. Going back does nothing.
    pub fn advance(&mut self, to: SimTime) {
        let to_ns = to.as_nanos();
        loop {
            self.complete(to_ns);
            if self.on_wire.is_some() || !self.arbitrate(to_ns) {
                break;
            }
        }
        self.now_ns = self.now_ns.max(to_ns);
    }

    /// Delivers the frame on the wire if it ends at or before `to_ns`.
    fn complete(&mut self, to_ns: u64) {
        let Some(OnWire { node, frame, end_ns }) = self.on_wire else {
            return;
        };
        if end_ns > to_ns {
            return;
        }
        self.on_wire = None;
        let at = SimTime::from_nanos(end_ns);
        for (index, receiver) in self.nodes.iter_mut().enumerate() {
            if index == node.0 {
                receiver.counters.sent += 1;
            } else {
                receiver.deliver(Received { at, frame });
            }
        }
        if let Some(tap) = &mut self.tap {
            tap.push(Sent { at, node, frame });
        }
    }

    /// Gives the idle bus to the winner of the first arbitration before `to_ns`; false if
    /// there is none.
    fn arbitrate(&mut self, to_ns: u64) -> bool {
        let heads = || self.nodes.iter().enumerate().filter_map(|(i, n)| Some((i, n.head()?)));
        let Some(first_ready_ns) = heads().map(|(_, head)| head.ready_ns).min() else {
            return false;
        };
        let start_ns = first_ready_ns.max(self.idle_from_ns);
        if start_ns >= to_ns {
            return false;
        }
        let mut contenders = heads().filter(|(_, head)| head.ready_ns <= start_ns);
        let Some(mut winner) = contenders.next() else {
            return false;
        };
        let mut rival = None;
        for contender in contenders {
            match contender.1.priority.cmp(&winner.1.priority) {
                core::cmp::Ordering::Less => (winner, rival) = (contender, None),
                core::cmp::Ordering::Equal => rival = rival.or(Some(contender.0)),
                core::cmp::Ordering::Greater => {}
            }
        }
        let (winner, rival) = (NodeId(winner.0), rival.map(NodeId));
        self.begin(winner, rival, start_ns)
    }

    /// Puts the winner's frame on the wire.
    fn begin(&mut self, node: NodeId, rival: Option<NodeId>, start_ns: u64) -> bool {
        let Some(pending) = self.nodes[node.0].take_head() else {
            return false;
        };
        let frame = pending.frame;
        if let Some(rival) = rival {
            let id = frame.id();
            let first_at = SimTime::from_nanos(start_ns);
            self.collisions
                .entry(id)
                .or_insert(Collision { id, nodes: (node, rival), first_at, count: 0 })
                .count += 1;
        }
        let bits = frame_bits(&frame);
        let end_ns = start_ns + self.bitrate.nanos(bits);
        self.idle_from_ns = end_ns + self.bitrate.nanos(INTERMISSION_BITS);
        self.load.take(start_ns, self.idle_from_ns);
        self.on_wire = Some(OnWire { node, frame, end_ns });
        true
    }

    /// Keeps every frame sent from here on for [`VirtualBus::drain_tap`].
    pub fn enable_tap(&mut self) {
        self.tap.get_or_insert_default();
    }

    /// The frames sent since the last call, in bus order; none unless the tap is enabled.
    pub fn drain_tap(&mut self) -> impl Iterator<Item = Sent> + '_ {
        self.tap.iter_mut().flat_map(|tap| tap.drain(..))
    }

    /// How far time has passed.
    #[must_use]
    pub fn now(&self) -> SimTime {
        SimTime::from_nanos(self.now_ns)
    }

    /// The bit rate.
    #[must_use]
    pub fn bitrate(&self) -> Bitrate {
        self.bitrate
    }

    /// Share of the time since zero that the bus was taken, intermission included, 0 to 1.
    #[must_use]
    pub fn load_total(&self) -> f64 {
        self.load.total(self.now_ns)
    }

    /// Share of the last load window that the bus was taken, intermission included, 0 to 1.
    #[must_use]
    pub fn load_window(&self) -> f64 {
        self.load.window(self.now_ns)
    }

    /// Identifiers that two nodes sent at once, by identifier.
    pub fn collisions(&self) -> impl Iterator<Item = &Collision> {
        self.collisions.values()
    }

    /// What the node was called when attached.
    ///
    /// # Panics
    /// The node is of another bus.
    #[must_use]
    pub fn name(&self, node: NodeId) -> &str {
        &self.nodes[node.0].name
    }

    /// The node's error state.
    ///
    /// # Panics
    /// The node is of another bus.
    #[must_use]
    pub fn state(&self, node: NodeId) -> BusState {
        self.nodes[node.0].state
    }

    /// What the node has counted.
    ///
    /// # Panics
    /// The node is of another bus.
    #[must_use]
    pub fn counters(&self, node: NodeId) -> NodeCounters {
        self.nodes[node.0].counters
    }

    /// Frames the node has queued that are not on the wire yet.
    ///
    /// # Panics
    /// The node is of another bus.
    #[must_use]
    pub fn pending(&self, node: NodeId) -> usize {
        self.nodes[node.0].pending()
    }
}

impl Default for VirtualBus {
    fn default() -> Self {
        Self::new(Bitrate::default())
    }
}

/// A duration in nanoseconds; 584 years and more count as that.
fn nanos(duration: Duration) -> u64 {
    u64::try_from(duration.as_nanos()).unwrap_or(u64::MAX)
}
