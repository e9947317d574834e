//! The emulator on wall time: ticks of 10 ms on an absolute schedule, lateness measured.

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use ecu_emu::{
    Emulator, EmulatorConfig, Mishaps, Operator, Profile, TICK, TRUTH_HEADER, UnheardEffect, Wire,
    write_truth_row,
};
use xt28_bus::{Bus, BusState, SocketCan};
use xt28_dbc::Outbox;
use xt28_machine::{Machine, PerWheel, SimTime};
use xt28_sim::Terrain;
use xt28_sim::effects::Overlay;

use crate::args::Args;
use crate::listening;
use crate::schedule::{STALE, Schedule};
use crate::sending::Outlet;
use crate::serial::Serial;
use crate::tell;
use crate::watch::Watch;
use crate::wire_buses::WireBuses;

type Problem = Box<dyn std::error::Error>;

/// Runs until a signal or the end of `--duration`.
pub(crate) fn run(args: &Args) -> Result<(), Problem> {
    let config = config(args)?;
    let mut bus = SocketCan::open(&args.bus)?;
    let mut wires = WireBuses::open(&args.wires)?;
    let mut serial = Serial::open(args.gnss_link.as_deref())
        .map_err(|error| format!("cannot open a pseudo-terminal for the receiver: {error}"))?;
    let mut truth = args.truth.as_deref().map(open_truth).transpose()?;
    let stop = Arc::new(AtomicBool::new(false));
    for signal in [signal_hook::consts::SIGINT, signal_hook::consts::SIGTERM] {
        signal_hook::flag::register(signal, Arc::clone(&stop))?;
    }
    let mut emulator = Emulator::new(&config);
    // What came while the machine settled, or while nobody took the line that says so, is of nobody knows when.
    // What its reader sends is heard.
    listening::discard(&mut bus)?;
    wires.discard()?;
    let settled = Instant::now();
    tell_where(&args.bus, serial.path())
        .map_err(|error| format!("cannot write to stdout: {error}"))?;
    if settled.elapsed() > STALE {
        listening::discard(&mut bus)?;
        wires.discard()?;
    }
    let (mut schedule, mut watch) = (Schedule::new(Instant::now()), Watch::default());
    let mut outlet = Outlet::default();
    let last = args.duration.map(Duration::from_secs_f64);
    let (mut now, mut out, mut bytes) = (SimTime::ZERO, Outbox::with_capacity(64), Vec::new());
    let over = |wall: SimTime| last.is_some_and(|last| wall.since(SimTime::ZERO) >= last);
    while !stop.load(Ordering::Relaxed) && !over(schedule.on_the_wall(now)) {
        listening::until_due(&mut bus, &mut emulator, now, &schedule, &mut watch)?;
        let off = [bus.take_bus_off(), bus.state() == BusState::BusOff];
        watch.news(&args.bus, off).into_iter().flatten().for_each(tell);
        let at = Instant::now();
        if schedule.is_stale(now, at) {
            wires.discard()?;
        }
        schedule.begin(now, at);
        out.clear();
        if let Some((file, path)) = &mut truth {
            write_truth_row(file, schedule.on_the_wall(now), &emulator.truth())
                .map_err(|error| format!("{}: {error}", path.display()))?;
        }
        wires.listen(now, &mut emulator)?;
        emulator.tick(now, &mut out);
        outlet.send((&mut bus, &args.bus), now, out.frames())?;
        wires.send(now, &emulator)?;
        bytes.clear();
        emulator.take_gnss(&mut bytes);
        if !bytes.is_empty() {
            serial.send(&bytes).map_err(|error| format!("{}: {error}", serial.path().display()))?;
        }
        now += TICK;
    }
    if let Some((file, path)) = &mut truth {
        file.flush().map_err(|error| format!("{}: {error}", path.display()))?;
    }
    tell(schedule);
    if let frames @ 1.. = u64::from(bus.receive_drops().unwrap_or(0)) + wires.receive_drops() {
        tell(format_args!("{frames} frames came and were lost: nobody read them in time"));
    }
    Ok(())
}

/// The reader of this line knows that the machine has settled and listens.
fn tell_where(bus: &str, gnss: &Path) -> std::io::Result<()> {
    let mut stdout = std::io::stdout().lock();
    writeln!(stdout, "{{\"bus\":\"{bus}\",\"gnss\":\"{}\"}}", gnss.display())?;
    stdout.flush()
}

