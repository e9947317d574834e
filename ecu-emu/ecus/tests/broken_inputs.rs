//! Inputs that break: what each ECU says of them in its status, and what it does with the machine.

mod rig;

use rig::{Arm, Drive};
use xt28_dbc::messages::{
    ArmStatusReason, ArmStatusState, ArmTargetMode, DriveStatus, DriveStatusReason,
    DriveStatusState,
};
use xt28_ecus::{DrivePins, pins};
use xt28_machine::{PerWheel, Wheel};

#[test]
fn a_broken_position_sensor_is_a_fault_until_it_is_whole() {
    let mut arm = Arm::new();
    let whole = arm.pins;
    for ms in 0..25 {
        arm.pins.stroke_mv[Wheel::Br] = if ms < 2 { whole.stroke_mv[Wheel::Br] } else { 90.0 };
        arm.send(ArmTargetMode::ManualPosition, 200.0);
        arm.tick();
    }
    arm.send(ArmTargetMode::ManualPosition, 200.0);
    let status = arm.tick();
    assert_eq!(status.state, ArmStatusState::Fault);
    assert_eq!(status.reason, ArmStatusReason::SensorFault);
    assert_eq!(status.faults & 1, 1);
    assert_eq!(arm.out.solenoid_b_ma, PerWheel::splat(0.0));
    arm.pins = whole;
    assert_eq!(arm.tick().state, ArmStatusState::SafeStop);
}

#[test]
fn a_joint_in_doubt_is_held_while_the_machine_drives_on() {
    let mut drive = Drive::new(1.0);
    for tick in 0..20 {
        if tick == 10 {
            drive.pins.joint_front_mv = 5_000.0;
        }
        drive.send(50.0, 12.0, true);
        assert_eq!(drive.tick().state, DriveStatusState::Active);
        assert_eq!(drive.steering_ma().map(|ma| ma > 0.0), [tick < 10; 2], "tick {tick}");
        assert!(drive.out.pump_ma[1] > 195.0);
    }
}

type Break = fn(&mut DrivePins);
const JOINTS: [Break; 2] =
    [|pins| pins.joint_front_mv = 5_000.0, |pins| pins.joint_rear_mv = 199.0];

/// Half throttle and a bend for so many ticks; the last status. The sender never asks for the brake.
fn drive_on(drive: &mut Drive, ticks: usize) -> DriveStatus {
    let statuses = (0..ticks).map(|_| {
        drive.send(50.0, 12.0, true);
        drive.tick()
    });
    statuses.last().unwrap()
}

/// A drive at 0.74 m/s of which a joint sensor has just been known for broken: 200 ms after it went.
fn at_fault(broken: Break) -> Drive {
    let mut drive = Drive::new(1.0);
    assert_eq!(drive_on(&mut drive, 100).state, DriveStatusState::Active);
    broken(&mut drive.pins);
    assert_eq!(drive_on(&mut drive, 20).state, DriveStatusState::Active, "in doubt");
    let status = drive_on(&mut drive, 1);
    assert_eq!(status.state, DriveStatusState::Fault);
    assert_eq!(status.reason, DriveStatusReason::SensorFault);
    drive
}

#[test]
fn a_broken_joint_sensor_lets_the_machine_run_out_and_brakes_it() {
    for broken in JOINTS {
        let mut drive = at_fault(broken);
        assert_eq!(drive.steering_ma(), [0.0; 2]);
        let status = drive_on(&mut drive, 100);
        assert_eq!(drive.out.pump_ma, [0.0; 4], "run out in a second");
        assert!(!status.brake, "it still rolls");
        // At a stand, 0.015 m/s, the brake closes, whatever the sender says.
        drive.pins.wheel_hz = PerWheel::splat(pins::wheel_hz(0.02));
        let status = drive_on(&mut drive, 1);
        assert!(status.brake && !drive.out.brake_released);
        assert_eq!(status.state, DriveStatusState::Fault);
    }
}

#[test]
fn a_machine_that_rolls_on_with_a_broken_joint_sensor_is_braked_after_five_seconds() {
    for broken in JOINTS {
        let mut drive = at_fault(broken);
        assert!(!drive_on(&mut drive, 499).brake);
        assert!(drive_on(&mut drive, 1).brake);
    }
}

