//! The frames of the drive ECU: 13 on `CAN_1`, 2 on `CAN_4`, every tick (facts 2.5, 2.6).

use xt28_dbc::Outbox;
use xt28_dbc::messages as m;
use xt28_machine::PerWheel;

use super::sequence::DriveState;
use super::steering::TurnMode;
use super::{DriveOutputs, sensing, wheel_speed};
use crate::firmware_2016::whole::{cut, s16, u8, u16};
use crate::firmware_2016::{CabPins, Quirks};
use crate::send::send;

/// bar, rpm and deg of a hundredth.
const HUNDREDTH: f64 = 0.01;
/// mA per bit of measured currents; beyond a byte they wrap.
const MA_PER_BIT: f64 = 3.0;
const BRAKE_ON: u8 = 4;
/// Resolution of the joints on the display, 0.01 deg.
const SHOWN_JOINT: i32 = 50;

pub(super) fn sensors(
    pump: [i32; 4],
    counts: &PerWheel<i32>,
    joint: [i32; 2],
    quirks: Quirks,
    out: &mut Outbox,
) {
    let [pump1_a_bar, pump1_b_bar, pump2_a_bar, pump2_b_bar] = pump.map(|p| u16(p) * HUNDREDTH);
    send(out, &m::PumpPressure { pump1_a_bar, pump1_b_bar, pump2_a_bar, pump2_b_bar }.encode());
    let [wheel1_rpm, wheel2_rpm, wheel3_rpm, wheel4_rpm] =
        sensing::sent_speeds(counts.0, quirks).map(|count| u16(count) * HUNDREDTH);
    send(out, &m::WheelSpeed { wheel1_rpm, wheel2_rpm, wheel3_rpm, wheel4_rpm }.encode());
    let [.., fifth, sixth] = counts.0;
    let [wheel5_rpm, wheel6_rpm] = [fifth, sixth].map(|count| u16(count) * HUNDREDTH);
    let [front_joint_deg, rear_joint_deg] = joint.map(|angle| s16(angle) * HUNDREDTH);
    let joint = m::WheelSpeedJoint { wheel5_rpm, wheel6_rpm, front_joint_deg, rear_joint_deg };
    send(out, &joint.encode());
}

/// Measured currents: the commanded ones, for the output stage holds them (assumed).
pub(super) fn currents(o: &DriveOutputs, out: &mut Outbox) {
    let byte = |ma: f64| f64::from(u8(cut(ma / MA_PER_BIT))) * MA_PER_BIT;
    let [pump1_a_ma, pump1_b_ma, pump2_a_ma, pump2_b_ma] = o.pump_ma.map(byte);
    let drive = m::DriveCurrent {
        pump1_a_ma,
        pump1_b_ma,
        pump2_a_ma,
        pump2_b_ma,
        steer_front_a_ma: byte(o.steer_front_a_ma),
        steer_front_b_ma: byte(o.steer_front_b_ma),
        steer_rear_a_ma: byte(o.steer_rear_a_ma),
        steer_rear_b_ma: byte(o.steer_rear_b_ma),
    };
    send(out, &drive.encode());
    let [motor1_ma, motor2_ma, motor3_ma, motor4_ma, motor5_ma, motor6_ma] = o.motor_ma.map(byte).0;
    let motor =
        m::MotorCurrent { motor1_ma, motor2_ma, motor3_ma, motor4_ma, motor5_ma, motor6_ma };
    send(out, &motor.encode());
}

/// What display and arm ECU are told.
pub(super) struct Shown {
    pub(super) braked: bool,
    pub(super) turn: TurnMode,
    pub(super) state: DriveState,
    pub(super) chair_front: bool,
    pub(super) joint: [i32; 2],
    pub(super) engine_rpm: f64,
    pub(super) coolant_deg_c: i32,
    pub(super) limit_percent: i32,
    pub(super) mean_count: i32,
}

/// Status and service frames, which go to two wires.
pub(super) fn shown(s: &Shown, cab: &CabPins, out: &mut Outbox) {
    let [front_joint_deg, rear_joint_deg] =
        s.joint.map(|angle| f64::from(angle / SHOWN_JOINT) * 0.5);
    let status = m::MachineStatus {
        parking_brake: if s.braked { BRAKE_ON } else { 0 },
        turn_mode: s.turn as u8,
        drive_mode: s.state as u8,
        chair: u8(i32::from(!s.chair_front)),
        front_joint_deg,
        rear_joint_deg,
        engine_speed_rpm: f64::from(u8(cut(s.engine_rpm / 10.0))) * 10.0,
        coolant_deg_c: s8(s.coolant_deg_c),
    };
    send(out, &status.encode());
    let [ohm, level] = sensing::fuel(cab.fuel_ohm);
    let service = m::MachineService {
        door: u8(i32::from(cab.door_high)),
        fuel_sender: u8(ohm),
        tank_oil_deg_c: s8(cut(cab.tank_oil_deg_c)),
        fuel_level_percent: s8(level),
        speed_limit_percent: f64::from(u8(s.limit_percent)),
        speed_m_s: f64::from(u8(wheel_speed::shown(s.mean_count))) * 0.1,
    };
    send(out, &service.encode());
}

/// A signed byte, wrapped.
#[allow(clippy::cast_possible_truncation)] // wrapping is what an 8-bit store does
fn s8(value: i32) -> f64 {
    f64::from(value as i8)
}

/// Debug words: displacements and demands while the pump regulator runs, and the coolant's sum.
pub(super) fn debug(regulator: [i32; 4], coolant: [i32; 2], out: &mut Outbox) {
    #[allow(clippy::cast_possible_truncation)] // wraps, as the firmware's store does
    let [pump1, pump2, demand1, demand2] = regulator.map(|value| value as i16);
    send(out, &m::DriveDebug5 { pump1, pump2, demand1, demand2 }.encode());
    send(out, &m::DriveDebug8::default().encode());
    let [coolant, sum] = coolant;
    #[allow(clippy::cast_possible_truncation)] // as above
    let running_sum = sum as i16;
    send(out, &m::DriveDebug10 { coolant_deg_c: s16(coolant), running_sum }.encode());
}
