//! What came before the machine was ready moves nothing: nobody knows when it was sent.
//!
//! Needs a real bus, named in `XT28_VCAN`; `cargo xtask vcan` has one.
#![allow(clippy::disallowed_methods, clippy::disallowed_macros)] // a test of a program in real time

use std::io::{self, ErrorKind, Read, Write, pipe};
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::Duration;

use rustix::io::ioctl_fionbio;
use xt28_bus::{Bus, SocketCan};
use xt28_dbc::e2e::AliveCounter;
use xt28_dbc::messages::{ArmStatus, ArmStatusState, ArmTarget, ArmTargetMode};
use xt28_machine::SimTime;

/// In this time it is ready but for the line that says so.
const READY: Duration = Duration::from_secs(4);
const COMMANDS: u32 = 10;
const STROKE_MM: f64 = 200.0;

fn command(counter: u8) -> ArmTarget {
    let [fr_mm, fl_mm, mr_mm, ml_mm, br_mm, bl_mm] = [STROKE_MM; 6];
    let mode = ArmTargetMode::ManualPosition;
    ArmTarget { fr_mm, fl_mm, mr_mm, ml_mm, br_mm, bl_mm, mode, counter }
}

#[test]
fn commands_of_before_it_was_ready_move_nothing() {
    let Some(name) = std::env::var_os("XT28_VCAN") else {
        let _ =
            writeln!(io::stdout(), "SKIPPED: XT28_VCAN names no bus; `cargo xtask vcan` has one");
        return;
    };
    let mut bus = SocketCan::open(name.to_str().unwrap()).unwrap();
    // A pipe without room holds it up where it says that it is ready.
    let (mut reader, mut writer) = pipe().unwrap();
    ioctl_fionbio(&writer, true).unwrap();
    let full = (0..).find_map(|_| writer.write_all(&[b' '; 512]).err()).unwrap();
    assert_eq!(full.kind(), ErrorKind::WouldBlock);
    ioctl_fionbio(&writer, false).unwrap();
    let mut program = Command::new(env!("CARGO_BIN_EXE_ecu-emu"));
    program.args(["--duration", "1", "--bus"]).arg(name);
    let mut program = program.stdout(writer).stderr(Stdio::null()).spawn().unwrap();
    sleep(READY);
    let mut counter = AliveCounter::default();
    for _ in 0..COMMANDS {
        let frame = command(counter.next_count()).encode().unwrap();
        bus.send(SimTime::ZERO, &frame).unwrap();
    }
    sleep(READY);
    std::thread::spawn(move || reader.read_to_end(&mut Vec::new()).unwrap());
    let mut states = Vec::new();
    for _ in 0..20 {
        sleep(Duration::from_millis(20));
        while let Some(received) = bus.receive().unwrap() {
            states.extend(ArmStatus::decode(&received.frame).ok().map(|status| status.state));
        }
    }
    assert!(program.wait().unwrap().success());
    assert!(states.len() > 10, "{} status frames", states.len());
    assert!(states.iter().all(|state| *state == ArmStatusState::Standby), "{states:?}");
}
