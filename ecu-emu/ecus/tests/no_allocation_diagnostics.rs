//! Neither codes that come and go, nor a tester that reads them, nor a restart allocates.

use std::alloc::System;
use std::time::Duration;

use stats_alloc::{INSTRUMENTED_SYSTEM, Region, StatsAlloc};
use xt28_dbc::{CanId, Frame};
use xt28_ecus::{ArmEcu, ArmOutputs, ArmPins, Port, pins};
use xt28_machine::{Machine, PerWheel, SimTime, Wheel};

#[global_allocator]
static ALLOCATOR: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;

/// What a tester sends at a tick: a session, a list of all codes and the flow control for it, DM2 and
/// DM11, and an address that is fought for.
fn requests(tick: u64) -> Option<Frame> {
    let (id, data): (u32, [u8; 8]) = match tick % 50 {
        1 => (0x18DA_28F1, [2, 0x10, 3, 0, 0, 0, 0, 0]),
        5 => (0x18DA_28F1, [2, 0x19, 0x0A, 0, 0, 0, 0, 0]),
        7 => (0x18DA_28F1, [0x30, 0, 0, 0, 0, 0, 0, 0]),
        30 => (0x18DA_28F1, [5, 0x22, 0x01, 0x10, 0x02, 0x10, 0, 0]),
        32 => (0x18DA_28F1, [0x30, 0, 0, 0, 0, 0, 0, 0]),
        35 => (0x18EA_28F9, [0xCB, 0xFE, 0, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF]),
        40 => (0x18EA_28F9, [0xD3, 0xFE, 0, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF]),
        45 => (0x18EE_FF28, [0xFF; 8]),
        _ => return None,
    };
    Frame::new(CanId::Extended(id), &data)
}

#[test]
fn a_busy_service_tool_allocates_nothing() {
    let mut ecu = ArmEcu::new(&Machine::xt28());
    let mut out = ArmOutputs::default();
    let mut run = |ticks: core::ops::Range<u64>| {
        let mut frames = 0;
        for tick in ticks {
            let now = SimTime::ZERO + Duration::from_millis(10) * u32::try_from(tick).unwrap();
            let mut pins = ArmPins {
                stroke_mv: PerWheel::splat(pins::stroke_mv(0.1)),
                pressure_a_mv: PerWheel::splat(pins::pressure_mv(5e6)),
                pressure_b_mv: PerWheel::splat(pins::pressure_mv(5e5)),
                supply_mv: if tick % 200 == 150 { 5_000.0 } else { 24_000.0 },
            };
            if tick % 100 > 50 {
                (pins.stroke_mv[Wheel::Fr], pins.stroke_mv[Wheel::Bl]) = (5_000.0, 0.0);
            }
            if let Some(frame) = requests(tick) {
                ecu.on_frame(now, Port::Can1, &frame);
            }
            ecu.tick(now, &pins, &mut out);
            frames += out.can1.frames().iter().filter(|f| f.id().raw() >> 16 == 0x18DA).count();
        }
        frames
    };
    run(0..400);
    // The harness has a thread of its own that may allocate meanwhile: once, and not each time.
    let counts = [400, 800, 1200].map(|from| {
        let region = Region::new(ALLOCATOR);
        let frames = run(from..from + 400);
        let change = region.change();
        assert!(frames > 100, "{frames} frames of answers");
        change.allocations + change.reallocations
    });
    assert_eq!(counts.into_iter().min(), Some(0));
}
