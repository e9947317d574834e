//! What the drive ECU sends every tick (facts 2.6), and its status.

use core::f64::consts::TAU;

use xt28_dbc::Outbox;
use xt28_dbc::messages::{
    DriveCurrent, DriveStatus, MachineStatus, MotorCurrent, PumpPressure, WheelSpeed,
    WheelSpeedJoint, WheelSpeedSigned,
};

use super::DriveOutputs;
use super::engine::EngineLink;
use super::sensing::DriveReadings;
use crate::Refusal;
use crate::life::State;
use crate::send::send;

const RPM_PER_RAD_S: f64 = 60.0 / TAU;
const BAR_PER_PA: f64 = 1e-5;
/// What a ten-bit signed speed can say, rpm: 4 m/s.
const SIGNED_RPM: [f64; 2] = [-51.2, 51.1];
/// What the unsigned speeds can say, rpm.
const UNSIGNED_MAX_RPM: f64 = 655.35;
/// What the status can say of the speed, m/s.
const STATUS_SPEED_M_S: [f64; 2] = [-8.192, 8.188];
/// Parking brake, turn mode and drive mode as the display has them (facts 2.5).
const BRAKE_ON: u8 = 4;
const TURN_FOLLOW: u8 = 64;
const DRIVE_NEUTRAL: u8 = 1;
const DRIVE_FORWARD: u8 = 4;
const DRIVE_REVERSE: u8 = 16;
const CHAIR_FRONT: u8 = 0;
/// The hottest coolant that the display's byte can say, degC.
const COOLANT_SHOWN_MAX_DEG_C: f64 = 127.0;

pub(super) fn sensors(r: &DriveReadings, counter: u8, out: &mut Outbox) {
    let [pump1_a_bar, pump1_b_bar, pump2_a_bar, pump2_b_bar] = r.pump_pa.map(|p| p * BAR_PER_PA);
    send(out, &PumpPressure { pump1_a_bar, pump1_b_bar, pump2_a_bar, pump2_b_bar }.encode());
    let rpm = r.wheel_rad_s.map(|w| w * RPM_PER_RAD_S);
    // Motors 1 to 6 are FR FL MR ML BR BL (odd ones on the right: assumed).
    let [wheel1_rpm, wheel2_rpm, wheel3_rpm, wheel4_rpm, wheel5_rpm, wheel6_rpm] =
        rpm.0.map(|rpm| rpm.abs().min(UNSIGNED_MAX_RPM));
    // The 2016 firmware repeats wheel 1 here by mistake; ours sends the four.
    send(out, &WheelSpeed { wheel1_rpm, wheel2_rpm, wheel3_rpm, wheel4_rpm }.encode());
    let [front_joint_deg, rear_joint_deg] = r.joint_deg;
    let joint = WheelSpeedJoint { wheel5_rpm, wheel6_rpm, front_joint_deg, rear_joint_deg };
    send(out, &joint.encode());
    let [low, high] = SIGNED_RPM;
    let [fr_rpm, fl_rpm, mr_rpm, ml_rpm, br_rpm, bl_rpm] = rpm.0.map(|rpm| rpm.clamp(low, high));
    let signed = WheelSpeedSigned { fr_rpm, fl_rpm, mr_rpm, ml_rpm, br_rpm, bl_rpm, counter };
    send(out, &signed.encode());
}

pub(super) fn currents(o: &DriveOutputs, out: &mut Outbox) {
    let [pump1_a_ma, pump1_b_ma, pump2_a_ma, pump2_b_ma] = o.pump_ma;
    let drive = DriveCurrent {
        pump1_a_ma,
        pump1_b_ma,
        pump2_a_ma,
        pump2_b_ma,
        steer_front_a_ma: o.steer_front_a_ma,
        steer_front_b_ma: o.steer_front_b_ma,
        steer_rear_a_ma: o.steer_rear_a_ma,
        steer_rear_b_ma: o.steer_rear_b_ma,
    };
    send(out, &drive.encode());
    let [motor1_ma, motor2_ma, motor3_ma, motor4_ma, motor5_ma, motor6_ma] = o.motor_ma.0;
    let motors = MotorCurrent { motor1_ma, motor2_ma, motor3_ma, motor4_ma, motor5_ma, motor6_ma };
    send(out, &motors.encode());
}

/// The frame for the display; `pump` is the displacement asked of the pumps.
pub(super) fn machine(
    r: &DriveReadings,
    brake: bool,
    pump: f64,
    engine: &EngineLink,
    out: &mut Outbox,
) {
    let [front_joint_deg, rear_joint_deg] = r.joint_deg;
    let machine = MachineStatus {
        parking_brake: if brake { BRAKE_ON } else { 0 },
        turn_mode: TURN_FOLLOW,
        drive_mode: match pump {
            p if p > 0.0 => DRIVE_FORWARD,
            p if p < 0.0 => DRIVE_REVERSE,
            _ => DRIVE_NEUTRAL,
        },
        chair: CHAIR_FRONT,
        front_joint_deg,
        rear_joint_deg,
        engine_speed_rpm: engine.speed_rpm().clamp(0.0, 2550.0),
        coolant_deg_c: engine.coolant_deg_c().min(COOLANT_SHOWN_MAX_DEG_C),
    };
    send(out, &machine.encode());
}

/// What the status frame is made of.
pub(super) struct Status {
    pub(super) state: State,
    pub(super) faults: u16,
    pub(super) accepted: u8,
    pub(super) refusal: Refusal,
    pub(super) brake: bool,
    pub(super) speed_m_s: f64,
    pub(super) counter: u8,
}

pub(super) fn status(s: &Status, out: &mut Outbox) {
    let [low, high] = STATUS_SPEED_M_S;
    let status = DriveStatus {
        state: s.state.into(),
        faults: s.faults,
        accepted: s.accepted,
        reason: s.refusal.into(),
        brake: s.brake,
        speed_m_s: s.speed_m_s.clamp(low, high),
        counter: s.counter,
    };
    send(out, &status.encode());
}

#[cfg(test)]
mod tests {
    use xt28_dbc::{CanId, Frame};
    use xt28_machine::PerWheel;

    use super::*;

    fn frame_of(outbox: &Outbox, id: CanId) -> Frame {
        *outbox.frames().iter().find(|frame| frame.id() == id).expect("sent")
    }

    /// A drive never has current on both sides of a pump, and seldom another one in each motor: its
    /// log would not show one in another's place.
    #[test]
    fn every_current_of_the_drive_is_logged_in_its_own_place() {
        let outputs = DriveOutputs {
            pump_ma: [30.0, 60.0, 90.0, 120.0],
            steer_front_a_ma: 150.0,
            steer_front_b_ma: 180.0,
            steer_rear_a_ma: 210.0,
            steer_rear_b_ma: 240.0,
            motor_ma: PerWheel([33.0, 63.0, 93.0, 123.0, 153.0, 183.0]),
            ..DriveOutputs::default()
        };
        let mut out = Outbox::default();
        currents(&outputs, &mut out);
        // Facts 2.6: bytes of 3 mA; pumps 1A 1B 2A 2B, front A B, rear A B; motors 1 to 6, two zeros.
        let drive = frame_of(&out, CanId::Extended(0x18FE_1015));
        assert_eq!(drive.data(), [10, 20, 30, 40, 50, 60, 70, 80]);
        let motors = frame_of(&out, CanId::Extended(0x18FE_1016));
        assert_eq!(motors.data(), [11, 21, 31, 41, 51, 61, 0, 0]);
    }
}
