//! The bus against a naive model: who goes when, who hears what, and that the steps in which
//! time passes change nothing.

use proptest::prelude::*;
use xt28_bus::virtual_bus::Sent;
use xt28_bus::virtual_bus::wire_bits::frame_bits;
use xt28_bus::{Bitrate, NodeId, Received, VirtualBus};
use xt28_dbc::{CanId, Frame};
use xt28_machine::SimTime;

const BIT_NS: u64 = 1_000;
const NODES: usize = 3;

/// A node sends a frame.
#[derive(Clone, Debug)]
struct Send {
    node: usize,
    at_ns: u64,
    frame: Frame,
}

/// The arbitration field as levels on the wire: lexicographic order is the wire's.
fn arbitration_field(id: CanId) -> Vec<bool> {
    let bits = |value: u32, n: u32| (0..n).rev().map(move |bit| value & (1 << bit) != 0);
    match id {
        // Identifier, RTR, IDE.
        CanId::Standard(id) => bits(id.into(), 11).chain(bits(0b00, 2)).collect(),
        // First eleven bits, SRR, IDE, the other eighteen, RTR.
        CanId::Extended(id) => bits(id >> 18, 11)
            .chain(bits(0b11, 2))
            .chain(bits(id & 0x3_FFFF, 18))
            .chain(bits(0, 1))
            .collect(),
    }
}

/// Start, end and send of every frame, by going through all of them every time.
fn naive(sends: &[Send]) -> Vec<(u64, u64, Send)> {
    let mut queues: Vec<Vec<Send>> = (0..NODES)
        .map(|node| sends.iter().filter(|send| send.node == node).cloned().collect())
        .collect();
    let mut idle_from = 0;
    let mut order = Vec::new();
    while let Some(first) = queues.iter().filter_map(|q| Some(q.first()?.at_ns)).min() {
        let start = first.max(idle_from);
        let winner = queues
            .iter()
            .filter_map(|queue| queue.first())
            .filter(|send| send.at_ns <= start)
            .min_by_key(|send| arbitration_field(send.frame.id()))
            .unwrap()
            .clone();
        let end = start + u64::from(frame_bits(&winner.frame)) * BIT_NS;
        idle_from = end + 3 * BIT_NS;
        queues[winner.node].remove(0);
        order.push((start, end, winner));
    }
    order
}

/// What a run left behind.
struct Run {
    bus: VirtualBus,
    nodes: Vec<NodeId>,
    sent: Vec<Sent>,
    heard: Vec<Vec<Received>>,
}

/// Sends everything at its time, while time passes in steps to `stops`.
fn run(sends: &[Send], stops: &[u64]) -> Run {
    let mut bus = VirtualBus::new(Bitrate::MBIT_1);
    let nodes: Vec<NodeId> = (0..NODES).map(|node| bus.attach(&format!("node {node}"))).collect();
    bus.enable_tap();
    let mut waiting = sends.iter().peekable();
    let mut sent = Vec::new();
    for &stop in stops {
        while let Some(send) = waiting.next_if(|send| send.at_ns <= stop) {
            bus.send(nodes[send.node], SimTime::from_nanos(send.at_ns), &send.frame);
        }
        bus.advance(SimTime::from_nanos(stop));
        sent.extend(bus.drain_tap());
    }
    assert!(waiting.next().is_none());
    let heard =
        nodes.iter().map(|&node| std::iter::from_fn(|| bus.receive(node)).collect()).collect();
    Run { bus, nodes, sent, heard }
}

const END_NS: u64 = 100_000_000;

fn any_sends() -> impl Strategy<Value = Vec<Send>> {
    // Few bases and both formats, so that ties up to the last bit are frequent.
    let id = (0..4_u16, any::<bool>(), 0..3_u32).prop_map(|(base, extended, rest)| {
        if extended { CanId::Extended(u32::from(base) << 18 | rest) } else { CanId::Standard(base) }
    });
    let send = (0..NODES, 0..3_000_u64, id, proptest::collection::vec(any::<u8>(), 0..=8))
        .prop_map(|(node, at_us, id, data)| Send {
            node,
            at_ns: at_us * 1_000,
            frame: Frame::new(id, &data).unwrap(),
        });
    proptest::collection::vec(send, 0..40).prop_map(|mut sends| {
        sends.sort_by_key(|send| send.at_ns);
        sends
    })
}

