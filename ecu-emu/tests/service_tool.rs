//! Stock clients, python's can-isotp and udsoncan, read both ECUs.
//!
//! Where a bus is named in `XT28_VCAN` the emulator's own program answers there; without, frames go
//! through a pipe, and need no bus: the ECUs' time never runs ahead of the clock on the wall, and stands
//! still while the tool or the test is held up. Skipped, and said so, where the clients are not installed; with
//! `CI` set they have to be.
#![allow(clippy::disallowed_methods, clippy::disallowed_macros)] // real time; finds its clients

use std::io::{self, BufRead, BufReader, Write};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc;
use std::thread::sleep;
use std::time::{Duration, Instant};

use ecu_emu::{Emulator, EmulatorConfig, TICK};
use rustix::process::{Pid, Signal, kill_process};
use xt28_dbc::{CanId, Frame, Outbox};
use xt28_machine::{Machine, SimTime};
use xt28_sim::Terrain;

/// The wire of stroke sensor FR breaks late enough that it reads well first.
const FAULT: &str = "stroke:FR:open-circuit@10";
/// Tool and test are each held up once, for longer than ISO-TP waits for the other side (1 s): as the
/// first and as the second answer of more than one frame begins.
const HELD_UP: Duration = Duration::from_millis(1500);
/// So long without a word is not a busy machine any more.
const HUNG: Duration = Duration::from_secs(60);

fn clients_are_there() -> bool {
    let found = Command::new("python3")
        .args(["-c", "import can, isotp, udsoncan"])
        .stderr(Stdio::null())
        .status()
        .is_ok_and(|status| status.success());
    if !found {
        let wanted = "python3 with can-isotp, udsoncan and python-can (pip install them)";
        assert!(std::env::var_os("CI").is_none(), "CI needs {wanted}");
        let _ = writeln!(io::stdout(), "SKIPPED: no stock service tool; it needs {wanted}");
    }
    found
}

