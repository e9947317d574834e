//! A run on a real CAN interface: emulator, gateway and candump as programs of their own.
//!
//! Nothing here spins: the runner sleeps from one deadline to the next, so it also runs under a
//! kernel whose time only passes when all sleep.

mod program;

use std::env;
use std::ffi::OsString;
use std::fs::{self, File};
use std::io::BufReader;
use std::path::Path;
use std::thread;
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use program::{Output, Program};
use rustix::process::Signal;
use xt28_bus::SocketCan;
use xt28_machine::SimTime;
use xt28_scenarios::{
    Cost, Driven, GatewayOrder, Incident, Node, Quirks, Recording, Setup, Truth, sha256,
};
use xt28_sim::TerrainSpec;

use crate::Failure;
use crate::artefacts::Artefacts;

/// How long candump may take to open its socket. It does not say when it has.
const CANDUMP_START: Duration = Duration::from_millis(300);
/// How much longer than the run emulator and gateway are let, s. They end by themselves where this program was
/// ended before it could end them.
const BEYOND_S: f64 = 60.0;
/// Silence after which candump ends by itself as well, ms.
const SILENCE_MS: &str = "60000";
/// How often the programs are looked after.
const WATCH: Duration = Duration::from_millis(50);

/// Runs `setup` on the CAN interface `bus`, in real time, and reads back what candump logged.
pub(crate) fn run(
    setup: &Setup,
    bus: &str,
    artefacts: &Artefacts,
) -> Result<(Recording, Cost), Failure> {
    // Opened only to be refused here, with one message, rather than by three programs.
    SocketCan::open(bus)?;
    setup.ensure_startable()?;
    if setup.listen()?.is_some_and(|listen| !listen.is_private()) {
        let policy = &setup.scenario.policy;
        let why =
            "the gateway would wait for an order to arm where others than this machine may drive";
        return Err(format!("{policy:?}: {why}; give rosbridge:PORT").into());
    }
    // Gone with the run, and nobody else's: machines in containers may share process numbers and /tmp.
    let scratch = tempfile::Builder::new().prefix("xt28-run-").tempdir()?;
    let folder = scratch.path();
    let log = artefacts.log().map_or_else(|| folder.join("candump.log"), Path::to_owned);
    let begun = Instant::now();
    let start = drive(setup, bus, folder, &log)?;
    let wall_s = begun.elapsed().as_secs_f64();

    let name = log.display().to_string();
    let trace = Recording::read(BufReader::new(File::open(&log)?), &name, start.run)?;
    let truth = folder.join(TRUTH);
    let ahead_s = start.run.since(start.emulator).as_secs_f64();
    let truth = Truth::read(BufReader::new(File::open(&truth)?), TRUTH, -ahead_s)?;
    let log_sha256 = sha256(&fs::read(&log)?);
    // A gateway that was killed has said nothing.
    let said = fs::read_to_string(folder.join(ACCOUNT))?;
    let mut driven = serde_json::from_str::<Driven>(&said).ok();
    if let Some(driven) = &mut driven {
        // The run's end is what interrupts it.
        driven.reason.take_if(|reason| reason == "interrupted");
    }
    let recording = Recording { trace, truth: Some(truth), driven, log_sha256, bus_load: None };
    Ok((recording, Cost { wall_s, physics_step_us: None, lateness_max_ms: None }))
}

/// File name of what the gateway says of itself at its end.
const ACCOUNT: &str = "gateway.json";
/// File name of the emulator's truth.
const TRUTH: &str = "truth.csv";

/// Wall time of the starts, since 1970.
struct Start {
    /// When the emulator was ready.
    emulator: SimTime,
    /// When the gateway was started: the zero of the run.
    run: SimTime,
}

/// Starts the programs, lets the run pass, and stops them.
fn drive(setup: &Setup, bus: &str, folder: &Path, log: &Path) -> Result<Start, Failure> {
    let recorder = ["-L", "-T", SILENCE_MS, bus];
    let mut candump = Program::start("candump", &recorder, Output::To(File::create(log)?))?;
    thread::sleep(CANDUMP_START);
    let arguments = emulator_arguments(setup, bus, folder)?;
    let mut emulator = Program::start_beside("ecu-emu", &arguments, Output::Read)?;
    let gnss = gnss_path(&mut emulator)?;
    let emulator_start = since_1970()?;
    let arguments = gateway_arguments(setup, bus, gnss, folder)?;
    let (run_start, begun) = (since_1970()?, Instant::now());
    let account = Output::To(File::create(folder.join(ACCOUNT))?);
    let mut gateway = Program::start_beside("gateway", &arguments, account)?;

    let mut events = setup.scenario.events.clone();
    events.sort_by(|a, b| a.at_s.total_cmp(&b.at_s));
    for event in &events {
        let due = begun + Duration::from_secs_f64(event.at_s);
        sleep_watching(due, &mut [&mut candump, &mut emulator, &mut gateway])?;
        match event.what {
            Incident::Kill(Node::Gateway) => gateway.kill()?,
            Incident::Kill(Node::Emulator) => emulator.kill()?,
            Incident::Order(GatewayOrder::Arm) => gateway.signal(Signal::USR1)?,
            Incident::Order(GatewayOrder::EmergencyStop) => gateway.signal(Signal::USR2)?,
            // The emulator has it from its command line.
            Incident::Power(_) => {}
        }
    }
    let end = begun + Duration::from_secs_f64(setup.scenario.duration_s);
    sleep_watching(end, &mut [&mut candump, &mut emulator, &mut gateway])?;
    // The log ends here, before the programs say goodbye.
    candump.stop()?;
    gateway.stop()?;
    emulator.stop()?;
    Ok(Start { emulator: emulator_start, run: run_start })
}

