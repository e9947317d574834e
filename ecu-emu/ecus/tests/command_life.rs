//! Life of a command, through the frames alone: taken, refused, lost, taken up again.

mod rig;

use rig::{Arm, Drive, frame_of};
use xt28_dbc::Frame;
use xt28_dbc::e2e::{self, AliveCounter};
use xt28_dbc::messages::{
    ArmStatusMode, ArmStatusReason, ArmStatusState, ArmTarget, ArmTargetMode, DriveStatusReason,
    DriveStatusState, PosFront, RefCurrentFront, WheelSpeedJoint, WheelSpeedSigned,
};
use xt28_ecus::pins;
use xt28_machine::{PerWheel, Wheel};

/// A frame that the arm ECU must refuse.
type BadFrame = fn(&mut Arm) -> Frame;

#[test]
fn a_position_stream_is_active_from_its_first_frame() {
    let mut arm = Arm::new();
    arm.send(ArmTargetMode::ManualPosition, 200.0);
    let status = arm.tick();
    assert_eq!(status.state, ArmStatusState::Active);
    assert_eq!(status.mode, ArmStatusMode::ManualPosition);
    assert_eq!(status.supply_v, 24.0);
    // 30 mm of error: opening 0.12003, 48 mA above the dead-band, on B. FL is held.
    assert_eq!(arm.out.solenoid_b_ma[Wheel::Fr], 448.0);
    assert_eq!(arm.out.solenoid_a_ma, PerWheel::splat(0.0));
    assert_eq!(arm.out.solenoid_b_ma[Wheel::Fl], 0.0);
    let reference = RefCurrentFront::decode(&frame_of(&arm.out.can1, RefCurrentFront::ID)).unwrap();
    assert_eq!((reference.fr_b_ma, reference.fl_b_ma), (448.0, 0.0));
    let position = PosFront::decode(&frame_of(&arm.out.can1, PosFront::ID)).unwrap();
    assert_eq!((position.fr_mm, position.fl_mm), (170.0, 170.0));
}

#[test]
fn a_lost_stream_stops_within_three_periods_and_needs_rest_to_come_back() {
    let mut arm = Arm::new();
    arm.send(ArmTargetMode::ManualPosition, 200.0);
    let states: Vec<_> = (0..5).map(|_| arm.tick().state).collect();
    use ArmStatusState::{Active, SafeStop};
    assert_eq!(states, [Active, Active, Active, Active, SafeStop]);
    assert_eq!(arm.out.solenoid_b_ma, PerWheel::splat(0.0));
    assert_eq!(arm.tick().reason, ArmStatusReason::Deadline);

    for _ in 0..10 {
        arm.send(ArmTargetMode::ManualPosition, 200.0);
        let status = arm.tick();
        assert_eq!((status.state, status.reason), (SafeStop, ArmStatusReason::Rearm));
    }
    arm.send(ArmTargetMode::Off, 0.0);
    assert_eq!(arm.tick().state, ArmStatusState::Standby);
    arm.send(ArmTargetMode::ManualPosition, 200.0);
    assert_eq!(arm.tick().state, Active);
}

#[test]
fn refused_frames_say_why_and_do_not_feed_the_deadline() {
    let cases: [(BadFrame, ArmStatusReason); 5] = [
        (
            |arm| {
                // Mode 7 does not exist; the checksum is right for it.
                let mut frame = arm.target(ArmTargetMode::ManualPosition, 200.0);
                let data = frame.data_mut();
                data[6] = (data[6] & 0xF0) | 7;
                data[7] = e2e::crc(ArmTarget::DATA_ID, &data[..7]);
                frame
            },
            ArmStatusReason::Mode,
        ),
        (|arm| arm.target(ArmTargetMode::Automatic, 502.0), ArmStatusReason::Range),
        (|arm| arm.target(ArmTargetMode::ManualPosition, 502.0), ArmStatusReason::Range),
        (
            |arm| {
                let mut frame = arm.target(ArmTargetMode::ManualPosition, 200.0);
                frame.data_mut()[0] ^= 0x10;
                frame
            },
            ArmStatusReason::Crc,
        ),
        (
            |arm| {
                arm.target = AliveCounter::default();
                arm.target(ArmTargetMode::ManualPosition, 200.0)
            },
            ArmStatusReason::Counter,
        ),
    ];
    for (bad, reason) in cases {
        let mut arm = Arm::new();
        arm.send(ArmTargetMode::ManualPosition, 200.0);
        arm.tick();
        for _ in 0..3 {
            let frame = bad(&mut arm);
            arm.hear(&frame);
            let status = arm.tick();
            assert_eq!((status.reason, status.accepted), (reason, 0));
        }
        let frame = bad(&mut arm);
        arm.hear(&frame);
        assert_eq!(arm.tick().state, ArmStatusState::SafeStop, "{reason:?}");
    }
}

#[test]
fn throttle_and_angle_become_currents() {
    let mut drive = Drive::new(-1.0);
    for _ in 0..300 {
        drive.send(-50.0, 12.0, true);
        assert_eq!(drive.tick().state, DriveStatusState::Active);
    }
    // Half throttle in reverse, with an engine asked for 1500 instead of 1200 rpm: 0.4 of full speed,
    // so the pumps are full on A and the motors at a third over that.
    let [a1, b1, a2, b2] = drive.out.pump_ma;
    assert_eq!((b1, b2, a1), (0.0, 0.0, a2));
    assert!((a1 - 605.0).abs() < 1e-9, "{a1}");
    let motor_ma = drive.out.motor_ma[Wheel::Ml];
    assert!((motor_ma - (650.0 - 500.0 / 1.2)).abs() < 1e-6, "{motor_ma}");
    // 2 deg to the left for 3 s, from the ideal-form PI; the rear joint lags 0.6 deg.
    let front = 0.025 * (2.0 + 0.2 * 6.0);
    assert!((drive.out.steer_front_a_ma - (415.0 + 315.0 * front)).abs() < 1e-6);
    let rear = 0.025 * (0.6 + 0.2 * 1.8);
    assert!((drive.out.steer_rear_a_ma - (415.0 + 315.0 * rear)).abs() < 1e-6);
    assert_eq!((drive.out.steer_front_b_ma, drive.out.steer_rear_b_ma), (0.0, 0.0));
    // The engine is asked for 1500 rpm.
    assert_eq!(drive.out.can3.frames()[0].data()[..3], [1, 0xE0, 0x2E]);
}

