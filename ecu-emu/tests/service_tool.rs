//! Stock clients, python's can-isotp and udsoncan, read both ECUs.
//!
//! Where a bus is named in `XT28_VCAN` the emulator's own program answers there; without, frames go
//! through a pipe, and need no bus. Skipped, and said so, where the clients are not installed; with
//! `CI` set they have to be.
#![allow(clippy::disallowed_methods, clippy::disallowed_macros)] // real time; finds its clients

use std::io::{self, BufRead, BufReader, Write};
use std::process::{Child, Command, Stdio};
use std::sync::mpsc;
use std::time::{Duration, Instant};

use ecu_emu::{Emulator, EmulatorConfig, TICK};
use xt28_dbc::{CanId, Frame, Outbox};
use xt28_machine::{Machine, SimTime};
use xt28_sim::Terrain;

/// The wire of stroke sensor FR breaks late enough that it reads well first.
const FAULT: &str = "stroke:FR:open-circuit@10";

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

fn parse(line: &str) -> Frame {
    let (id, data) = line.trim().split_once('#').expect("ID#DATA");
    let data: Vec<u8> = (0..data.len() / 2)
        .map(|i| u8::from_str_radix(&data[2 * i..2 * i + 2], 16).unwrap())
        .collect();
    Frame::new(CanId::Extended(u32::from_str_radix(id, 16).unwrap()), &data).unwrap()
}

#[test]
fn a_stock_service_tool_reads_both_ecus_through_a_pipe() {
    if !clients_are_there() {
        return;
    }
    let mut config = EmulatorConfig::new(Machine::xt28(), Terrain::Flat, Some(1));
    config.mishaps.faults.push(FAULT.parse().unwrap());
    let mut emulator = Emulator::new(&config);
    let mut tool = tool(&["--pipe"], true);
    let (mut to, from) = (tool.stdin.take().unwrap(), tool.stdout.take().unwrap());
    let (sender, frames) = mpsc::channel();
    std::thread::spawn(move || {
        for line in BufReader::new(from).lines().map_while(Result::ok) {
            let _ = sender.send(parse(&line));
        }
    });
    let (begun, mut now, mut out) = (Instant::now(), SimTime::ZERO, Outbox::default());
    let status = loop {
        if let Some(status) = tool.try_wait().unwrap() {
            break status;
        }
        assert!(begun.elapsed() < Duration::from_secs(120), "the tool does not come to an end");
        for frame in frames.try_iter() {
            emulator.on_frame(now, &frame);
        }
        out.clear();
        emulator.tick(now, &mut out);
        let lines: String = out
            .frames()
            .iter()
            .filter(|frame| is_diagnostic(frame.id()))
            .map(|frame| format!("{frame:?}\n"))
            .collect();
        // A tool that has ended has closed its pipe; its status tells how.
        let _ = to.write_all(lines.as_bytes());
        now += TICK;
        let due = begun + now.since(SimTime::ZERO);
        std::thread::sleep(due.saturating_duration_since(Instant::now()));
    };
    assert!(status.success(), "{status}");
}

#[test]
fn a_stock_service_tool_reads_both_ecus_on_a_real_bus() {
    let Some(bus) = std::env::var_os("XT28_VCAN") else {
        eprintln!("SKIPPED: no bus named in XT28_VCAN; cargo xtask vcan-scenarios names one");
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
