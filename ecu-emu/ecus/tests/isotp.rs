//! ISO-TP: every message comes through whole, and no frame does harm.

use std::time::Duration;

use proptest::prelude::*;
use xt28_ecus::diagnostics::isotp::{Endpoint, FlowLimits, FrameData, MESSAGE_MAX};
use xt28_machine::SimTime;

type Whole = Endpoint<MESSAGE_MAX, MESSAGE_MAX>;

fn endpoint(block_size: u8, separation_us: u64) -> Box<Whole> {
    let separation = Duration::from_micros(separation_us);
    Box::new(Endpoint::new(FlowLimits { block_size, separation }))
}

/// Lets two ends talk, looked after every `step`, until `from` has said all. What `to` got, and how
/// many frames it took both.
fn deliver(from: &mut Whole, to: &mut Whole, step: Duration) -> (Option<Vec<u8>>, usize) {
    let (mut now, mut got, mut frames) = (SimTime::ZERO, None, 0);
    while from.is_sending() {
        while let Some(data) = from.poll(now) {
            frames += 1;
            if let Some(message) = to.on_frame(now, &data) {
                assert_eq!(got.replace(message.to_vec()), None, "a message twice");
            }
            while let Some(data) = to.poll(now) {
                frames += 1;
                assert_eq!(from.on_frame(now, &data), None);
            }
        }
        now += step;
    }
    (got, frames)
}

fn any_separation_us() -> impl Strategy<Value = u64> {
    prop_oneof![Just(0), (1_u64..=9).prop_map(|n| n * 100), (1_u64..=127).prop_map(|n| n * 1000)]
}

#[derive(Clone, Debug)]
enum Event {
    Frame(Vec<u8>),
    Send(usize),
    Wait(u64),
    Poll,
}

fn any_event() -> impl Strategy<Value = Event> {
    // Heads of all kinds of frame, more often than chance would have them.
    let head = prop_oneof![any::<u8>(), 0x00_u8..=0x3F];
    let frame = (head, prop::collection::vec(any::<u8>(), 0..12)).prop_map(|(head, mut data)| {
        data.insert(0, head);
        Event::Frame(data)
    });
    prop_oneof![
        6 => frame,
        1 => Just(Event::Frame(Vec::new())),
        1 => (0_usize..80).prop_map(Event::Send),
        1 => (0_u64..2_000).prop_map(Event::Wait),
        3 => Just(Event::Poll),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn any_message_comes_through_whole(
        message in prop::collection::vec(any::<u8>(), 1..=MESSAGE_MAX),
        block_size in prop_oneof![Just(0_u8), any::<u8>()],
        separation_us in any_separation_us(),
        step_ms in 1_u64..=20,
    ) {
        let (mut from, mut to) = (endpoint(0, 0), endpoint(block_size, separation_us));
        from.send(&message).unwrap();
        let (got, frames) = deliver(&mut from, &mut to, Duration::from_millis(step_ms));
        prop_assert_eq!(from.take_failure(), None);
        prop_assert_eq!(to.take_failure(), None);
        let consecutive = message.len().saturating_sub(6).div_ceil(7);
        let expected = match (message.len(), block_size) {
            (..=7, _) => 1,
            (_, 0) => 2 + consecutive,
            (_, block) => 1 + consecutive + consecutive.div_ceil(usize::from(block)),
        };
        prop_assert_eq!(frames, expected);
        prop_assert_eq!(got, Some(message));
    }

    #[test]
    fn no_frame_does_harm(events in prop::collection::vec(any_event(), 0..200)) {
        let mut end: Endpoint<64, 64> =
            Endpoint::new(FlowLimits { block_size: 3, separation: Duration::ZERO });
        let mut now = SimTime::ZERO;
        for event in &events {
            match event {
                Event::Frame(data) => {
                    if let Some(message) = end.on_frame(now, data) {
                        prop_assert!((1..=64).contains(&message.len()));
                    }
                }
                Event::Send(length) => drop(end.send(&vec![0x55; *length])),
                Event::Wait(ms) => now += Duration::from_millis(*ms),
                Event::Poll => {
                    // Never more than a message's frames and a flow control at once.
                    let mut left = 12;
                    while end.poll(now).is_some() {
                        left -= 1;
                        prop_assert!(left > 0, "sends without end");
                    }
                }
            }
        }
        // Whatever was: what it may still send leaves within a few longest separations, and after
        // one timeout more it serves again.
        for _ in 0..20 {
            now += Duration::from_millis(127);
            while end.poll(now).is_some() {}
        }
        now += Duration::from_secs(2);
        prop_assert_eq!(end.poll(now), None);
        prop_assert_eq!(end.on_frame(now, &[2, 0x3E, 0]), Some(&[0x3E, 0][..]));
        end.send(&[0x7E, 0]).unwrap();
        let padded: FrameData = [2, 0x7E, 0, 0xCC, 0xCC, 0xCC, 0xCC, 0xCC];
        prop_assert_eq!(end.poll(now), Some(padded));
    }
}

#[test]
fn the_longest_message_comes_through_at_both_extremes_of_a_block() {
    for block_size in [1, 255] {
        let message: Vec<u8> = (0..MESSAGE_MAX).map(|i| (i % 251) as u8).collect();
        let (mut from, mut to) = (endpoint(0, 0), endpoint(block_size, 0));
        from.send(&message).unwrap();
        let (got, _) = deliver(&mut from, &mut to, Duration::from_millis(10));
        assert_eq!(got, Some(message));
    }
}