#[test]
fn wheel_speeds_carry_their_direction_in_our_frame_only() {
    let mut drive = Drive::new(-1.0);
    let status = drive.tick();
    assert!((status.speed_m_s + 0.74).abs() <= 0.002, "{}", status.speed_m_s);
    let signed =
        WheelSpeedSigned::decode(&frame_of(&drive.out.can1, WheelSpeedSigned::ID)).unwrap();
    assert!((signed.bl_rpm + 9.549).abs() <= 0.05, "{signed:?}");
    let joint = WheelSpeedJoint::decode(&frame_of(&drive.out.can1, WheelSpeedJoint::ID)).unwrap();
    assert!((joint.wheel5_rpm - 9.549).abs() <= 0.005, "{joint:?}");
    assert!((joint.front_joint_deg - 10.0).abs() <= 0.005, "{joint:?}");
    assert!((joint.rear_joint_deg - 5.0).abs() <= 0.005, "{joint:?}");
}

#[test]
fn a_lost_command_rolls_out_and_brakes() {
    let mut drive = Drive::new(1.0);
    for _ in 0..200 {
        drive.send(60.0, 20.0, true);
        drive.tick();
    }
    let rolling = drive.out.pump_ma[1];
    let states: Vec<_> = (0..4).map(|_| drive.tick().state).collect();
    assert_eq!(states[2], DriveStatusState::Active);
    assert_eq!(states[3], DriveStatusState::SafeStop);
    assert_eq!(drive.out.steer_front_a_ma, 0.0, "the joints hold");
    assert!(drive.out.brake_released, "it still rolls");
    for _ in 0..100 {
        drive.tick();
    }
    assert_eq!(drive.out.pump_ma, [0.0; 4], "was {rolling} mA");
    drive.pins.wheel_hz = PerWheel::splat(pins::wheel_hz(0.02));
    let status = drive.tick();
    assert!(status.brake && !drive.out.brake_released);
    assert_eq!(status.reason, DriveStatusReason::Deadline);

    // The sender comes back in the middle of its drive: it must rest first.
    for _ in 0..5 {
        drive.send(60.0, 20.0, true);
        assert_eq!(drive.tick().reason, DriveStatusReason::Rearm);
        assert_eq!(drive.out.pump_ma, [0.0; 4]);
    }
    drive.send(0.0, 20.0, false);
    assert_eq!(drive.tick().state, DriveStatusState::Standby);
    drive.send(60.0, 20.0, true);
    assert_eq!(drive.tick().state, DriveStatusState::Active);
    assert!(drive.out.brake_released && drive.out.pump_ma[1] > 0.0);
}

#[test]
fn throttle_without_enable_is_refused() {
    let mut drive = Drive::new(0.0);
    drive.send(10.0, 0.0, false);
    let status = drive.tick();
    assert_eq!(status.state, DriveStatusState::Standby);
    assert_eq!(status.reason, DriveStatusReason::NotEnabled);
    assert_eq!(drive.out.pump_ma, [0.0; 4]);
}

/// Of a stream that comes back, two frames that ask for rest could be the tail of something older; the
/// third ends the stop. A silence between them, here of six periods, begins the count anew.
#[test]
fn a_safe_stop_of_the_arms_ends_with_the_third_frame_that_asks_for_rest() {
    use ArmStatusState::{SafeStop, Standby};
    let mut arm = Arm::new();
    arm.send(ArmTargetMode::ManualPosition, 200.0);
    let lost: Vec<_> = (0..6).map(|_| arm.tick().state).collect();
    assert_eq!(lost.last(), Some(&SafeStop));
    let mut rests = |count: usize, silence: usize| -> Vec<_> {
        let states = (0..count).map(|_| {
            arm.send(ArmTargetMode::Off, 0.0);
            arm.tick().state
        });
        let states = states.collect();
        (0..silence).for_each(|_| assert_eq!(arm.tick().state, SafeStop));
        states
    };
    assert_eq!(rests(2, 6), [SafeStop; 2]);
    assert_eq!(rests(3, 0), [SafeStop, SafeStop, Standby]);
}

#[test]
fn a_safe_stop_of_the_drive_ends_with_the_third_frame_that_asks_for_rest() {
    use DriveStatusState::{SafeStop, Standby};
    let mut drive = Drive::new(0.0);
    drive.send(20.0, 10.0, true);
    let lost: Vec<_> = (0..6).map(|_| drive.tick().state).collect();
    assert_eq!(lost.last(), Some(&SafeStop));
    let mut rests = |count: usize, silence: usize| -> Vec<_> {
        let states = (0..count).map(|_| {
            drive.send(0.0, 10.0, false);
            drive.tick().state
        });
        let states = states.collect();
        (0..silence).for_each(|_| assert_eq!(drive.tick().state, SafeStop));
        states
    };
    assert_eq!(rests(2, 6), [SafeStop; 2]);
    assert_eq!(rests(3, 0), [SafeStop, SafeStop, Standby]);
}