fn config(args: &Args) -> Result<EmulatorConfig, Problem> {
    let machine = match &args.machine {
        Some(path) => Machine::load(path)?,
        None => Machine::xt28(),
    };
    let terrain = match &args.terrain {
        Some(path) => Terrain::load(path)?,
        None => Terrain::Flat,
    };
    let most_mm = machine.arms.stroke_max_m * 1000.0;
    if args.stroke_mm > most_mm {
        let asked_mm = args.stroke_mm;
        return Err(format!(
            "--stroke-mm {asked_mm}: this machine's cylinders go from 0 to {most_mm} mm (arms.stroke_max_m)"
        )
        .into());
    }
    let mut config = EmulatorConfig::new(machine, terrain, args.seed);
    config.stroke_m = PerWheel::splat(args.stroke_mm / 1000.0);
    if let Some(path) = &args.effects {
        let overlay = Overlay::load(path)?;
        UnheardEffect::check(args.profile, &overlay.entries)
            .map_err(|error| format!("{}: {error}", path.display()))?;
        config.effects = overlay.effects(&config.machine)?;
    }
    if let Some(path) = &args.mishaps {
        config.mishaps = Mishaps::load(path)?;
    }
    config.mishaps.faults.extend(&args.sensor_fault);
    config.solver = args.solver;
    config.profile = args.profile;
    if let Some((wire, _)) = args.wires.iter().find(|(_, interface)| *interface == args.bus) {
        return Err(format!(
            "--wire {wire}={}: that is the interface of --bus, where the same identifiers mean other \
             things; give the wire one of its own",
            args.bus
        )
        .into());
    }
    if args.profile == Profile::Paper && (args.operator.is_some() || !args.quirks.is_empty()) {
        return Err("--operator and --quirk are for the firmware of 2016; \
                    give --profile 2016 too"
            .into());
    }
    for (name, on) in &args.quirks {
        config.quirks.set(name, *on)?;
    }
    let somebody_else =
        |(wire, _): &(Wire, _)| matches!(wire, Wire::LeftArmrest | Wire::RightArmrest);
    if args.wires.iter().any(somebody_else) {
        config.operator = Operator::absent();
    }
    if let Some(path) = &args.operator {
        config.operator = Operator::load(path)?;
    }
    Ok(config)
}

fn open_truth(path: &Path) -> Result<(BufWriter<File>, PathBuf), Problem> {
    let refuse = |error| format!("{}: cannot write: {error}", path.display());
    let mut file = BufWriter::new(File::create(path).map_err(refuse)?);
    writeln!(file, "{TRUTH_HEADER}").map_err(refuse)?;
    Ok((file, path.to_owned()))
}

#[cfg(test)]
mod tests {
    use clap::Parser;

    use super::*;

    #[test]
    fn a_wire_is_refused_the_interface_of_the_bus() {
        let with = |wires: &[&str]| {
            let wires = wires.iter().flat_map(|wire| ["--wire", wire]);
            config(&Args::parse_from(["ecu-emu", "--bus", "vcan0"].into_iter().chain(wires)))
        };
        // The arm ECU would take its own copies of the inertial unit's frames, X for Y, for the unit's.
        let error = with(&["display=vcan1", "inertial=vcan0"]).unwrap_err().to_string();
        assert!(error.starts_with("--wire inertial=vcan0: "), "{error}");
        assert!(with(&["display=vcan1", "left-armrest=vcan1"]).is_ok(), "wires may share one");
    }

    #[test]
    fn a_start_beyond_the_machines_own_stroke_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("m.toml");
        let shorter =
            Machine::builtin_text().replace("stroke_max_m = 0.50 ", "stroke_max_m = 0.30 ");
        std::fs::write(&file, shorter).unwrap();
        let with = |machine: &str, mm: &str| {
            let args = ["ecu-emu", "--bus", "vcan0", "--stroke-mm", mm, "--machine", machine];
            config(&Args::parse_from(args)).map(|config| config.stroke_m[xt28_machine::Wheel::Fr])
        };
        let file = file.to_str().unwrap();
        assert_eq!(with(file, "300").unwrap(), 0.3);
        let error = with(file, "400").unwrap_err().to_string();
        assert!(error.starts_with("--stroke-mm 400: ") && error.contains("300 mm"), "{error}");
    }
}
