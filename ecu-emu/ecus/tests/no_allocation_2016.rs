//! A tick of the ECUs of 2016 allocates nothing once the outboxes have grown.

mod rig_2016;

use std::alloc::System;

use rig_2016::{Arm, Drive, stroke_mv};
use stats_alloc::{INSTRUMENTED_SYSTEM, Region, StatsAlloc};
use xt28_dbc::messages::{Eec2, MachineStatus};
use xt28_ecus::firmware_2016::{Quirks, pads};
use xt28_ecus::{Port, pins};
use xt28_machine::{PerWheel, SimTime};

#[global_allocator]
static ALLOCATOR: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;

#[test]
fn a_second_of_levelling_and_driving_allocates_nothing() {
    let (mut arm, mut drive) = (Arm::new(Quirks::firmware()), Drive::new(Quirks::firmware()));
    arm.pins.pressure_a_mv = PerWheel([1500.0, 1400.0, 1300.0, 1200.0, 1100.0, 1000.0]);
    arm.until(6.0);
    arm.press(12);
    arm.press(18);
    assert!(arm.is_levelling());
    drive.press(12);
    drive.press(15);
    drive.joints(5.0, -5.0);
    drive.gas(0.8);
    let mut run = |ticks: core::ops::Range<u64>| {
        for tick in ticks {
            let now = SimTime::from_millis(10_000 + 10 * tick);
            for frame in pins::imu_frames([0.0; 3], [0.1, 0.5, 9.8]) {
                arm.ecu.on_frame(now, Port::Can2, &frame);
            }
            for frame in pads::left_frames(&[], [2350; 2]) {
                arm.ecu.on_frame(now, Port::Can3, &frame);
            }
            let status = MachineStatus { chair: 1, ..MachineStatus::default() };
            arm.ecu.on_frame(now, Port::Can4, &status.encode().unwrap());
            for frame in pads::right_frames(&[], 2000, 3000) {
                drive.ecu.on_frame(now, Port::Can2, &frame);
            }
            let load = Eec2 { load_percent: 50.0 };
            drive.ecu.on_frame(now, Port::Can3, &load.encode().unwrap());
            arm.pins.stroke_mv = PerWheel::splat(stroke_mv(200 + (tick % 50) as i32));
            arm.ecu.tick(now, &arm.pins, &mut arm.out);
            drive.ecu.tick(now, &drive.pins, &drive.cab, &mut drive.out);
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
    assert_eq!(counts.into_iter().min(), Some(0));
    assert!(arm.is_levelling() && arm.u_ma() != [0; 6]);
    assert!(drive.out.pump_ma[1] > 0.0 && drive.out.steer_rear_a_ma > 0.0);
}
