//! Our ECUs' laws alone, on what a log measured: no plant in between, so no error of the plant in
//! them. Says whether we read the machine's conventions rightly, current by current.
//!
//! The logs are not part of the project. Where they are not beside the workspace, these tests say
//! so on standard error and pass.
#![allow(clippy::disallowed_macros)] // a test that is skipped must be seen to be skipped

use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

use xt28_dbc::e2e::AliveCounter;
use xt28_dbc::messages::{ArmTarget, ArmTargetMode, CylLoadFront, DriveTarget, WheelForceFront};
use xt28_ecus::{ArmEcu, ArmOutputs, ArmPins, DriveEcu, DriveOutputs, DrivePins, Port, pins};
use xt28_gap::{Channel, Decoder, FieldLog, Mapping, SteerSide};
use xt28_machine::{Machine, PerWheel, SimTime, Wheel};

const RUNS: [&str; 5] = [
    "run-1-arm_step.log.gz",
    "run-2-multisine.log.gz",
    "run-3-s_turn.log.gz",
    "run-4-straight.log.gz",
    "run-5-ramp.log.gz",
];
/// Half a step of the stroke's wire signal: what is measured lies between two of them.
const HALF_MM: f64 = 0.5e-3;

fn read(file: &str) -> Option<FieldLog> {
    let folder: PathBuf =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/field-data/aux/nominal");
    if !folder.is_dir() {
        let _ = writeln!(io::stdout(), "SKIPPED: no field logs at {}", folder.display());
        return None;
    }
    let decoder = Decoder::load(&folder.join("xt28-field.dbc"), &Mapping::default()).unwrap();
    Some(FieldLog::load(&folder.join(file), &decoder, false).unwrap())
}

/// Samples of a channel that comes once a tick.
fn ticks(log: &FieldLog, channel: Channel) -> Vec<f64> {
    log.series(channel).unwrap().iter().map(|(_, value)| value).collect()
}

fn per_wheel(log: &FieldLog, make: fn(Wheel) -> Channel) -> PerWheel<Vec<f64>> {
    PerWheel::from_fn(|wheel| ticks(log, make(wheel)))
}

fn at(tick: usize) -> SimTime {
    SimTime::from_millis(10 * tick as u64)
}

fn pins_at(stroke_m: PerWheel<f64>, bore_pa: PerWheel<f64>, rod_pa: PerWheel<f64>) -> ArmPins {
    ArmPins {
        stroke_mv: stroke_m.map(pins::stroke_mv),
        pressure_a_mv: bore_pa.map(pins::pressure_mv),
        pressure_b_mv: rod_pa.map(pins::pressure_mv),
        supply_mv: 24_000.0,
    }
}

/// The arm ECU on a log's targets and strokes, its integrals brought near `start_mm_s` first by
/// strokes one millimetre beyond the target. Returns currents retract and extend, mA, of each tick.
fn arm_currents(
    targets: &PerWheel<Vec<f64>>,
    strokes: &PerWheel<Vec<f64>>,
    start_mm_s: PerWheel<f64>,
) -> Vec<[PerWheel<f64>; 2]> {
    let mut ecu = ArmEcu::new(&Machine::xt28());
    let mut out = ArmOutputs::default();
    let mut counter = AliveCounter::default();
    let mut currents = Vec::new();
    let warm_up = 1500;
    for tick in 0..warm_up + strokes[Wheel::Fr].len() {
        let logged = tick.saturating_sub(warm_up);
        let [fr_mm, fl_mm, mr_mm, ml_mm, br_mm, bl_mm] =
            targets.0.each_ref().map(|target| target[logged] * 1e3);
        let mode = ArmTargetMode::ManualPosition;
        let counter = counter.next_count();
        let frame = ArmTarget { fr_mm, fl_mm, mr_mm, ml_mm, br_mm, bl_mm, mode, counter };
        ecu.on_frame(at(tick), Port::Can1, &frame.encode().unwrap());
        let stroke_m = PerWheel::from_fn(|w| {
            let ticks_off = start_mm_s[w].abs() * 100.0;
            let off_m =
                if (tick as f64) < ticks_off { -1e-3 * start_mm_s[w].signum() } else { 0.0 };
            let stroke_m = if tick < warm_up { targets[w][0] + off_m } else { strokes[w][logged] };
            stroke_m + HALF_MM
        });
        let no_load = PerWheel::splat(1e6);
        ecu.tick(at(tick), &pins_at(stroke_m, no_load, no_load), &mut out);
        if tick >= warm_up {
            currents.push([out.solenoid_a_ma, out.solenoid_b_ma]);
        }
    }
    currents
}

