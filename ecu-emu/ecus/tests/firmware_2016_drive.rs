//! The drive ECU of 2016 by what its operator sees: states, brake, speed, steering, frames.

mod rig_2016;

use std::collections::BTreeMap;

use rig_2016::Drive;
use xt28_dbc::messages::{DriveCurrent, Eec1, EngineRequest, Et1, MachineService, MotorCurrent};
use xt28_dbc::{Frame, Outbox};
use xt28_ecus::Port;
use xt28_ecus::firmware_2016::Quirks;
use xt28_machine::{PerWheel, SimTime};

const NEUTRAL: u8 = 1;
const FORWARD: u8 = 4;
const REVERSE: u8 = 16;
const OVERDRIVE: u8 = 0;

fn drive() -> Drive {
    Drive::new(Quirks::firmware())
}

fn ids(outbox: &Outbox) -> BTreeMap<u32, usize> {
    let mut ids = BTreeMap::new();
    for frame in outbox.frames() {
        *ids.entry(frame.id().raw()).or_default() += 1;
    }
    ids
}

fn sent<T, E: std::fmt::Debug>(
    outbox: &Outbox,
    id: xt28_dbc::CanId,
    decode: fn(&Frame) -> Result<T, E>,
) -> T {
    decode(outbox.frames().iter().find(|frame| frame.id() == id).expect("sent")).unwrap()
}

/// Facts 2.6: 13 frames on `CAN_1` with the debug ones twice, two on `CAN_4`, one for the engine.
#[test]
fn every_tick_sends_the_whole_set() {
    let mut drive = drive();
    drive.tick();
    let once =
        [0x18FE_1010, 0x18FE_1011, 0x18FE_1012, 0x18FE_1015, 0x18FE_1016, 0x18FE_1030, 0x18FE_1031];
    let mut wanted: BTreeMap<u32, usize> = once.map(|id| (id, 1)).into();
    wanted.extend([5, 8, 0x10].map(|id| (id, 2)));
    assert_eq!(ids(&drive.out.can1), wanted);
    assert_eq!(ids(&drive.out.can4), [(0x18FE_1030, 1), (0x18FE_1031, 1)].into());
    let request: Vec<_> =
        drive.out.can3.frames().iter().map(|f| (f.id().raw(), f.data())).collect();
    // 800 rpm are 6400 eighths.
    assert_eq!(request, [(1, &[1, 0x00, 0x19, 0, 255, 0, 255, 255][..])]);
}

#[test]
fn it_wakes_in_neutral_unbraked_with_front_steering_and_half_speed() {
    let drive = drive();
    let status = drive.status();
    assert_eq!((status.drive_mode, status.parking_brake, status.turn_mode), (NEUTRAL, 0, 1));
    assert_eq!((status.coolant_deg_c, drive.out.brake_released), (-40.0, true));
    let service = sent(&drive.out.can4, MachineService::ID, MachineService::decode);
    assert_eq!(service.speed_limit_percent, 50.0);
    assert_eq!(service.fuel_level_percent, 50.0);
    assert_eq!((drive.out.pump_ma, drive.out.motor_ma), ([0.0; 4], PerWheel::splat(0.0)));
}

#[test]
fn states_drive_their_sides_and_are_refused_above_150() {
    let mut drive = drive();
    let mut state = |button| {
        drive.press(button);
        drive.status().drive_mode
    };
    assert_eq!([12, 10, 21, 11].map(&mut state), [FORWARD, REVERSE, OVERDRIVE, NEUTRAL]);
    drive.press(12);
    drive.gas(1.0);
    drive.ticks(60);
    for button in [10, 11, 21] {
        drive.press(button);
        assert_eq!(drive.status().drive_mode, FORWARD, "button {button}");
    }
    drive.ticks(2000);
    // Full pedal at the limit of 500: beyond two thirds the motors shrink to 666.
    assert_eq!(drive.out.pump_ma, [0.0, 605.0, 0.0, 605.0]);
    assert!((drive.out.motor_ma.0[0] - (650.0 - 333.0)).abs() <= 2.0, "{:?}", drive.out.motor_ma);
    drive.gas(0.0);
    drive.ticks(700);
    drive.press(10);
    assert_eq!(drive.status().drive_mode, REVERSE, "no speed is asked for");
    assert!(drive.out.pump_ma[0] > 195.0 && drive.out.pump_ma[1] == 0.0);
}

#[test]
fn overdrive_leaves_the_front_pair_alone() {
    let mut drive = drive();
    drive.press(21);
    drive.gas(0.3);
    drive.ticks(1000);
    let motor = drive.out.motor_ma.0;
    assert_eq!(motor, [0.0, 0.0, 650.0, 650.0, 650.0, 650.0]);
}

#[test]
fn the_brake_needs_a_low_pedal_and_stops_pumps_but_not_steering() {
    let mut drive = drive();
    drive.press(12);
    drive.gas(0.14);
    drive.ticks(3000);
    assert!(drive.out.pump_ma[1] > 0.0);
    drive.steer_mv = 4230;
    drive.press(16);
    assert_eq!((drive.status().parking_brake, drive.out.brake_released), (4, false));
    assert_eq!((drive.out.pump_ma, drive.out.steer_front_b_ma), ([0.0; 4], 730.0));
    assert_eq!(drive.status().drive_mode, FORWARD, "the state stays");
    drive.press(16);
    assert!(drive.out.brake_released && drive.out.pump_ma[1] > 0.0);
    drive.gas(1.0);
    drive.ticks(300);
    drive.press(16);
    assert!(drive.out.brake_released, "refused under the pedal");
}