fn since_1970() -> Result<SimTime, Failure> {
    Ok(SimTime::ZERO + SystemTime::now().duration_since(UNIX_EPOCH)?)
}

/// Sleeps until `due`; an error if one of the programs ends before.
fn sleep_watching(due: Instant, programs: &mut [&mut Program]) -> Result<(), Failure> {
    loop {
        for program in programs.iter_mut() {
            program.must_run()?;
        }
        let left = due.saturating_duration_since(Instant::now());
        if left.is_zero() {
            return Ok(());
        }
        thread::sleep(left.min(WATCH));
    }
}

/// The arguments of a program. Paths go as they are: not all of them are text.
type Arguments = Vec<OsString>;

/// Adds an option and its value.
fn add(arguments: &mut Arguments, option: &str, value: impl Into<OsString>) {
    arguments.extend([option.into(), value.into()]);
}

fn emulator_arguments(setup: &Setup, bus: &str, folder: &Path) -> Result<Arguments, Failure> {
    let mut arguments = Arguments::new();
    let mut add = |option: &str, value: OsString| add(&mut arguments, option, value);
    add("--bus", bus.into());
    add("--duration", (setup.scenario.duration_s + BEYOND_S).to_string().into());
    add("--seed", setup.seed.to_string().into());
    add("--solver", setup.solver.to_string().into());
    add("--truth", folder.join(TRUTH).into());
    if let Some(machine) = setup.machine_file() {
        add("--machine", machine.into());
    }
    add("--profile", setup.scenario.profile.to_string().into());
    let (as_is, wanted) = (Quirks::firmware().list(), setup.scenario.quirks.list());
    for ((name, on), _) in wanted.into_iter().zip(as_is).filter(|(wanted, as_is)| wanted != as_is) {
        add("--quirk", format!("{name}={}", if on { "on" } else { "off" }).into());
    }
    if let Some(cab) = &setup.scenario.cab {
        let file = folder.join("operator.toml");
        fs::write(&file, &cab.text)?;
        add("--operator", file.into());
    }
    if !setup.overlay.entries.is_empty() {
        let file = folder.join("effects.toml");
        fs::write(&file, setup.overlay.to_toml())?;
        add("--effects", file.into());
    }
    let mishaps = setup.scenario.mishaps();
    if !mishaps.is_empty() {
        let file = folder.join("mishaps.toml");
        fs::write(&file, mishaps.to_toml())?;
        add("--mishaps", file.into());
    }
    if setup.scenario.terrain.spec != TerrainSpec::default() {
        add("--terrain", terrain_file(setup, folder)?);
    }
    Ok(arguments)
}

/// The ground as a file. Files that it names are looked for beside it, which is new.
fn terrain_file(setup: &Setup, folder: &Path) -> Result<OsString, Failure> {
    let terrain = setup.scenario.terrain.spec.clone().beside(&env::current_dir()?);
    let file = folder.join("terrain.toml");
    fs::write(&file, terrain.to_toml()?)?;
    Ok(file.into())
}

fn gateway_arguments(
    setup: &Setup,
    bus: &str,
    gnss: String,
    folder: &Path,
) -> Result<Arguments, Failure> {
    // Beyond the run's end, so that a gateway whose task is done stays on the bus to the end.
    let duration_s = setup.scenario.duration_s + BEYOND_S;
    let policy = policy_argument(setup, folder)?;
    let mut arguments = Arguments::from(["--json".into()]);
    let mut add = |option: &str, value: OsString| add(&mut arguments, option, value);
    add("--bus", bus.into());
    add("--policy", policy);
    add("--gnss", gnss.into());
    add("--duration", duration_s.to_string().into());
    // One that nobody lets arm, as beside the firmware of 2016, is on the bus to the end as well.
    add("--arm-within", duration_s.to_string().into());
    if let Some(machine) = setup.machine_file() {
        add("--machine", machine.into());
    }
    if setup.takes_map() {
        add("--map", terrain_file(setup, folder)?);
    }
    Ok(arguments)
}

/// The policy as the gateway's command line takes it; a script is written to a file first.
fn policy_argument(setup: &Setup, folder: &Path) -> Result<OsString, Failure> {
    let Some(script) = &setup.scenario.script else {
        return Ok(setup.scenario.policy.clone().into());
    };
    let file = folder.join("script.toml");
    fs::write(&file, &script.text)?;
    let mut argument = OsString::from("script:");
    argument.push(file);
    Ok(argument)
}

/// The emulator says where its GNSS receiver is, in the first line of its output.
fn gnss_path(emulator: &mut Program) -> Result<String, Failure> {
    let line = emulator.first_line()?;
    let said: serde_json::Value = serde_json::from_str(&line)
        .map_err(|error| format!("ecu-emu said `{}`, not a line of JSON: {error}", line.trim()))?;
    let path = said["gnss"].as_str();
    Ok(path.ok_or_else(|| format!("ecu-emu said `{}`, without gnss", line.trim()))?.to_owned())
}

#[cfg(test)]
mod tests {
    use xt28_scenarios::Scenario;

    use super::*;

    #[test]
    fn a_gateway_that_never_arms_does_not_leave_before_the_runs_end() {
        let setup = Setup::new(Scenario::find("2016-pedal").unwrap(), None).unwrap();
        let folder = Path::new("unused");
        let arguments = gateway_arguments(&setup, "vcan0", "/dev/null".into(), folder).unwrap();
        for option in ["--duration", "--arm-within"] {
            let at = arguments.iter().position(|argument| argument == option).expect(option);
            let until_s: f64 = arguments[at + 1].to_str().unwrap().parse().unwrap();
            assert!(until_s > setup.scenario.duration_s, "{option} {until_s}");
        }
    }
}
