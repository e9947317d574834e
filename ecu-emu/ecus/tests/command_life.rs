//! Life of a command, through the frames alone: taken, refused, lost, taken up again.

use xt28_dbc::e2e::{self, AliveCounter};
use xt28_dbc::messages::{
    ArmStatus, ArmStatusMode, ArmStatusReason, ArmStatusState, ArmTarget, ArmTargetMode, ArmValve,
    DriveStatus, DriveStatusReason, DriveStatusState, DriveTarget, PosFront, RefCurrentFront,
    WheelSpeedJoint, WheelSpeedSigned,
};
use xt28_dbc::{CanId, Frame, Outbox};
use xt28_ecus::{ArmEcu, ArmOutputs, ArmPins, DriveEcu, DriveOutputs, DrivePins, Port, pins};
use xt28_machine::{Machine, PerWheel, SimTime, Wheel};

fn frame_of(outbox: &Outbox, id: CanId) -> Frame {
    *outbox.frames().iter().find(|frame| frame.id() == id).expect("sent every tick")
}

/// A frame that the arm ECU must refuse.
type BadFrame = fn(&mut Arm) -> Frame;

struct Arm {
    ecu: ArmEcu,
    now: SimTime,
    pins: ArmPins,
    out: ArmOutputs,
    target: AliveCounter,
    valve: AliveCounter,
}

impl Arm {
    fn new() -> Self {
        let pins = ArmPins {
            stroke_mv: PerWheel::splat(pins::stroke_mv(0.17)),
            pressure_a_mv: PerWheel::splat(pins::pressure_mv(7e6)),
            pressure_b_mv: PerWheel::splat(pins::pressure_mv(5e5)),
            supply_mv: 24_000.0,
        };
        Self {
            ecu: ArmEcu::new(&Machine::xt28()),
            now: SimTime::ZERO,
            pins,
            out: ArmOutputs::default(),
            target: AliveCounter::default(),
            valve: AliveCounter::default(),
        }
    }

    fn target(&mut self, mode: ArmTargetMode, mm: f64) -> Frame {
        let counter = self.target.next_count();
        ArmTarget {
            fr_mm: mm,
            fl_mm: 510.0,
            mr_mm: mm,
            ml_mm: mm,
            br_mm: mm,
            bl_mm: mm,
            mode,
            counter,
        }
        .encode()
        .unwrap()
    }

    fn send(&mut self, mode: ArmTargetMode, mm: f64) {
        let frame = self.target(mode, mm);
        self.ecu.on_frame(self.now, Port::Can1, &frame);
    }

    fn tick(&mut self) -> ArmStatus {
        self.ecu.tick(self.now, &self.pins, &mut self.out);
        self.now += ArmTarget::PERIOD;
        ArmStatus::decode(&frame_of(&self.out.can1, ArmStatus::ID)).unwrap()
    }
}

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
            arm.ecu.on_frame(arm.now, Port::Can1, &frame);
            let status = arm.tick();
            assert_eq!((status.reason, status.accepted), (reason, 0));
        }
        let frame = bad(&mut arm);
        arm.ecu.on_frame(arm.now, Port::Can1, &frame);
        assert_eq!(arm.tick().state, ArmStatusState::SafeStop, "{reason:?}");
    }
}

