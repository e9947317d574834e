//! Every wheel, chamber and pump has a value of its own here: none may end up in another's place.

use xt28_dbc::messages::{
    ActCurrentFront, ActCurrentMid, ActCurrentRear, ArmTarget, ArmTargetMode, CylLoadFront,
    CylLoadMidRear, PosFront, PosMidRear, PressFront, PressMid, PressRear, PumpPressure,
    RefCurrentFront, RefCurrentMid, RefCurrentRear, WheelForceFront, WheelForceMidRear, WheelSpeed,
    WheelSpeedJoint, WheelSpeedSigned,
};
use xt28_dbc::{CanId, Frame, Outbox};
use xt28_ecus::{ArmEcu, ArmOutputs, ArmPins, DriveEcu, DriveOutputs, DrivePins, Port, pins};
use xt28_machine::{Machine, PerWheel, SimTime};

/// Strokes mm and pressures kPa, FR FL MR ML BR BL.
const STROKE_MM: [f64; 6] = [110.0, 120.0, 130.0, 140.0, 150.0, 160.0];
const PRESSURE_A_KPA: [f64; 6] = [5110.0, 5210.0, 5310.0, 5410.0, 5510.0, 5610.0];
const PRESSURE_B_KPA: [f64; 6] = [610.0, 620.0, 630.0, 640.0, 650.0, 660.0];
/// Wheel speeds, rpm; the left ones turn backward.
const SPEED_RPM: [f64; 6] = [1.0, -2.0, 3.0, -4.0, 5.0, -6.0];
const PUMP_BAR: [f64; 4] = [11.0, 22.0, 33.0, 44.0];

fn frame_of(outbox: &Outbox, id: CanId) -> Frame {
    let mut found = outbox.frames().iter().filter(|frame| frame.id() == id);
    let frame = *found.next().expect("sent every tick");
    assert!(found.next().is_none(), "{id} is sent twice");
    frame
}

macro_rules! sent {
    ($outbox:expr, $message:ident) => {
        $message::decode(&frame_of(&$outbox, $message::ID)).unwrap()
    };
}

fn arm_out() -> ArmOutputs {
    let mut ecu = ArmEcu::new(&Machine::xt28());
    // Errors of -10, +20, -40, +30, -70, +60 mm; no two targets are the same.
    let [fr_mm, fl_mm, mr_mm, ml_mm, br_mm, bl_mm] = [100.0, 140.0, 90.0, 170.0, 80.0, 220.0];
    let mode = ArmTargetMode::ManualPosition;
    let target = ArmTarget { fr_mm, fl_mm, mr_mm, ml_mm, br_mm, bl_mm, mode, counter: 0 };
    ecu.on_frame(SimTime::ZERO, Port::Can1, &target.encode().unwrap());
    let pins = ArmPins {
        stroke_mv: PerWheel(STROKE_MM.map(|mm| pins::stroke_mv(mm * 1e-3))),
        pressure_a_mv: PerWheel(PRESSURE_A_KPA.map(|kpa| pins::pressure_mv(kpa * 1e3))),
        pressure_b_mv: PerWheel(PRESSURE_B_KPA.map(|kpa| pins::pressure_mv(kpa * 1e3))),
        supply_mv: 24_000.0,
    };
    let mut out = ArmOutputs::default();
    ecu.tick(SimTime::ZERO, &pins, &mut out);
    out
}

#[test]
fn sensors_of_the_arms_keep_their_places() {
    let out = arm_out().can1;
    let (front, rest) = (sent!(out, PosFront), sent!(out, PosMidRear));
    let mm = [front.fr_mm, front.fl_mm, rest.mr_mm, rest.ml_mm, rest.br_mm, rest.bl_mm];
    assert_eq!(mm, STROKE_MM);

    let (f, m, r) = (sent!(out, PressFront), sent!(out, PressMid), sent!(out, PressRear));
    let a_kpa = [f.fr_a_kpa, f.fl_a_kpa, m.mr_a_kpa, m.ml_a_kpa, r.br_a_kpa, r.bl_a_kpa];
    assert_eq!(a_kpa, PRESSURE_A_KPA);
    let b_kpa = [f.fr_b_kpa, f.fl_b_kpa, m.mr_b_kpa, m.ml_b_kpa, r.br_b_kpa, r.bl_b_kpa];
    assert_eq!(b_kpa, PRESSURE_B_KPA);

    // kPa times 0.785 and 0.589 (daN), each cut off, then their difference.
    let (front, rest) = (sent!(out, CylLoadFront), sent!(out, CylLoadMidRear));
    let dan = [front.fr_dan, front.fl_dan, rest.mr_dan, rest.ml_dan, rest.br_dan, rest.bl_dan];
    let loads_dan = [4011 - 359, 4089 - 365, 4168 - 371, 4246 - 376, 4325 - 382, 4403 - 388];
    assert_eq!(dan, loads_dan.map(f64::from));

    // The loads times the ratio of facts 1.4 for a closed length of 0.82 m at the six strokes
    // (0.4593 at 100 mm, 0.4754 at 150 mm), cut off. The ratio's table ends at its fourth digit.
    let (front, rest) = (sent!(out, WheelForceFront), sent!(out, WheelForceMidRear));
    let dan = [front.fr_dan, front.fl_dan, rest.mr_dan, rest.ml_dan, rest.br_dan, rest.bl_dan];
    let forces_dan = [1690.0, 1736.0, 1782.0, 1828.0, 1874.0, 1919.0];
    assert!(dan.iter().zip(forces_dan).all(|(got, want)| (got - want).abs() <= 1.0), "{dan:?}");
}

