//! Somebody else's armrest on its own wire, and what the display shows of it.
//!
//! Where a bus is named in `XT28_VCAN` the emulator's own program runs there, with both wires on vcan1.
#![allow(clippy::disallowed_methods, clippy::disallowed_macros)] // a test of a program in real time

use std::io::{self, BufRead, BufReader, Write as _};
use std::process::{Command, Stdio};
use std::time::Duration;

use ecu_emu::{Emulator, EmulatorConfig, Operator, Profile, TICK, Wire};
use xt28_bus::{Bus, SocketCan};
use xt28_dbc::messages::ArmDisplay;
use xt28_dbc::{Frame, Outbox};
use xt28_ecus::firmware_2016::pads;
use xt28_machine::{Machine, SimTime};
use xt28_sim::Terrain;

/// Puts the accumulators on their cylinders.
const PASSIVE: u8 = 17;
/// At rest.
const STICK_MV: [u16; 2] = [2350; 2];

fn shown(frames: &[Frame]) -> Option<ArmDisplay> {
    let display = frames.iter().rev().find(|frame| frame.id() == ArmDisplay::ID)?;
    Some(ArmDisplay::decode(display).unwrap())
}

#[test]
fn an_armrest_from_outside_takes_the_place_of_the_emulated_one() {
    let mut config = EmulatorConfig::new(Machine::xt28(), Terrain::Flat, None);
    config.profile = Profile::Firmware2016;
    config.operator = Operator::absent();
    let mut emulator = Emulator::new(&config);
    let mut out = Outbox::default();
    let mut tick = |n: u32, pressed: Option<&[u8]>| {
        let now = SimTime::ZERO + TICK * n;
        for frame in pressed.into_iter().flat_map(|pressed| pads::left_frames(pressed, STICK_MV)) {
            emulator.on_wire_frame(now, Wire::LeftArmrest, &frame);
        }
        out.clear();
        emulator.tick(now, &mut out);
        assert!(emulator.on_wire(Wire::LeftArmrest).is_empty(), "nobody sits there");
        let display = shown(emulator.on_wire(Wire::Display)).expect("sent every tick");
        (display.alert, display.passive)
    };
    let silent = (0..40).map(|n| tick(n, None)).last();
    assert_eq!(silent, Some((1, 0)), "a missing armrest shows");
    let pressed = (40..60).map(|n| tick(n, Some(&[PASSIVE]))).last();
    assert_eq!(pressed, Some((0, 1)));
}

#[test]
fn a_real_wire_carries_an_armrest_in_and_the_display_out() {
    let Some(bus) = std::env::var_os("XT28_VCAN") else {
        let _ =
            writeln!(io::stdout(), "SKIPPED: XT28_VCAN names no bus; `cargo xtask vcan` has one");
        return;
    };
    let mut program = Command::new(env!("CARGO_BIN_EXE_ecu-emu"))
        .args(["--profile", "2016", "--duration", "3", "--wire", "left-armrest=vcan1"])
        .args(["--wire", "display=vcan1", "--bus"])
        .arg(bus)
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    // It says where its receiver is once it listens.
    let mut line = String::new();
    BufReader::new(program.stdout.take().unwrap()).read_line(&mut line).unwrap();
    let mut wire = SocketCan::open("vcan1").unwrap();
    let mut seen = Vec::new();
    for n in 0..100_u64 {
        let pressed: &[u8] = if (50..60).contains(&n) { &[PASSIVE] } else { &[] };
        for frame in pads::left_frames(pressed, STICK_MV) {
            wire.send(SimTime::from_millis(20 * n), &frame).unwrap();
        }
        std::thread::sleep(Duration::from_millis(20));
        while let Some(received) = wire.receive().unwrap() {
            seen.extend(shown(&[received.frame]));
        }
    }
    assert!(program.wait().unwrap().success());
    let passive: Vec<u8> = seen.iter().map(|display| display.passive).collect();
    assert!(passive.len() > 150, "{} of some 200 display frames", passive.len());
    assert!(passive.is_sorted() && passive.first() == Some(&0) && passive.last() == Some(&1));
    assert!(seen.iter().all(|display| display.alert == 0), "the armrest is never missed");
}
