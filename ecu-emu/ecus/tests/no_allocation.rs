//! A tick allocates nothing once the outboxes have grown.

use std::alloc::System;
use std::time::Duration;

use stats_alloc::{INSTRUMENTED_SYSTEM, Region, StatsAlloc};
use xt28_dbc::Frame;
use xt28_dbc::messages::{ArmTarget, ArmTargetMode, ArmValve, DriveTarget};
use xt28_ecus::{ArmEcu, ArmOutputs, ArmPins, DriveEcu, DriveOutputs, DrivePins, Port, pins};
use xt28_machine::{Machine, PerWheel, SimTime};

#[global_allocator]
static ALLOCATOR: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;

#[test]
fn a_second_of_driving_allocates_nothing_in_any_mode() {
    use ArmTargetMode::{Automatic, ManualPosition, ManualValve, Off};
    for mode in [Off, Automatic, ManualPosition, ManualValve] {
        drives_without_allocating(mode);
    }
}

fn drives_without_allocating(mode: ArmTargetMode) {
    let machine = Machine::xt28();
    let (mut arm, mut drive) = (ArmEcu::new(&machine), DriveEcu::new(&machine));
    let (mut arm_out, mut drive_out) = (ArmOutputs::default(), DriveOutputs::default());
    let mut arm_pins = ArmPins {
        stroke_mv: PerWheel::splat(pins::stroke_mv(0.1)),
        pressure_a_mv: PerWheel::splat(pins::pressure_mv(5e6)),
        pressure_b_mv: PerWheel::splat(pins::pressure_mv(5e5)),
        supply_mv: 24_000.0,
    };
    let drive_pins = DrivePins {
        joint_front_mv: pins::joint_front_mv(0.1),
        joint_rear_mv: pins::joint_rear_mv(0.05),
        wheel_hz: PerWheel::splat(pins::wheel_hz(1.0)),
        wheel_forward: PerWheel::splat(true),
        pump_mv: [pins::pump_mv(25e5); 4],
        supply_mv: 24_000.0,
    };
    let mm = 200.0;
    let mut run = |ticks: core::ops::Range<u64>| {
        for tick in ticks {
            let now = SimTime::ZERO + Duration::from_millis(10) * tick as u32;
            let counter = (tick % 16) as u8;
            let target = ArmTarget {
                fr_mm: mm,
                fl_mm: mm,
                mr_mm: mm,
                ml_mm: mm,
                br_mm: mm,
                bl_mm: mm,
                mode,
                counter,
            };
            arm.on_frame(now, Port::Can1, &target.encode().unwrap());
            if mode == ArmTargetMode::ManualValve {
                arm.on_frame(now, Port::Can1, &open_valves(counter));
            }
            for frame in pins::imu_frames([0.1, 0.0, 0.0], [0.0, 0.0, 9.81]) {
                arm.on_frame(now, Port::Can2, &frame);
            }
            let command = DriveTarget {
                throttle_percent: 60.0,
                front_angle_deg: 10.0,
                engine_speed_rpm: 1200.0,
                brake: false,
                enable: true,
                counter,
            };
            drive.on_frame(now, Port::Can1, &command.encode().unwrap());
            // Arms that stand under an open valve would be taken for stuck.
            let stroke_m = 0.15 + 0.04 * (tick as f64 * 0.05).sin();
            arm_pins.stroke_mv = PerWheel::splat(pins::stroke_mv(stroke_m));
            arm.tick(now, &arm_pins, &mut arm_out);
            drive.tick(now, &drive_pins, &mut drive_out);
        }
    };
    run(0..100);
    // The harness has a thread of its own that may allocate meanwhile: once, and not each time.
    let counts = [100, 200, 300].map(|from| {
        let region = Region::new(ALLOCATOR);
        run(from..from + 100);
        let change = region.change();
        change.allocations + change.reallocations
    });
    assert_eq!(counts.into_iter().min(), Some(0), "{mode:?}");
    let moves = arm_out.solenoid_a_ma.sum() + arm_out.solenoid_b_ma.sum() > 0.0;
    assert_eq!(moves, mode != ArmTargetMode::Off, "{mode:?}");
    assert!(arm_out.can1.frames().len() > 20 && drive_out.can1.frames().len() > 5);
}

fn open_valves(counter: u8) -> Frame {
    let [fr_percent, fl_percent, mr_percent, ml_percent, br_percent, bl_percent] = [10.0; 6];
    let valve = ArmValve {
        fr_percent,
        fl_percent,
        mr_percent,
        ml_percent,
        br_percent,
        bl_percent,
        counter,
    };
    valve.encode().unwrap()
}
