//! How long the virtual bus takes for a frame: `cargo run --release -p xt28-bus --example ns_per_frame`.
#![allow(clippy::disallowed_methods, clippy::disallowed_macros)] // a program that measures time

use std::hint::black_box;
use std::time::Instant;

use xt28_bus::virtual_bus::wire_bits::frame_bits;
use xt28_bus::{Bitrate, VirtualBus};
use xt28_dbc::{CanId, Frame};
use xt28_machine::SimTime;

/// What the machine's bus carries in a tick of 10 ms, about.
const FRAMES_A_TICK: u32 = 50;
const TICKS: u64 = 20_000;

fn main() {
    let frames: Vec<Frame> = (0..FRAMES_A_TICK)
        .map(|n| {
            let data = u64::from(n).wrapping_mul(0x9E37_79B9_7F4A_7C15).to_be_bytes();
            Frame::new(CanId::Extended(0x18FE_1000 + n), &data).expect("eight bytes")
        })
        .collect();

    let start = Instant::now();
    for _ in 0..TICKS {
        frames.iter().for_each(|frame| _ = black_box(frame_bits(black_box(frame))));
    }
    let total_frames = TICKS as f64 * f64::from(FRAMES_A_TICK);
    println!(
        "length on the wire  {:6.1} ns a frame",
        start.elapsed().as_nanos() as f64 / total_frames
    );

    let mut bus = VirtualBus::new(Bitrate::MBIT_1);
    let nodes = ["sms", "dms", "gateway", "log"].map(|name| bus.attach(name));
    bus.enable_tap();
    let start = Instant::now();
    for tick in 0..TICKS {
        let now = SimTime::from_millis(10 * tick);
        for (frame, node) in frames.iter().zip(nodes[..3].iter().cycle()) {
            bus.send(*node, now, frame);
        }
        bus.advance(SimTime::from_millis(10 * (tick + 1)));
        for node in nodes {
            while let Some(received) = bus.receive(node) {
                black_box(received);
            }
        }
        bus.drain_tap().for_each(|sent| _ = black_box(sent));
    }
    let took = start.elapsed();
    println!(
        "sent and delivered  {:6.1} ns a frame, {:.1} us a tick of {FRAMES_A_TICK} frames, 4 nodes, \
         load {:.1} %",
        took.as_nanos() as f64 / total_frames,
        took.as_micros() as f64 / TICKS as f64,
        100.0 * bus.load_total(),
    );
}
