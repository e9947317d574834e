//! The gateway's own program on an interface that lets next to nothing through any more.
//!
//! Needs a real bus, named in `XT28_VCAN`; `cargo xtask vcan` has one.
#![allow(clippy::disallowed_methods, clippy::disallowed_macros)] // a test of a program on its clock

mod bench;
mod vehicle;

use std::fs::File;
use std::io::{self, BufReader, Write as _};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::Duration;

use bench::Bench;
use gateway::policy::Hold;
use gateway::{Gateway, GatewayConfig};
use vehicle::Variant;
use xt28_bus::candump::Reader;
use xt28_bus::{Bus, SocketCan};
use xt28_dbc::messages::{ArmTarget, DriveTarget};
use xt28_dbc::{CanId, Frame};
use xt28_machine::{Machine, SimTime};

const NAME: &str = "xt28full";
const TICK: Duration = Duration::from_millis(10);
/// Of ordinary frames some 100 a second pass and 32 wait, where an armed gateway sends two or three every tick; urgent
/// ones pass by. As if the controller won no arbitration any more on a bus that the ECUs still have.
const SHAPED: [&str; 2] = [
    "qdisc add dev xt28full root handle 1: prio",
    "qdisc add dev xt28full parent 1:2 handle 20: tbf rate 12800bit burst 64 limit 512",
];
/// Priority of a socket whose frames are urgent: the first band of three.
const URGENT: u32 = 6;
/// Targets heard before that, which takes a gateway that is armed.
const ARMED: usize = 100;
const NOBODY: Variant =
    Variant { throttle_delay_s: 0.0, steering_delay_s: 0.0, speed_factor: 1.0, noise: false };

/// An interface of the test's own and the program on it, both gone when dropped.
struct Scene(Child);

impl Drop for Scene {
    fn drop(&mut self) {
        let _ = self.0.kill();
        run("ip", &format!("link del {NAME}"));
    }
}

fn run(program: &str, arguments: &str) -> bool {
    Command::new(program).args(arguments.split(' ')).status().is_ok_and(|status| status.success())
}

/// What the gateway wants of the ECUs, and nobody else sends.
fn is_target(id: CanId) -> bool {
    [ArmTarget::ID, DriveTarget::ID].contains(&id)
}

/// Targets that a log has, in their order.
fn logged(path: &Path) -> Vec<Frame> {
    let file = BufReader::new(File::open(path).unwrap());
    let mut log = Reader::new(file, "log");
    let records = std::iter::from_fn(|| log.read().unwrap());
    records.map(|record| record.frame).filter(|frame| is_target(frame.id())).collect()
}

#[test]
fn a_gateway_whose_frames_do_not_leave_stops_and_logs_those_that_did() {
    if std::env::var_os("XT28_VCAN").is_none() {
        let _ =
            writeln!(io::stdout(), "SKIPPED: XT28_VCAN names no bus; `cargo xtask vcan` has one");
        return;
    }
    assert!(run("ip", &format!("link add dev {NAME} type vcan")));
    assert!(run("ip", &format!("link set {NAME} up")));
    let log = tempfile::NamedTempFile::new().unwrap();
    let program = Command::new(env!("CARGO_BIN_EXE_gateway"))
        .args(["--bus", NAME, "--policy", "hold", "--json", "--record"])
        .arg(log.path())
        .stdout(Stdio::piped())
        .spawn();
    let mut scene = Scene(program.unwrap());
    let machine = Machine::xt28();
    let hold = Gateway::new(&machine, GatewayConfig::new(&machine), Box::new(Hold));
    let mut ecus = Bench::new(hold, NOBODY);
    let mut speaker = SocketCan::open(NAME).unwrap().with_priority(URGENT).unwrap();
    let mut ear = SocketCan::open(NAME).unwrap();
    let mut heard: Vec<Frame> = Vec::new();
    let mut is_shaped = false;
    let ended = (0..3000).find_map(|_| {
        let observation = ecus.vehicle.observe(ecus.now);
        for frame in ecus.frames(&observation) {
            speaker.send(SimTime::ZERO, &frame).unwrap();
        }
        sleep(TICK);
        let known = heard.len();
        hear(&mut ear, &mut heard);
        heard[known..].iter().for_each(|frame| ecus.take(frame));
        if heard.len() > ARMED && !is_shaped {
            is_shaped = true;
            SHAPED.iter().for_each(|how| assert!(run("tc", how), "no traffic shaping here: {how}"));
        }
        scene.0.try_wait().unwrap()
    });
    assert!(is_shaped, "{} targets heard: it was not armed", heard.len());
    assert_eq!(ended.expect("it ends by itself").code(), Some(1));
    // What the kernel has taken still leaves.
    for _ in 0..100 {
        sleep(TICK);
        hear(&mut ear, &mut heard);
    }
    let said = std::io::read_to_string(scene.0.stdout.take().unwrap()).unwrap();
    let result: serde_json::Value = serde_json::from_str(&said).unwrap();
    // An ECU misses its frames before the queue of 256 is full.
    let why = &result["safety_stop"]["reason"];
    assert_eq!(why, "an ECU stopped accepting our frames", "{said}");
    assert!(result["faults"]["frames_discarded"].as_u64() > Some(0), "{said}");
    assert_eq!(logged(log.path()), heard, "what is logged left, and in that order");
}

fn hear(bus: &mut SocketCan, heard: &mut Vec<Frame>) {
    while let Some(received) = bus.receive().unwrap() {
        heard.extend(Some(received.frame).filter(|frame| is_target(frame.id())));
    }
}