/// Manual position: every reference current of every arm, from target and measured stroke. The one
/// unknown is the integral at the start of a log, which is searched for; a sample in two hundred may
/// differ where the search's step leaves the current on the other side of a whole milliampere.
#[test]
fn the_position_law_gives_the_logged_currents() {
    for run in RUNS {
        let Some(log) = read(run) else { return };
        let targets = per_wheel(&log, Channel::TargetStroke);
        let strokes = per_wheel(&log, Channel::Stroke);
        let logged =
            [per_wheel(&log, Channel::RetractCurrent), per_wheel(&log, Channel::ExtendCurrent)];
        let samples = strokes[Wheel::Fr].len();
        let mut fewest = PerWheel::splat(samples);
        for step in 0..=110 {
            let start_mm_s = PerWheel::splat(-0.1 * f64::from(step));
            let ours = arm_currents(&targets, &strokes, start_mm_s);
            for wheel in Wheel::ALL {
                let differs = |tick: &usize| {
                    let off = |side: usize| {
                        (ours[*tick][side][wheel] - logged[side][wheel][*tick] * 1e3).abs()
                    };
                    off(0) > 0.5 || off(1) > 0.5
                };
                fewest[wheel] = fewest[wheel].min((0..samples).filter(differs).count());
            }
        }
        for (wheel, wrong) in fewest.iter() {
            assert!(wrong * 200 <= samples, "{run} {wheel}: {wrong} of {samples} currents differ");
        }
    }
}

/// Steering: both valves' currents to the wire's 3 mA, from target, joint angles and wheel speeds.
#[test]
fn the_steering_law_gives_the_logged_currents() {
    let Some(log) = read("run-3-s_turn.log.gz") else { return };
    let speeds = per_wheel(&log, Channel::WheelSpeed);
    let [target, front, rear] = [Channel::TargetJoint, Channel::FrontJoint, Channel::RearJoint]
        .map(|channel| ticks(&log, channel));
    let mut ecu = DriveEcu::new(&Machine::xt28());
    let mut out = DriveOutputs::default();
    let mut counter = AliveCounter::default();
    let mut ours = Vec::new();
    for tick in 0..front.len() {
        let frame = DriveTarget {
            throttle_percent: 0.0,
            front_angle_deg: target[tick].to_degrees(),
            engine_speed_rpm: 1200.0,
            brake: false,
            enable: true,
            counter: counter.next_count(),
        };
        ecu.on_frame(at(tick), Port::Can1, &frame.encode().unwrap());
        let speed = PerWheel::from_fn(|w| speeds[w][tick]);
        let pins = DrivePins {
            joint_front_mv: pins::joint_front_mv(front[tick]),
            joint_rear_mv: pins::joint_rear_mv(rear[tick]),
            wheel_hz: speed.map(pins::wheel_hz),
            wheel_forward: speed.map(|rad_s| rad_s >= 0.0),
            pump_mv: [1000.0; 4],
            supply_mv: 24_000.0,
        };
        ecu.tick(at(tick), &pins, &mut out);
        ours.push([
            out.steer_front_a_ma,
            out.steer_front_b_ma,
            out.steer_rear_a_ma,
            out.steer_rear_b_ma,
        ]);
    }
    for (i, side) in SteerSide::ALL.into_iter().enumerate() {
        let logged = log.series(Channel::SteerCurrent(side)).unwrap();
        let (mut compared, mut wrong) = (0, 0);
        for (tick, ours) in ours.iter().enumerate().skip(1) {
            let want_ma = logged.at(tick as f64 * 0.01 + 0.008).unwrap() * 1e3;
            // Currents are logged every other tick.
            if tick % 2 == 0 {
                compared += 1;
                wrong += usize::from((ours[i] - want_ma).abs() > 3.0);
            }
        }
        assert!(wrong * 200 <= compared, "{side:?}: {wrong} of {compared} differ");
    }
}

/// Loads and wheel forces of a machine at rest, digit by digit, from the chambers' pressures.
#[test]
fn the_force_code_gives_the_logged_loads_at_rest() {
    for run in RUNS {
        let Some(log) = read(run) else { return };
        let first = |make: fn(Wheel) -> Channel| {
            PerWheel::from_fn(|w| log.series(make(w)).unwrap().iter().next().unwrap().1)
        };
        let pins = pins_at(
            first(Channel::Stroke).map(|stroke_m| stroke_m + HALF_MM),
            first(Channel::BorePressure),
            first(Channel::RodPressure),
        );
        let mut out = ArmOutputs::default();
        ArmEcu::new(&Machine::xt28()).tick(SimTime::ZERO, &pins, &mut out);
        let sent = |wanted| *out.can1.frames().iter().find(|f| f.id() == wanted).unwrap();
        let load = CylLoadFront::decode(&sent(CylLoadFront::ID)).unwrap();
        let force = WheelForceFront::decode(&sent(WheelForceFront::ID)).unwrap();
        let logged = [first(Channel::CylinderLoad), first(Channel::WheelLoad)];
        let dan = |n: f64| (n / 10.0).round();
        assert_eq!([load.fr_dan, load.fl_dan], [0, 1].map(|w| dan(logged[0].0[w])), "{run}");
        assert_eq!([force.fr_dan, force.fl_dan], [0, 1].map(|w| dan(logged[1].0[w])), "{run}");
    }
}