#[test]
fn valves_open_as_told_up_to_the_cap_while_both_streams_live() {
    let mut arm = Arm::new();
    let valve = |arm: &mut Arm| {
        let counter = arm.valve.next_count();
        let frame = ArmValve {
            fr_percent: 80.0,
            fl_percent: -10.0,
            mr_percent: 0.0,
            ml_percent: 0.0,
            br_percent: 0.0,
            bl_percent: -100.0,
            counter,
        };
        arm.ecu.on_frame(arm.now, Port::Can1, &frame.encode().unwrap());
    };
    arm.send(ArmTargetMode::ManualValve, 510.0);
    assert_eq!(arm.tick().state, ArmStatusState::Active);
    assert_eq!(arm.out.solenoid_b_ma, PerWheel::splat(0.0), "no openings yet");
    arm.send(ArmTargetMode::ManualValve, 510.0);
    valve(&mut arm);
    assert_eq!(arm.tick().mode, ArmStatusMode::ManualValve);
    assert_eq!(arm.out.solenoid_b_ma.0, [520.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    assert_eq!(arm.out.solenoid_a_ma.0, [0.0, 440.0, 0.0, 0.0, 0.0, 520.0]);
    for _ in 0..3 {
        arm.send(ArmTargetMode::ManualValve, 510.0);
        assert_eq!(arm.tick().state, ArmStatusState::Active);
    }
    arm.send(ArmTargetMode::ManualValve, 510.0);
    assert_eq!(arm.tick().state, ArmStatusState::SafeStop, "openings stayed away");
}

#[test]
fn valves_stay_closed_towards_a_stroke_end() {
    for (stroke_mm, percent, opens) in
        [(0.0, -20.0, false), (0.0, 20.0, true), (501.0, 20.0, false), (501.0, -20.0, true)]
    {
        let mut arm = Arm::new();
        arm.pins.stroke_mv = PerWheel::splat(pins::stroke_mv(stroke_mm * 1e-3));
        arm.send(ArmTargetMode::ManualValve, 510.0);
        let [fr_percent, fl_percent, mr_percent, ml_percent, br_percent, bl_percent] = [percent; 6];
        let valve = ArmValve {
            fr_percent,
            fl_percent,
            mr_percent,
            ml_percent,
            br_percent,
            bl_percent,
            counter: 0,
        };
        arm.ecu.on_frame(arm.now, Port::Can1, &valve.encode().unwrap());
        assert_eq!(arm.tick().state, ArmStatusState::Active);
        let current_ma = arm.out.solenoid_a_ma.sum() + arm.out.solenoid_b_ma.sum();
        assert_eq!(current_ma, if opens { 6.0 * 480.0 } else { 0.0 }, "{stroke_mm} {percent}");
    }
}

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

struct Drive {
    ecu: DriveEcu,
    now: SimTime,
    pins: DrivePins,
    out: DriveOutputs,
    counter: AliveCounter,
}

impl Drive {
    fn new(speed_rad_s: f64) -> Self {
        let pins = DrivePins {
            joint_front_mv: pins::joint_front_mv(10.0_f64.to_radians()),
            joint_rear_mv: pins::joint_rear_mv(5.0_f64.to_radians()),
            wheel_hz: PerWheel::splat(pins::wheel_hz(speed_rad_s)),
            wheel_forward: PerWheel::splat(speed_rad_s >= 0.0),
            pump_mv: [pins::pump_mv(25e5); 4],
            supply_mv: 24_000.0,
        };
        let ecu = DriveEcu::new(&Machine::xt28());
        let (now, out) = (SimTime::ZERO, DriveOutputs::default());
        Self { ecu, now, pins, out, counter: AliveCounter::default() }
    }

    fn send(&mut self, throttle_percent: f64, front_angle_deg: f64, enable: bool) {
        let counter = self.counter.next_count();
        let target = DriveTarget {
            throttle_percent,
            front_angle_deg,
            engine_speed_rpm: 1500.0,
            brake: false,
            enable,
            counter,
        };
        self.ecu.on_frame(self.now, Port::Can1, &target.encode().unwrap());
    }

    fn tick(&mut self) -> DriveStatus {
        self.ecu.tick(self.now, &self.pins, &mut self.out);
        self.now += DriveTarget::PERIOD;
        DriveStatus::decode(&frame_of(&self.out.can1, DriveStatus::ID)).unwrap()
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
fn a_joint_in_doubt_is_held_while_the_machine_drives_on() {
    let mut drive = Drive::new(1.0);
    for tick in 0..20 {
        if tick == 10 {
            drive.pins.joint_front_mv = 5_000.0;
        }
        drive.send(50.0, 12.0, true);
        assert_eq!(drive.tick().state, DriveStatusState::Active);
        let out = &drive.out;
        let front_ma = out.steer_front_a_ma + out.steer_front_b_ma;
        let rear_ma = out.steer_rear_a_ma + out.steer_rear_b_ma;
        assert_eq!([front_ma > 0.0, rear_ma > 0.0], [tick < 10; 2], "tick {tick}");
        assert!(out.pump_ma[1] > 195.0);
    }
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