fn tool(arguments: &[&str], piped: bool) -> Child {
    let wire = || if piped { Stdio::piped() } else { Stdio::null() };
    Command::new("python3")
        .arg(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/service_tool.py"))
        .args(arguments)
        .stdin(wire())
        .stdout(wire())
        .stderr(Stdio::inherit())
        .spawn()
        .unwrap()
}

/// What a service tool listens to.
fn is_diagnostic(id: CanId) -> bool {
    let raw = id.raw();
    id.is_extended()
        && (matches!(raw >> 16 & 0xFF, 0xDA | 0xDB | 0xE8..=0xEE) || raw >> 9 & 0x7FFF == 0x7F65)
}

/// What the tool says: a frame, or that it has heard all up to the newest time.
enum Said {
    Frame(Frame),
    Heard,
}

fn parse(line: &str) -> Said {
    let Some((id, data)) = line.trim().split_once('#') else {
        assert_eq!(line, "@", "ID#DATA or @");
        return Said::Heard;
    };
    let data: Vec<u8> = (0..data.len() / 2)
        .map(|i| u8::from_str_radix(&data[2 * i..2 * i + 2], 16).unwrap())
        .collect();
    let id = CanId::Extended(u32::from_str_radix(id, 16).unwrap());
    Said::Frame(Frame::new(id, &data).unwrap())
}

/// Both ends of the pipe to a tool.
struct Piped {
    tool: Child,
    to: ChildStdin,
    said: mpsc::Receiver<Said>,
}

impl Piped {
    fn start() -> Self {
        let mut tool = tool(&["--pipe"], true);
        let (to, from) = (tool.stdin.take().unwrap(), tool.stdout.take().unwrap());
        let (sender, said) = mpsc::channel();
        std::thread::spawn(move || {
            for line in BufReader::new(from).lines().map_while(Result::ok) {
                let _ = sender.send(parse(&line));
            }
        });
        Self { tool, to, said }
    }

    /// Gives the tool the frames of a tick and the time, and waits until it has heard them: what it has
    /// said meanwhile, or nothing once it has ended.
    fn exchange(&mut self, now: SimTime, out: &Outbox) -> Option<Vec<Frame>> {
        let frames = out.frames().iter().filter(|frame| is_diagnostic(frame.id()));
        let mut lines: String = frames.map(|frame| format!("{frame:?}\n")).collect();
        lines += &format!("@{}\n", now.since(SimTime::ZERO).as_millis());
        // A tool that has ended has closed its pipe; its status tells how.
        let _ = self.to.write_all(lines.as_bytes());
        let mut frames = Vec::new();
        loop {
            match self.said.recv_timeout(HUNG) {
                Ok(Said::Frame(frame)) => frames.push(frame),
                Ok(Said::Heard) => return Some(frames),
                Err(mpsc::RecvTimeoutError::Disconnected) => return None,
                Err(mpsc::RecvTimeoutError::Timeout) => panic!("the tool hangs"),
            }
        }
    }

    /// Halts the tool's program for a while, which is what a busy machine may do to it.
    fn halt(&self) {
        let pid = Pid::from_raw(i32::try_from(self.tool.id()).unwrap()).unwrap();
        kill_process(pid, Signal::STOP).unwrap();
        std::thread::spawn(move || {
            sleep(HELD_UP);
            // It cannot end while it is halted, so this is still its number.
            kill_process(pid, Signal::CONT).unwrap();
        });
    }
}

/// Whether an answer of more than one frame begins: the tool is to say how it goes on.
fn is_first_frame(frame: &Frame) -> bool {
    frame.id().raw() >> 8 == 0x0018_DAF1 && frame.data()[0] >> 4 == 1
}

#[test]
fn a_stock_service_tool_reads_both_ecus_through_a_pipe() {
    if !clients_are_there() {
        return;
    }
    let mut config = EmulatorConfig::new(Machine::xt28(), Terrain::Flat, Some(1));
    config.mishaps.faults.push(FAULT.parse().unwrap());
    let mut emulator = Emulator::new(&config);
    let mut piped = Piped::start();
    let (begun, mut now, mut out) = (Instant::now(), SimTime::ZERO, Outbox::default());
    let mut answers = 0;
    loop {
        let tick_begun = Instant::now();
        assert!(begun.elapsed() < Duration::from_secs(120), "the tool does not come to an end");
        out.clear();
        emulator.tick(now, &mut out);
        let begins = out.frames().iter().any(is_first_frame);
        answers += u32::from(begins);
        if begins && answers == 1 {
            piped.halt();
        }
        let Some(frames) = piped.exchange(now, &out) else { break };
        if begins && answers == 2 {
            sleep(HELD_UP);
        }
        now += TICK;
        frames.iter().for_each(|frame| emulator.on_frame(now, frame));
        // Never to catch up: to the tool, ECUs in a hurry are ECUs that do not wait for it.
        sleep(TICK.saturating_sub(tick_begun.elapsed()));
    }
    let status = piped.tool.wait().unwrap();
    assert!(status.success(), "{status}");
    assert!(answers > 2, "{answers} long answers: both sides were held up");
}

#[test]
fn a_stock_service_tool_reads_both_ecus_on_a_real_bus() {
    let Some(bus) = std::env::var_os("XT28_VCAN") else {
        let _ = writeln!(
            io::stdout(),
            "SKIPPED: no bus named in XT28_VCAN; cargo xtask vcan-scenarios names one"
        );
        return;
    };
    if !clients_are_there() {
        return;
    }
    let bus = bus.to_str().unwrap();
    let mut emulator = Command::new(env!("CARGO_BIN_EXE_ecu-emu"))
        .args(["--bus", bus, "--seed", "1", "--sensor-fault", FAULT])
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    // It says a line once it has settled and listens.
    let mut line = String::new();
    BufReader::new(emulator.stdout.as_mut().unwrap()).read_line(&mut line).unwrap();
    let status = tool(&["--bus", bus], false).wait();
    emulator.kill().unwrap();
    emulator.wait().unwrap();
    assert!(status.unwrap().success(), "the tool says why");
}
