//! Other people's readers take our logs, and ours takes theirs: can-utils and python-can.
//!
//! Skipped, and said so, where they are not installed; with `CI` set they have to be.
#![allow(clippy::disallowed_methods, clippy::disallowed_macros)] // asks for CI, says what it skips

use core::time::Duration;
use std::io::{self, Write as _};
use std::process::{Command, Stdio};

use xt28_bus::candump::{Direction, Reader, Writer};
use xt28_dbc::{CanId, Frame};
use xt28_machine::SimTime;

/// Runs a program on `input`; `None` where it is not installed.
fn output(program: &str, args: &[&str], input: &[u8]) -> Option<String> {
    let child = Command::new(program)
        .args(args)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn();
    let Ok(mut child) = child else { return None };
    child.stdin.take().unwrap().write_all(input).unwrap();
    let output = child.wait_with_output().unwrap();
    let errors = String::from_utf8_lossy(&output.stderr);
    if errors.contains("No module named 'can'") {
        return None;
    }
    assert!(output.status.success(), "{program}: {errors}");
    Some(String::from_utf8(output.stdout).unwrap())
}

/// True if the test goes on without the program.
fn skips<T>(program: &str, output: Option<T>) -> Option<T> {
    if output.is_none() {
        assert!(std::env::var_os("CI").is_none(), "{program} is not installed; CI must have it");
        let _ = writeln!(
            io::stdout(),
            "SKIPPED: {program} is not installed, so our logs were not checked against it"
        );
    }
    output
}

fn frames() -> Vec<(SimTime, Frame)> {
    let ids = [CanId::Standard(0x00A), CanId::Standard(0x7FF), CanId::Extended(0x0CFF_4027)];
    let data = [0x55, 0x00, 0xFF, 0x0A, 0xA0, 0x12, 0x34, 0x99];
    (0..=8)
        .flat_map(|len| ids.map(|id| Frame::new(id, &data[..len]).unwrap()))
        .zip(0..)
        .map(|(frame, n)| (SimTime::from_micros(n * 10_123), frame))
        .collect()
}

fn our_log() -> Vec<u8> {
    let start = Duration::from_secs(1_758_440_579);
    let mut writer = Writer::new(Vec::new(), "can0").starting_at(start);
    frames().iter().for_each(|(at, frame)| writer.write(*at, frame).unwrap());
    writer.into_inner()
}

#[test]
fn log2asc_reads_our_log() {
    let asc = output("log2asc", &["-I", "/dev/stdin", "can0"], &our_log());
    let Some(asc) = skips("log2asc (can-utils)", asc) else { return };
    let rows: Vec<Vec<&str>> = asc
        .lines()
        .map(|line| line.split_whitespace().collect::<Vec<_>>())
        .filter(|row| row.get(3) == Some(&"Rx"))
        .collect();
    assert_eq!(rows.len(), frames().len(), "{asc}");
    for (row, (_, frame)) in rows.iter().zip(frames()) {
        // 0.000000 1 CFF4027x Rx d 2 55 0A
        let mark = if frame.id().is_extended() { "x" } else { "" };
        assert_eq!(row[2], format!("{:X}{mark}", frame.id().raw()));
        assert_eq!(row[5], frame.data().len().to_string());
        let data: Vec<String> = frame.data().iter().map(|byte| format!("{byte:02X}")).collect();
        assert_eq!(row[6..6 + data.len()], data);
    }
}

#[test]
fn python_can_reads_our_log() {
    const SCRIPT: &str = "
import can
for m in can.CanutilsLogReader('/dev/stdin'):
    assert not (m.is_remote_frame or m.is_error_frame or m.is_fd)
    print(f'{m.timestamp:.6f}', m.channel, m.is_extended_id, m.arbitration_id, m.data.hex(), sep=',')
";
    let read = output("python3", &["-c", SCRIPT], &our_log());
    let Some(read) = skips("python-can", read) else { return };
    let expected: String = frames()
        .iter()
        .map(|(at, frame)| {
            let micros = at.as_nanos() / 1_000;
            let (s, us) = (1_758_440_579 + micros / 1_000_000, micros % 1_000_000);
            let extended = if frame.id().is_extended() { "True" } else { "False" };
            let data: String = frame.data().iter().map(|byte| format!("{byte:02x}")).collect();
            format!("{s}.{us:06},can0,{extended},{},{data}\n", frame.id().raw())
        })
        .collect();
    assert_eq!(read, expected);
}

#[test]
fn we_read_what_python_can_writes() {
    const SCRIPT: &str = "
import can
w = can.CanutilsLogWriter('/dev/stdout', channel='vcan0')
M = can.Message
w(M(timestamp=1.5, arbitration_id=0x123, is_extended_id=False, data=[1, 2], is_rx=True))
w(M(timestamp=1.6, arbitration_id=0xCFF4027, is_extended_id=True, data=[], is_rx=False))
w(M(timestamp=1.7, arbitration_id=0x124, is_extended_id=False, is_remote_frame=True, dlc=4))
w(M(timestamp=1.8, is_error_frame=True))
w(M(timestamp=1.9, arbitration_id=0x125, is_extended_id=False, is_fd=True, data=[0] * 12))
w.stop()
";
    let written = output("python3", &["-c", SCRIPT], b"");
    let Some(written) = skips("python-can", written) else { return };
    let mut reader = Reader::new(written.as_bytes(), "python.log");
    let read: Vec<_> = reader
        .by_ref()
        .map(Result::unwrap)
        .map(|record| (record.at.as_nanos(), record.frame, record.direction))
        .collect();
    let expected = [
        (1_500_000_000, Frame::new(CanId::Standard(0x123), &[1, 2]), Some(Direction::Received)),
        (
            1_600_000_000,
            Frame::new(CanId::Extended(0x0CFF_4027), &[]),
            Some(Direction::Transmitted),
        ),
    ];
    assert_eq!(
        read,
        expected.map(|(at, frame, direction)| (at, frame.unwrap(), direction)),
        "{written}"
    );
    let skipped = reader.skipped();
    assert_eq!((skipped.remote, skipped.error, skipped.fd), (1, 1, 1), "{written}");
}