#[test]
fn currents_of_the_arms_keep_their_places() {
    let out = arm_out();
    // 1.6 mA per mm of error above 400 mA: A retracts the right ones, B extends the left ones.
    let a_ma = [416.0, 0.0, 464.0, 0.0, 512.0, 0.0];
    let b_ma = [0.0, 432.0, 0.0, 448.0, 0.0, 496.0];
    assert_eq!((out.solenoid_a_ma.0, out.solenoid_b_ma.0), (a_ma, b_ma));
    let out = out.can1;
    let (f, m, r) =
        (sent!(out, RefCurrentFront), sent!(out, RefCurrentMid), sent!(out, RefCurrentRear));
    assert_eq!([f.fr_a_ma, f.fl_a_ma, m.mr_a_ma, m.ml_a_ma, r.br_a_ma, r.bl_a_ma], a_ma);
    assert_eq!([f.fr_b_ma, f.fl_b_ma, m.mr_b_ma, m.ml_b_ma, r.br_b_ma, r.bl_b_ma], b_ma);
    let (f, m, r) =
        (sent!(out, ActCurrentFront), sent!(out, ActCurrentMid), sent!(out, ActCurrentRear));
    assert_eq!([f.fr_a_ma, f.fl_a_ma, m.mr_a_ma, m.ml_a_ma, r.br_a_ma, r.bl_a_ma], a_ma);
    assert_eq!([f.fr_b_ma, f.fl_b_ma, m.mr_b_ma, m.ml_b_ma, r.br_b_ma, r.bl_b_ma], b_ma);
}

#[test]
fn sensors_of_the_drive_keep_their_places() {
    let rad_s = SPEED_RPM.map(|rpm| rpm * std::f64::consts::TAU / 60.0);
    let pins = DrivePins {
        joint_front_mv: pins::joint_front_mv(0.2),
        joint_rear_mv: pins::joint_rear_mv(-0.1),
        wheel_hz: PerWheel(rad_s.map(pins::wheel_hz)),
        wheel_forward: PerWheel(rad_s.map(|speed| speed >= 0.0)),
        pump_mv: PUMP_BAR.map(|bar| pins::pump_mv(bar * 1e5)),
        supply_mv: 24_000.0,
    };
    let mut out = DriveOutputs::default();
    DriveEcu::new(&Machine::xt28()).tick(SimTime::ZERO, &pins, &mut out);
    let out = out.can1;

    let s = sent!(out, WheelSpeedSigned);
    let rpm = [s.fr_rpm, s.fl_rpm, s.mr_rpm, s.ml_rpm, s.br_rpm, s.bl_rpm];
    assert_close(&rpm, &SPEED_RPM);
    let (four, two) = (sent!(out, WheelSpeed), sent!(out, WheelSpeedJoint));
    let unsigned = [
        four.wheel1_rpm,
        four.wheel2_rpm,
        four.wheel3_rpm,
        four.wheel4_rpm,
        two.wheel5_rpm,
        two.wheel6_rpm,
    ];
    assert_close(&unsigned, &SPEED_RPM.map(f64::abs));
    assert_close(
        &[two.front_joint_deg, two.rear_joint_deg],
        &[0.2_f64, -0.1].map(|rad| (rad.to_degrees() * 100.0).round() / 100.0),
    );
    let p = sent!(out, PumpPressure);
    assert_close(&[p.pump1_a_bar, p.pump1_b_bar, p.pump2_a_bar, p.pump2_b_bar], &PUMP_BAR);
}

fn assert_close(got: &[f64], want: &[f64]) {
    let close = got.iter().zip(want).all(|(got, want)| (got - want).abs() < 1e-9);
    assert!(got.len() == want.len() && close, "{got:?} instead of {want:?}");
}
