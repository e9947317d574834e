//! How often everything is said on the machine's wires of its own, as `docs/firmware-2016.md` has it.

use std::collections::BTreeMap;

use ecu_emu::{Emulator, EmulatorConfig, Profile, TICK, Wire};
use xt28_dbc::Outbox;
use xt28_machine::{Machine, SimTime};
use xt28_sim::Terrain;

/// Frames of the first second, by identifier.
fn in_a_second(wire: Wire) -> BTreeMap<u32, u32> {
    let mut config = EmulatorConfig::new(Machine::xt28(), Terrain::Flat, None);
    config.profile = Profile::Firmware2016;
    let mut emulator = Emulator::new(&config);
    let (mut out, mut count) = (Outbox::default(), BTreeMap::new());
    for tick in 0..100 {
        out.clear();
        emulator.tick(SimTime::ZERO + TICK * tick, &mut out);
        for frame in emulator.on_wire(wire) {
            *count.entry(frame.id().raw()).or_default() += 1;
        }
    }
    count
}

#[test]
fn every_wire_carries_its_frames_at_their_periods() {
    // Every 10 ms, and the start of the unit once.
    assert_eq!(in_a_second(Wire::Inertial), [(0, 1), (0x1FD, 100), (0x2FD, 100)].into());
    // Every 20 ms.
    let left = [(0x18FE_000B, 50), (0x18FE_010B, 50), (0x18FE_030B, 50)];
    assert_eq!(in_a_second(Wire::LeftArmrest), left.into());
    let right = [(0x18FE_0015, 50), (0x18FE_0115, 50), (0x18FE_0315, 50)];
    assert_eq!(in_a_second(Wire::RightArmrest), right.into());
    // The request every 10 ms; EEC1 every 20, EEC2 every 50, ET1 once a second.
    let engine = [(1, 100), (0x0CF0_0300, 20), (0x0CF0_0400, 50), (0x18FE_EE00, 1)];
    assert_eq!(in_a_second(Wire::Engine), engine.into());
    let display = [0x18FE_1030, 0x18FE_1031, 0x18FE_1040, 0x18FE_1041, 0x18FE_1042];
    assert_eq!(in_a_second(Wire::Display), display.map(|id| (id, 100)).into());
}