proptest! {
    #[test]
    fn frames_go_as_the_wire_decides(sends in any_sends()) {
        let Run { bus, nodes, sent, heard } = run(&sends, &[END_NS]);
        let expected: Vec<Sent> = naive(&sends)
            .into_iter()
            .map(|(_, end, send)| Sent {
                at: SimTime::from_nanos(end),
                node: nodes[send.node],
                frame: send.frame,
            })
            .collect();
        prop_assert_eq!(&sent, &expected);
        for (node, heard) in heard.iter().enumerate() {
            let others: Vec<Received> = naive(&sends)
                .into_iter()
                .filter(|(_, _, send)| send.node != node)
                .map(|(_, end, send)| Received { at: SimTime::from_nanos(end), frame: send.frame })
                .collect();
            prop_assert_eq!(heard, &others);
        }
        let busy: u64 = naive(&sends).iter().map(|(start, end, _)| end + 3 * BIT_NS - start).sum();
        prop_assert_eq!(bus.load_total(), busy as f64 / END_NS as f64);
    }

    #[test]
    fn the_steps_of_time_change_nothing(
        sends in any_sends(),
        mut stops in proptest::collection::vec(0..3_500_000_u64, 0..50),
    ) {
        // Everything is sent at its time, so stop there, and anywhere else.
        stops.extend(sends.iter().map(|send| send.at_ns));
        stops.push(END_NS);
        stops.sort_unstable();
        let (in_one, in_steps) = (run(&sends, &[END_NS]), run(&sends, &stops));
        prop_assert_eq!(in_one.sent, in_steps.sent);
        prop_assert_eq!(in_one.heard, in_steps.heard);
    }
}

fn frame(id: u16, data: &[u8]) -> Frame {
    Frame::new(CanId::Standard(id), data).unwrap()
}

#[test]
fn a_frame_on_the_wire_is_not_interrupted() {
    let mut bus = VirtualBus::new(Bitrate::MBIT_1);
    let [slow, urgent] = ["slow", "urgent"].map(|name| bus.attach(name));
    bus.send(slow, SimTime::ZERO, &frame(0x7F0, &[0x55; 8]));
    bus.send(urgent, SimTime::from_micros(1), &frame(0x001, &[]));
    bus.advance(SimTime::from_millis(1));
    let [first, second] = [urgent, slow].map(|node| bus.receive(node).unwrap());
    assert!(first.at < second.at);
    let gap = u64::from(frame_bits(&second.frame)) + 3;
    assert_eq!(second.at, SimTime::from_nanos(first.at.as_nanos() + gap * BIT_NS));
}

#[test]
fn an_urgent_frame_waits_behind_its_own_nodes_frames() {
    let mut bus = VirtualBus::new(Bitrate::MBIT_1);
    let [node, other, listener] = ["node", "other", "listener"].map(|name| bus.attach(name));
    bus.send(node, SimTime::ZERO, &frame(0x700, &[]));
    bus.send(node, SimTime::ZERO, &frame(0x001, &[]));
    bus.send(other, SimTime::ZERO, &frame(0x100, &[]));
    bus.advance(SimTime::from_millis(1));
    let ids: Vec<u32> =
        std::iter::from_fn(|| bus.receive(listener)).map(|heard| heard.frame.id().raw()).collect();
    assert_eq!(ids, [0x100, 0x700, 0x001]);
}

#[test]
fn nodes_may_send_at_the_instant_time_has_reached_in_any_order() {
    let mut bus = VirtualBus::new(Bitrate::MBIT_1);
    let [late, early, listener] = ["late", "early", "listener"].map(|name| bus.attach(name));
    let tick = SimTime::from_millis(10);
    bus.send(late, tick, &frame(0x200, &[]));
    bus.advance(tick);
    bus.send(early, tick, &frame(0x100, &[]));
    bus.advance(SimTime::from_millis(20));
    assert_eq!(bus.receive(listener).unwrap().frame.id().raw(), 0x100);
}

#[test]
fn a_frame_is_there_at_the_very_end_of_its_last_bit() {
    let mut bus = VirtualBus::new(Bitrate::MBIT_1);
    let [node, listener] = ["node", "listener"].map(|name| bus.attach(name));
    bus.send(node, SimTime::ZERO, &frame(0, &[])); // 50 bits
    bus.advance(SimTime::from_nanos(49_999));
    assert_eq!(bus.receive(listener), None);
    bus.advance(SimTime::from_micros(50));
    assert_eq!(bus.receive(listener).unwrap().at, SimTime::from_micros(50));
}

