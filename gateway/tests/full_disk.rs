//! The gateway's own program when its log can no longer be written.
//!
//! Needs a real bus, named in `XT28_VCAN`; `cargo xtask vcan` has one.
#![allow(clippy::disallowed_methods, clippy::disallowed_macros)] // a test of a program on its clock

mod bench;
mod vehicle;

use std::fs::File;
use std::io::{self, Write as _};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::Duration;

use bench::Bench;
use gateway::policy::Hold;
use gateway::{Gateway, GatewayConfig};
use vehicle::Variant;
use xt28_bus::{Bus, SocketCan};
use xt28_dbc::messages::DriveTarget;
use xt28_machine::{Machine, SimTime};

const TICK: Duration = Duration::from_millis(10);
/// Targets that let the machine move, heard before the log breaks.
const ARMED: usize = 20;
const STILL: Variant =
    Variant { throttle_delay_s: 0.0, steering_delay_s: 0.0, speed_factor: 1.0, noise: false };

/// The program, gone when dropped.
struct Program(Child);

impl Drop for Program {
    fn drop(&mut self) {
        let _ = self.0.kill();
    }
}

fn start(bus: &str, log: &Path) -> Program {
    let program = Command::new(env!("CARGO_BIN_EXE_gateway"))
        .args(["--bus", bus, "--policy", "hold", "--json", "--record"])
        .arg(log)
        .stdout(Stdio::piped())
        .spawn();
    Program(program.unwrap())
}

#[test]
fn a_gateway_whose_log_breaks_brings_the_machine_to_rest_before_it_ends() {
    let Ok(bus) = std::env::var("XT28_VCAN") else {
        let _ =
            writeln!(io::stdout(), "SKIPPED: XT28_VCAN names no bus; `cargo xtask vcan` has one");
        return;
    };
    // A pipe whose reader goes away is a disk that is full from then on.
    let folder = tempfile::tempdir().unwrap();
    let log = folder.path().join("log");
    assert!(Command::new("mkfifo").arg(&log).status().unwrap().success());
    let mut reader = Some(File::options().read(true).write(true).open(&log).unwrap());
    let mut program = start(&bus, &log);
    let machine = Machine::xt28();
    let hold = Gateway::new(&machine, GatewayConfig::new(&machine), Box::new(Hold));
    let mut ecus = Bench::new(hold, STILL);
    let mut socket = SocketCan::open(&bus).unwrap();
    let mut heard: Vec<DriveTarget> = Vec::new();
    let ended = (0..3000).find_map(|_| {
        let observation = ecus.vehicle.observe(ecus.now);
        for frame in ecus.frames(&observation) {
            socket.send(SimTime::ZERO, &frame).unwrap();
        }
        sleep(TICK);
        while let Some(received) = socket.receive().unwrap() {
            ecus.take(&received.frame);
            heard.extend(DriveTarget::decode(&received.frame));
        }
        if heard.iter().filter(|target| target.enable).count() > ARMED {
            reader = None;
        }
        program.0.try_wait().unwrap()
    });
    assert!(reader.is_none(), "{} targets heard: it was not armed", heard.len());
    assert_eq!(ended.expect("it ends by itself").code(), Some(2));
    let last = heard.iter().rposition(|target| target.enable).unwrap();
    let rest = &heard[last + 1..];
    assert!(rest.len() > 100 && rest[rest.len() - 1].brake, "{} targets of rest", rest.len());
    let said = std::io::read_to_string(program.0.stdout.take().unwrap()).unwrap();
    let result: serde_json::Value = serde_json::from_str(&said).unwrap();
    assert!(result["reason"].as_str().unwrap().starts_with("cannot write the log"), "{said}");
}
