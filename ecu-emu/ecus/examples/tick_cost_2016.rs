//! How long a task period of the ECUs of 2016 takes:
//! `cargo run --release -p xt28-ecus --example tick_cost_2016`.
//!
//! Frames in, sensors, control, all frames out, in the dearest modes: levelling, and driving with the
//! rear joint following. The exit code is 1 when a median is above 20 us of the 10 ms period.
#![allow(clippy::disallowed_methods, clippy::disallowed_macros)] // a program that measures time

use std::process::ExitCode;
use std::time::{Duration, Instant};

use xt28_ecus::firmware_2016::{ArmEcu2016, CabPins, DriveEcu2016, Quirks, pads};
use xt28_ecus::{ArmOutputs, ArmPins, DriveOutputs, DrivePins, Port, pins};
use xt28_machine::{Machine, PerWheel, SimTime};

const TICKS: u64 = 20_000;
const LIMIT_US: f64 = 20.0;
const LEVELLING: u8 = 18;

fn main() -> ExitCode {
    println!("task period              median    99 %");
    let levelling = print("arms of 2016, levelling", levelling_ticks());
    let driving = print("drive of 2016", driving_ticks());
    if levelling && driving { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

fn print(name: &str, mut took: Vec<Duration>) -> bool {
    took.sort_unstable();
    let us = |share: f64| took[(share * (took.len() - 1) as f64) as usize].as_secs_f64() * 1e6;
    println!("{name:23} {:6.2} us {:6.2} us", us(0.5), us(0.99));
    us(0.5) <= LIMIT_US
}

fn measure(mut tick: impl FnMut(SimTime, u64)) -> Vec<Duration> {
    (0..TICKS)
        .map(|n| {
            let start = Instant::now();
            tick(SimTime::from_millis(n * 10), n);
            start.elapsed()
        })
        .collect()
}

fn levelling_ticks() -> Vec<Duration> {
    let mut ecu = ArmEcu2016::new(&Machine::xt28(), Quirks::firmware());
    let mut out = ArmOutputs::default();
    let pins = ArmPins {
        stroke_mv: PerWheel::splat(pins::stroke_mv(0.2)),
        pressure_a_mv: PerWheel::splat(pins::pressure_mv(7e6)),
        pressure_b_mv: PerWheel::splat(pins::pressure_mv(5e5)),
        supply_mv: 24_000.0,
    };
    let took = measure(|now, n| {
        // The ECU lets levelling begin 5 s after power-up.
        let pressed: &[u8] = match n {
            600..610 => &[12],
            620..630 => &[LEVELLING],
            _ => &[],
        };
        for frame in pads::left_frames(pressed, [2350; 2]) {
            ecu.on_frame(now, Port::Can3, &frame);
        }
        for frame in pins::imu_frames([0.0; 3], [0.1, 0.5, 9.8]) {
            ecu.on_frame(now, Port::Can2, &frame);
        }
        ecu.tick(now, &pins, &mut out);
    });
    assert_eq!(ecu.mode(), Some(LEVELLING), "levelling was measured");
    took
}

fn driving_ticks() -> Vec<Duration> {
    let (mut ecu, mut out) = (DriveEcu2016::new(Quirks::firmware()), DriveOutputs::default());
    let pins = DrivePins {
        joint_front_mv: pins::joint_front_mv(0.1),
        joint_rear_mv: pins::joint_rear_mv(0.0),
        wheel_hz: PerWheel::splat(pins::wheel_hz(1.0)),
        wheel_forward: PerWheel::splat(true),
        pump_mv: [pins::pump_mv(100e5); 4],
        supply_mv: 24_000.0,
    };
    let cab = CabPins { gas_mv: [3000.0; 2], ..CabPins::IDLE };
    let took = measure(|now, n| {
        let pressed: &[u8] = match n {
            10..20 => &[12],
            30..40 => &[15],
            _ => &[],
        };
        for frame in pads::right_frames(pressed, 2484, 3000) {
            ecu.on_frame(now, Port::Can2, &frame);
        }
        ecu.tick(now, &pins, &cab, &mut out);
    });
    assert!(out.pump_ma[1] > 0.0 && out.steer_rear_a_ma > 0.0, "driving was measured");
    took
}
