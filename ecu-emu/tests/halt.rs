//! A program that is halted and let go on: its machine knows nothing of the time between.
//!
//! Needs a real bus, named in `XT28_VCAN`; `cargo xtask vcan` has one.
#![allow(clippy::disallowed_methods, clippy::disallowed_macros)] // a test of a program in real time

use std::io::{BufRead, BufReader, Read};
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::Duration;

use rustix::process::{Pid, Signal, kill_process};
use xt28_bus::{Bus, SocketCan};

/// Frames that wait on the bus.
fn heard(bus: &mut SocketCan) -> u32 {
    let mut count = 0;
    while bus.receive().unwrap().is_some() {
        count += 1;
    }
    count
}

#[test]
fn a_halt_puts_no_burst_on_the_bus() {
    let Some(name) = std::env::var_os("XT28_VCAN") else {
        eprintln!("SKIPPED: XT28_VCAN names no bus; `cargo xtask vcan` has one");
        return;
    };
    let mut bus = SocketCan::open(name.to_str().unwrap()).unwrap();
    let mut program = Command::new(env!("CARGO_BIN_EXE_ecu-emu"))
        .arg("--bus")
        .arg(name)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let pid = Pid::from_raw(i32::try_from(program.id()).unwrap()).unwrap();
    let signal = |signal| kill_process(pid, signal).unwrap();
    // It listens from its first line on.
    let mut line = String::new();
    BufReader::new(program.stdout.take().unwrap()).read_line(&mut line).unwrap();
    let half_a_second = Duration::from_millis(500);
    sleep(half_a_second);
    heard(&mut bus);
    sleep(half_a_second);
    let before = heard(&mut bus);
    signal(Signal::STOP);
    sleep(10 * half_a_second);
    heard(&mut bus);
    signal(Signal::CONT);
    sleep(half_a_second);
    let after = heard(&mut bus);
    signal(Signal::TERM);
    assert!(program.wait().unwrap().success());
    let mut said = String::new();
    program.stderr.take().unwrap().read_to_string(&mut said).unwrap();
    assert!(said.contains("halted 1 time(s), 5.0 s"), "{said}");
    assert!(before > 100 && after.abs_diff(before) <= before / 10, "{before} frames, then {after}");
}
