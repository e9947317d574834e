//! How long a task period of each ECU takes: `cargo run --release -p xt28-ecus --example tick_cost`.
//!
//! Frames in, sensors, control, all frames out. The limit is 20 us of the 10 ms period; the exit
//! code is 1 when the median of a mode is above it.
#![allow(clippy::disallowed_methods, clippy::disallowed_macros)] // a program that measures time

use std::process::ExitCode;
use std::time::{Duration, Instant};

use xt28_dbc::messages::{ArmTarget, ArmTargetMode, ArmValve, DriveTarget, Eec1};
use xt28_ecus::{ArmEcu, ArmOutputs, ArmPins, DriveEcu, DriveOutputs, DrivePins, Port, pins};
use xt28_machine::{Machine, PerWheel, SimTime};

const TICKS: u32 = 20_000;
const LIMIT_US: f64 = 20.0;

fn main() -> ExitCode {
    use ArmTargetMode::{Automatic, ManualPosition, ManualValve, Off};
    println!("task period              median    99 %");
    let mut within = true;
    for (name, mode) in [
        ("arms, off", Off),
        ("arms, automatic", Automatic),
        ("arms, manual position", ManualPosition),
        ("arms, manual valve", ManualValve),
    ] {
        within &= print(name, arm_ticks(mode));
    }
    within &= print("drive", drive_ticks());
    if within { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

fn print(name: &str, mut took: Vec<Duration>) -> bool {
    took.sort_unstable();
    let us = |share: f64| took[(share * (took.len() - 1) as f64) as usize].as_secs_f64() * 1e6;
    println!("{name:22} {:6.2} us {:6.2} us", us(0.5), us(0.99));
    us(0.5) <= LIMIT_US
}

/// Instants of the ticks, frames of the tick's commands included in what is measured.
fn measure(mut tick: impl FnMut(SimTime, u32)) -> Vec<Duration> {
    (0..TICKS)
        .map(|n| {
            let start = Instant::now();
            tick(SimTime::from_millis(u64::from(n) * 10), n);
            start.elapsed()
        })
        .collect()
}

fn arm_ticks(mode: ArmTargetMode) -> Vec<Duration> {
    let (mut ecu, mut out) = (ArmEcu::new(&Machine::xt28()), ArmOutputs::default());
    let mut pins = ArmPins {
        stroke_mv: PerWheel::splat(pins::stroke_mv(0.2)),
        pressure_a_mv: PerWheel::splat(pins::pressure_mv(7e6)),
        pressure_b_mv: PerWheel::splat(pins::pressure_mv(5e5)),
        supply_mv: 24_000.0,
    };
    measure(|now, n| {
        let counter = (n % 16) as u8;
        let [fr_mm, fl_mm, mr_mm, ml_mm, br_mm, bl_mm] = [240.0; 6];
        let target = ArmTarget { fr_mm, fl_mm, mr_mm, ml_mm, br_mm, bl_mm, mode, counter };
        ecu.on_frame(now, Port::Can1, &target.encode().expect("in range"));
        if mode == ArmTargetMode::ManualValve {
            let [fr_percent, fl_percent, mr_percent, ml_percent, br_percent, bl_percent] = [9.0; 6];
            let valve = ArmValve {
                fr_percent,
                fl_percent,
                mr_percent,
                ml_percent,
                br_percent,
                bl_percent,
                counter,
            };
            ecu.on_frame(now, Port::Can1, &valve.encode().expect("in range"));
        }
        let roll_rad = 0.05 * (f64::from(n) * 0.01).sin();
        for frame in pins::imu_frames([0.01, 0.0, 0.0], [0.0, -9.81 * roll_rad, 9.81]) {
            ecu.on_frame(now, Port::Can2, &frame);
        }
        let stroke_m = 0.2 + 0.04 * (f64::from(n) * 0.05).sin();
        pins.stroke_mv = PerWheel::splat(pins::stroke_mv(stroke_m));
        let load_pa = 7e6 + 2e6 * (f64::from(n) * 0.03).sin();
        pins.pressure_a_mv.0[n as usize % 6] = pins::pressure_mv(load_pa);
        ecu.tick(now, &pins, &mut out);
    })
}

fn drive_ticks() -> Vec<Duration> {
    let (mut ecu, mut out) = (DriveEcu::new(&Machine::xt28()), DriveOutputs::default());
    let mut pins = DrivePins {
        joint_front_mv: pins::joint_front_mv(0.1),
        joint_rear_mv: pins::joint_rear_mv(0.05),
        wheel_hz: PerWheel::splat(pins::wheel_hz(1.0)),
        wheel_forward: PerWheel::splat(true),
        pump_mv: [pins::pump_mv(25e5); 4],
        supply_mv: 24_000.0,
    };
    measure(|now, n| {
        let target = DriveTarget {
            throttle_percent: 60.0,
            front_angle_deg: 10.0,
            engine_speed_rpm: 1200.0,
            brake: false,
            enable: true,
            counter: (n % 16) as u8,
        };
        ecu.on_frame(now, Port::Can1, &target.encode().expect("in range"));
        let eec1 = Eec1 { engine_speed_rpm: 1190.0 };
        ecu.on_frame(now, Port::Can3, &eec1.encode().expect("in range"));
        pins.wheel_hz.0[n as usize % 6] = pins::wheel_hz(1.0 + 0.5 * (f64::from(n) * 0.02).sin());
        ecu.tick(now, &pins, &mut out);
    })
}
