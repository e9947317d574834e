//! A program that is halted and let go on: its machine knows nothing of the time between.
//!
//! Needs a real bus, named in `XT28_VCAN`; `cargo xtask vcan` has one.
#![allow(clippy::disallowed_methods, clippy::disallowed_macros)] // a test of a program in real time

use std::io::{self, BufRead, BufReader, Read, Write as _};
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::Duration;

use rustix::process::{Pid, Signal, kill_process};
use xt28_bus::{Bus, SocketCan};
use xt28_dbc::{CanId, Frame};
use xt28_machine::SimTime;

/// How often the bus is listened to: its socket holds some 20 ticks of frames.
const LISTEN: Duration = Duration::from_millis(20);
const HALF_A_SECOND: u32 = 25;
const HALT: Duration = Duration::from_secs(5);
const MANY: u32 = 5_000;

/// The emulator, ended whatever becomes of the test.
struct Program(Child);

impl Drop for Program {
    fn drop(&mut self) {
        let _ = self.0.kill();
    }
}

/// Frames heard until `times` of [`LISTEN`] are over.
fn heard(bus: &mut SocketCan, times: u32) -> u32 {
    let mut count = 0;
    for _ in 0..times {
        sleep(LISTEN);
        while bus.receive().unwrap().is_some() {
            count += 1;
        }
    }
    count
}

#[test]
fn a_halt_puts_no_burst_on_the_bus() {
    let Some(name) = std::env::var_os("XT28_VCAN") else {
        let _ =
            writeln!(io::stdout(), "SKIPPED: XT28_VCAN names no bus; `cargo xtask vcan` has one");
        return;
    };
    let mut bus = SocketCan::open(name.to_str().unwrap()).unwrap();
    let mut program = Command::new(env!("CARGO_BIN_EXE_ecu-emu"));
    program.arg("--bus").arg(name).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut program = Program(program.spawn().unwrap());
    let pid = Pid::from_raw(i32::try_from(program.0.id()).unwrap()).unwrap();
    // It listens from its first line on.
    let mut line = String::new();
    BufReader::new(program.0.stdout.take().unwrap()).read_line(&mut line).unwrap();
    heard(&mut bus, HALF_A_SECOND);
    let before = heard(&mut bus, HALF_A_SECOND);
    kill_process(pid, Signal::STOP).unwrap();
    heard(&mut bus, 1);
    sleep(HALT);
    assert_eq!(heard(&mut bus, 1), 0, "it is halted");
    // More than its socket holds.
    let stray = Frame::new(CanId::Standard(0x7FF), &[0; 8]).unwrap();
    (0..MANY).for_each(|_| bus.send(SimTime::ZERO, &stray).unwrap());
    kill_process(pid, Signal::CONT).unwrap();
    let after = heard(&mut bus, HALF_A_SECOND);
    kill_process(pid, Signal::TERM).unwrap();
    assert!(program.0.wait().unwrap().success());
    let mut said = String::new();
    program.0.stderr.take().unwrap().read_to_string(&mut said).unwrap();
    let (_, put_off) = said.split_once("put off by ").unwrap_or_else(|| panic!("{said}"));
    let put_off_s: f64 = put_off.split(' ').next().unwrap().parse().unwrap();
    assert!((4.9..6.0).contains(&put_off_s), "{said}");
    let (_, lost) = said.split_once("ecu-emu: ").unwrap().1.split_once("ecu-emu: ").expect(&said);
    assert!(lost.ends_with("frames came and were lost: nobody read them in time\n"), "{said}");
    // Half a second is 50 ticks of some 30 frames; made up for, the halt would be 500 more.
    assert!(before > 1000 && after < 2 * before, "{before} frames, then {after}");
}