#[test]
fn nothing_is_sent_in_the_past() {
    let mut bus = VirtualBus::new(Bitrate::MBIT_1);
    let [node, listener] = ["node", "listener"].map(|name| bus.attach(name));
    bus.advance(SimTime::from_millis(10));
    bus.send(node, SimTime::from_millis(3), &frame(0, &[]));
    bus.advance(SimTime::from_millis(9)); // nor does time go back
    assert_eq!((bus.now(), bus.receive(listener)), (SimTime::from_millis(10), None));
    bus.advance(SimTime::from_millis(11));
    assert_eq!(bus.receive(listener).unwrap().at, SimTime::from_micros(10_050));
}

#[test]
fn two_losers_with_one_identifier_have_not_collided_yet() {
    let mut bus = VirtualBus::new(Bitrate::MBIT_1);
    let [a, b, urgent] = ["a", "b", "urgent"].map(|name| bus.attach(name));
    for (node, id) in [(a, 0x200), (b, 0x200), (urgent, 0)] {
        bus.send(node, SimTime::ZERO, &frame(id, &[]));
    }
    bus.advance(SimTime::from_millis(1));
    let collisions: Vec<_> = bus.collisions().collect();
    assert_eq!(collisions.len(), 1);
    assert_eq!((collisions[0].nodes, collisions[0].count), ((a, b), 1));
    assert_eq!(collisions[0].first_at, SimTime::from_micros(50 + 3));
}

#[test]
fn two_nodes_with_one_identifier_are_reported() {
    let mut bus = VirtualBus::new(Bitrate::MBIT_1);
    let [a, b, listener] = ["a", "b", "listener"].map(|name| bus.attach(name));
    for at_ms in [1, 2] {
        bus.send(a, SimTime::from_millis(at_ms), &frame(0x123, &[1]));
        bus.send(b, SimTime::from_millis(at_ms), &frame(0x123, &[2]));
        bus.advance(SimTime::from_millis(at_ms + 1));
    }
    let collisions: Vec<_> = bus.collisions().collect();
    assert_eq!(collisions.len(), 1);
    assert_eq!((collisions[0].nodes, collisions[0].count), ((a, b), 2));
    assert_eq!(collisions[0].first_at, SimTime::from_millis(1));
    // Nothing is lost over it.
    assert_eq!(std::iter::from_fn(|| bus.receive(listener)).count(), 4);
}

#[test]
fn of_three_nodes_with_one_identifier_the_first_two_are_named() {
    let mut bus = VirtualBus::new(Bitrate::MBIT_1);
    let [a, b, c] = ["a", "b", "c"].map(|name| bus.attach(name));
    for node in [c, b, a] {
        bus.send(node, SimTime::ZERO, &frame(0x123, &[]));
    }
    bus.advance(SimTime::from_millis(1));
    let collisions: Vec<_> = bus.collisions().collect();
    // Three arbitrate, then the two that lost.
    assert_eq!((collisions[0].nodes, collisions[0].count), ((a, b), 2));
}

#[test]
fn a_saturated_bus_is_at_full_load_and_starves_the_less_urgent() {
    let mut bus = VirtualBus::new(Bitrate::KBIT_250);
    let [babbler, victim] = ["babbler", "victim"].map(|name| bus.attach(name));
    (0..1_000).for_each(|_| bus.send(babbler, SimTime::ZERO, &frame(0, &[0; 8])));
    bus.send(victim, SimTime::ZERO, &frame(1, &[]));
    bus.advance(SimTime::from_millis(200));
    assert_eq!((bus.load_total(), bus.load_window()), (1.0, 1.0));
    assert_eq!((bus.counters(victim).sent, bus.pending(victim)), (0, 1));
    bus.advance(SimTime::from_millis(2_000));
    assert_eq!((bus.counters(victim).sent, bus.pending(victim)), (1, 0));
    assert_eq!(bus.load_window(), 0.0);
}

#[test]
fn queues_are_finite_and_count_what_they_refuse() {
    use xt28_bus::virtual_bus::QUEUE_FRAMES;
    let mut bus = VirtualBus::new(Bitrate::MBIT_1);
    let [sender, deaf] = ["sender", "deaf"].map(|name| bus.attach(name));
    for second in 0..2 {
        for _ in 0..QUEUE_FRAMES + 1 {
            bus.send(sender, SimTime::from_millis(1_000 * second), &frame(0, &[]));
        }
        bus.advance(SimTime::from_millis(1_000 * (second + 1)));
    }
    let [sent, heard] = [sender, deaf].map(|node| bus.counters(node));
    assert_eq!((sent.transmit_overflows, sent.sent), (2, 2 * QUEUE_FRAMES as u64));
    assert_eq!(
        (heard.received, heard.receive_overruns),
        (QUEUE_FRAMES as u64, QUEUE_FRAMES as u64)
    );
}