#[test]
fn held_buttons_19_and_20_move_the_limit() {
    let mut drive = drive();
    let limit = |drive: &Drive| {
        sent(&drive.out.can4, MachineService::ID, MachineService::decode).speed_limit_percent
    };
    drive.buttons = Some(vec![19]);
    drive.ticks(250);
    assert_eq!(limit(&drive), 75.0);
    drive.buttons = Some(Vec::new());
    drive.tick();
    // The same button again is lost (facts 4.7).
    drive.buttons = Some(vec![19]);
    drive.ticks(100);
    assert_eq!(limit(&drive), 75.0);
    drive.buttons = Some(Vec::new());
    drive.tick();
    drive.buttons = Some(vec![20]);
    drive.ticks(1000);
    assert_eq!(limit(&drive), 10.0);
}

/// Facts 2.5: half degrees, cut off.
#[test]
fn the_display_shows_the_joints_in_half_degrees() {
    let mut drive = drive();
    drive.joints(10.7, -5.3);
    drive.tick();
    let status = drive.status();
    assert_eq!((status.front_joint_deg, status.rear_joint_deg), (10.5, -5.0));
}

#[test]
fn turn_modes_send_the_joystick_to_their_joints() {
    let mut drive = drive();
    drive.steer_mv = 466;
    let mut steered = |button| {
        drive.press(button);
        let o = &drive.out;
        [o.steer_front_a_ma, o.steer_front_b_ma, o.steer_rear_a_ma, o.steer_rear_b_ma]
    };
    assert_eq!(steered(13), [730.0, 0.0, 0.0, 0.0], "left by A");
    assert_eq!(steered(14), [0.0, 0.0, 730.0, 0.0]);
    assert_eq!(steered(15), [730.0, 0.0, 500.0, 0.0]);
    drive.cab.chair_mv = 0.0;
    drive.tick();
    assert_eq!((drive.out.steer_front_b_ma, drive.status().chair), (730.0, 1), "the other chair");
}

/// Facts 4.6: the joystick has the one joint, and the other follows: the rear, in reverse the front.
/// 5 deg of error at speed are 200 per mille of 85 mA above 415.
#[test]
fn following_leaves_one_joint_to_the_joystick_and_turns_the_other() {
    let mut drive = drive();
    drive.press(15);
    drive.counts([100.0; 6]);
    drive.joints(5.0, 0.0);
    let mut steered = |button, steer_mv| {
        drive.steer_mv = steer_mv;
        drive.press(button);
        let o = &drive.out;
        [o.steer_front_a_ma, o.steer_front_b_ma, o.steer_rear_a_ma, o.steer_rear_b_ma]
    };
    assert_eq!(steered(12, 466), [730.0, 0.0, 432.0, 0.0], "forward, stick to the left");
    assert_eq!(steered(12, 4230), [0.0, 730.0, 432.0, 0.0]);
    // The front is 5 deg left of the rear, so it is to turn right.
    assert_eq!(steered(10, 466), [0.0, 432.0, 730.0, 0.0], "reverse");
    assert_eq!(steered(10, 4230), [0.0, 432.0, 0.0, 730.0]);
    assert_eq!(steered(10, 2484), [0.0, 432.0, 0.0, 0.0], "nobody steers the rear");
}

#[test]
fn the_engine_is_asked_and_heard() {
    let mut drive = drive();
    let now = SimTime::ZERO;
    for frame in [
        Eec1 { engine_speed_rpm: 1234.0 }.encode().unwrap(),
        Et1 { coolant_deg_c: 85.0 }.encode().unwrap(),
    ] {
        drive.ecu.on_frame(now, Port::Can3, &frame);
    }
    drive.ticks(300);
    drive.roller_mv = 3000;
    drive.tick();
    let status = drive.status();
    assert_eq!((status.engine_speed_rpm, status.coolant_deg_c), (1230.0, 85.0));
    let request = sent(&drive.out.can3, EngineRequest::ID, EngineRequest::decode);
    assert_eq!(request.speed_rpm, 1582.0);
}

#[test]
fn measured_currents_come_in_steps_of_3_ma() {
    let mut drive = drive();
    drive.press(12);
    drive.gas(0.3);
    drive.ticks(3000);
    let current = sent(&drive.out.can1, DriveCurrent::ID, DriveCurrent::decode);
    let motors = sent(&drive.out.can1, MotorCurrent::ID, MotorCurrent::decode);
    assert_eq!(current.pump1_b_ma, (drive.out.pump_ma[1] / 3.0).floor() * 3.0);
    assert_eq!(motors.motor1_ma, (drive.out.motor_ma.0[0] / 3.0).floor() * 3.0);
}

/// A reset puts it where power-up does: in neutral, and with the parking brake released.
#[test]
fn a_reset_brakes_while_dark_and_then_lets_go() {
    let mut drive = drive();
    drive.press(12);
    drive.gas(0.5);
    drive.ticks(500);
    assert!(drive.out.pump_ma[1] > 0.0);
    drive.ecu.reset(SimTime::from_millis(drive.ms));
    drive.tick();
    assert_eq!((drive.out.pump_ma, drive.out.brake_released), ([0.0; 4], false));
    assert!(drive.out.can1.frames().is_empty() && drive.out.can4.frames().is_empty());
    drive.ticks(30);
    assert_eq!((drive.status().drive_mode, drive.out.brake_released), (NEUTRAL, true));
    assert_eq!(drive.out.pump_ma, [0.0; 4]);
}
