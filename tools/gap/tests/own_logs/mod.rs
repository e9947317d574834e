//! Logs of our own machine with effects put in, written as frames and read as any log is.
#![allow(dead_code)] // each test uses a part

use std::fmt::Write as _;
use std::path::Path;

use ecu_emu::{Emulator, EmulatorConfig, TICK};
use xt28_dbc::messages::{ArmTarget, ArmTargetMode, DriveTarget, GnssPosition, GnssVelocity};
use xt28_dbc::{Frame, Outbox, XT28_DBC};
use xt28_gap::diagnosis::FieldRun;
use xt28_gap::{Decoder, FieldLog, Mapping, Terrain};
use xt28_machine::{Machine, SimTime};
use xt28_sim::{Effects, Solver};

/// Ticks at the first commands before the log begins.
pub(crate) const SETTLE: u64 = 500;
/// Ticks of a log: 12 s.
const TICKS: u64 = 1_200;

/// What is commanded at a tick: stroke of the arms, mm, throttle, %, front joint, degrees.
fn command(manoeuvre: &str, tick: u64) -> Command {
    let s = tick.saturating_sub(SETTLE) as f64 * 0.01;
    let step = |from_s: f64, to_s: f64| if (from_s..to_s).contains(&s) { 1.0 } else { 0.0 };
    match manoeuvre {
        "arms" => {
            let by =
                |k: usize| step(1.0 + 0.3 * k as f64, 4.0 + 0.3 * k as f64) - 0.6 * step(6.0, 9.0);
            let stroke_mm = |k: usize| -> f64 { 85.0 + 30.0 * by(k) };
            let strokes = core::array::from_fn(|k| 2.0 * stroke_mm(k).round());
            (strokes, 30.0 * step(5.0, 10.0), 0.0)
        }
        _ => {
            let strokes = [2.0 * f64::round(85.0 + 30.0 * step(3.0, 6.0)); 6];
            (strokes, 40.0 * step(1.0, 8.0), 10.0 * step(4.0, 9.0))
        }
    }
}

/// Stroke of the arms, mm, throttle, %, and front joint, degrees.
pub(crate) type Command = ([f64; 6], f64, f64);

fn told(command: Command, tick: u64) -> [Frame; 2] {
    let ([fr_mm, fl_mm, mr_mm, ml_mm, br_mm, bl_mm], throttle_percent, front_angle_deg) = command;
    let counter = (tick % 15) as u8;
    let mode = ArmTargetMode::ManualPosition;
    let arms = ArmTarget { fr_mm, fl_mm, mr_mm, ml_mm, br_mm, bl_mm, mode, counter };
    let drive = DriveTarget {
        throttle_percent,
        front_angle_deg,
        engine_speed_rpm: 1200.0,
        brake: false,
        enable: true,
        counter,
    };
    [arms.encode().unwrap(), drive.encode().unwrap()]
}

/// One run of the machine with these effects, on level ground, without noise.
pub(crate) fn run(manoeuvre: &str, effects: &Effects, fit: bool) -> FieldRun {
    read(manoeuvre, &text(manoeuvre, effects), fit)
}

/// The run of such a log.
pub(crate) fn read(manoeuvre: &str, text: &str, fit: bool) -> FieldRun {
    let decoder = Decoder::parse(XT28_DBC, Path::new("xt28.dbc"), &Mapping::default()).unwrap();
    let log = FieldLog::read(text.as_bytes(), manoeuvre, &decoder, false).unwrap();
    FieldRun::new(log, Terrain::Flat, fit).unwrap()
}

/// The log of such a run, as candump writes it, from 1 s on.
pub(crate) fn text(manoeuvre: &str, effects: &Effects) -> String {
    text_of(&|tick| command(manoeuvre, tick), TICKS, effects)
}

/// The same of a drive that is told `command` at each tick of the settling and of so many after.
pub(crate) fn text_of(command: &dyn Fn(u64) -> Command, ticks: u64, effects: &Effects) -> String {
    let config = EmulatorConfig {
        effects: effects.clone(),
        solver: Solver::Reduced,
        ..EmulatorConfig::new(Machine::xt28(), Terrain::Flat, None)
    };
    let mut emulator = Emulator::new(&config);
    let (mut text, mut outbox) = (String::new(), Outbox::with_capacity(64));
    for tick in 0..SETTLE + ticks {
        let now = SimTime::from_nanos(tick * TICK.as_nanos() as u64);
        let at_s = tick.saturating_sub(SETTLE) as f64 * 0.01;
        let mut log = |later_s: f64, frame: &Frame| {
            if tick >= SETTLE {
                let data: String = frame.data().iter().map(|byte| format!("{byte:02X}")).collect();
                let _ = writeln!(
                    text,
                    "({:.6}) can0 {:08X}#{data}",
                    1.0 + at_s + later_s,
                    frame.id().raw()
                );
            }
        };
        for frame in told(command(tick), tick) {
            log(0.0, &frame);
            emulator.on_frame(now, &frame);
        }
        let truth = emulator.truth();
        emulator.tick(now, &mut outbox);
        outbox.frames().iter().for_each(|frame| log(0.002, frame));
        outbox.clear();
        if tick % 12 == 0 {
            let [east_mm, north_mm, _] = truth.antenna_position_m.map(|m| m * 1e3);
            log(0.002, &GnssPosition { east_mm, north_mm }.encode().unwrap());
            let heading_deg = truth.yaw_rad.to_degrees().rem_euclid(360.0);
            let said = GnssVelocity { heading_deg, ..GnssVelocity::default() };
            log(0.002, &said.encode().unwrap());
        }
    }
    text
}