#[test]
fn a_joint_sensor_that_is_whole_again_moves_nothing_before_the_sender_has_rested() {
    let mut drive = at_fault(JOINTS[0]);
    drive.pins.joint_front_mv = pins::joint_front_mv(10.0_f64.to_radians());
    for _ in 0..100 {
        let status = drive_on(&mut drive, 1);
        assert_eq!(status.state, DriveStatusState::SafeStop);
        assert_eq!(status.reason, DriveStatusReason::Rearm);
        assert_eq!(drive.steering_ma(), [0.0; 2]);
    }
    assert_eq!(drive.out.pump_ma, [0.0; 4]);
    drive.send(0.0, 12.0, false);
    assert_eq!(drive.tick().state, DriveStatusState::Standby);
    assert_eq!(drive_on(&mut drive, 1).state, DriveStatusState::Active);
}

/// The bits as `dbc/xt28.dbc` has them: 0 joint sensor, 1 wheel speed sensor, 2 pump pressure sensor,
/// 3 supply, 4 engine.
#[test]
fn each_fault_of_the_drive_sets_its_own_bit_and_no_other() {
    let cases: [(u16, Break); 11] = [
        (0b0_0000, |_| {}),
        (0b0_0001, JOINTS[0]),
        (0b0_0001, JOINTS[1]),
        (0b0_0010, |pins| pins.wheel_hz[Wheel::Fr] = 0.0),
        (0b0_0010, |pins| pins.wheel_hz[Wheel::Bl] = f64::NAN),
        (0b0_0100, |pins| pins.pump_mv[0] = 5_000.0),
        (0b0_0100, |pins| pins.pump_mv[1] = 0.0),
        (0b0_0100, |pins| pins.pump_mv[2] = 5_000.0),
        (0b0_0100, |pins| pins.pump_mv[3] = 0.0),
        (0b0_1000, |pins| pins.supply_mv = 17_999.0),
        (0b0_1000, |pins| pins.supply_mv = 32_001.0),
    ];
    let faults = |broken: Break, engine: bool| {
        let mut drive = Drive::new(1.0);
        broken(&mut drive.pins);
        // A wheel that reads nothing is missed after a second.
        let statuses = (0..110).map(|_| {
            if engine {
                drive.hear_engine();
            }
            drive_on(&mut drive, 1)
        });
        statuses.last().unwrap().faults
    };
    for (case, (bits, broken)) in cases.into_iter().enumerate() {
        assert_eq!(faults(broken, true), bits, "case {case}");
    }
    assert_eq!(faults(|_| {}, false), 0b1_0000, "the engine is silent");
}

/// Likewise: 0 position sensor, 1 pressure sensor, 2 attitude sensor, 3 supply.
#[test]
fn each_fault_of_the_arms_sets_its_own_bit_and_no_other() {
    type BreakArm = fn(&mut Arm);
    let cases: [(u16, BreakArm); 8] = [
        (0b0000, |_| {}),
        (0b0001, |arm| arm.pins.stroke_mv[Wheel::Fr] = 5_000.0),
        (0b0001, |arm| arm.pins.stroke_mv[Wheel::Bl] = 0.0),
        (0b0010, |arm| arm.pins.pressure_a_mv[Wheel::Fl] = 5_000.0),
        (0b0010, |arm| arm.pins.pressure_b_mv[Wheel::Br] = 0.0),
        (0b0100, |arm| arm.imu = false),
        (0b1000, |arm| arm.pins.supply_mv = 17_999.0),
        (0b1000, |arm| arm.pins.supply_mv = 32_001.0),
    ];
    for (case, (bits, broken)) in cases.into_iter().enumerate() {
        let mut arm = Arm::new();
        broken(&mut arm);
        let statuses = (0..30).map(|_| {
            arm.send(ArmTargetMode::ManualPosition, 170.0);
            arm.tick()
        });
        assert_eq!(statuses.last().unwrap().faults, bits, "case {case}");
    }
}
