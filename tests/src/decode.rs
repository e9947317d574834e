//! Frames of a log to a [`Trace`]: wire units become SI, halves of a measurement are joined.

use xt28_dbc::{Frame, messages as m};
use xt28_machine::PerWheel;

use crate::trace::{Attitude, DriveCommand, EcuState, Fault, Motion, Trace, wrapped_rad};
use crate::trouble::TroubleReader;

/// Reads frames in bus order into a [`Trace`].
#[derive(Clone, Debug)]
pub struct Decoder {
    trace: Trace,
    stroke: Halves,
    load: Halves,
    /// Of the pendulum-arm ECU, of the transmission ECU.
    trouble: [TroubleReader; 2],
}

impl Default for Decoder {
    fn default() -> Self {
        Self {
            trace: Trace::default(),
            stroke: Halves::default(),
            load: Halves::default(),
            trouble: [ARM_ADDRESS, DRIVE_ADDRESS].map(TroubleReader::new),
        }
    }
}

/// Source addresses of the two ECUs on J1939.
const ARM_ADDRESS: u8 = 0x28;
const DRIVE_ADDRESS: u8 = 0x29;

/// A per-wheel measurement that comes in two frames of one tick: the front pair, and the others.
#[derive(Clone, Copy, Debug, Default)]
struct Halves {
    front: Option<[f64; 2]>,
    others: Option<[f64; 4]>,
}

impl Halves {
    /// The whole, once both halves are there; then waits for the next two.
    fn join(&mut self) -> Option<PerWheel<f64>> {
        let (Some([fr, fl]), Some([mr, ml, br, bl])) = (self.front, self.others) else {
            return None;
        };
        *self = Self::default();
        Some(PerWheel([fr, fl, mr, ml, br, bl]))
    }
}

const M_PER_MM: f64 = 1e-3;
const N_PER_DAN: f64 = 10.0;

impl Decoder {
    /// Takes in `frame`, which ended at `at_s` from the start of the run. A frame of ours that
    /// does not decode becomes a [`Fault`]; one that is not ours is only counted.
    pub fn push(&mut self, at_s: f64, frame: &Frame) {
        self.trace.frames += 1;
        self.trace.end_s = at_s;
        let [arm, drive] = &mut self.trouble;
        if let Some(trouble) = arm.push(frame) {
            self.trace.arm_trouble.push(at_s, trouble);
        }
        if let Some(trouble) = drive.push(frame) {
            self.trace.drive_trouble.push(at_s, trouble);
        }
        if let Err(error) = self.decode(at_s, frame) {
            self.trace.faults.push(Fault { at_s, what: format!("{frame:?}: {error}") });
        }
    }

    /// What was read.
    #[must_use]
    pub fn finish(self) -> Trace {
        self.trace
    }

    fn decode(&mut self, at_s: f64, frame: &Frame) -> Result<(), xt28_dbc::DecodeError> {
        let t = &mut self.trace;
        match frame.id() {
            m::GnssPosition::ID => {
                let p = m::GnssPosition::decode(frame)?;
                t.antenna_m.push(at_s, [p.east_mm * M_PER_MM, p.north_mm * M_PER_MM]);
            }
            m::GnssVelocity::ID => {
                let v = m::GnssVelocity::decode(frame)?;
                let velocity_m_s = [v.east_mm_s, v.north_mm_s, v.up_mm_s].map(|mm| mm * M_PER_MM);
                let heading_rad = wrapped_rad(v.heading_deg.to_radians());
                t.motion.push(at_s, Motion { velocity_m_s, heading_rad });
            }
            m::Attitude::ID => {
                let a = m::Attitude::decode(frame)?;
                let (roll_rad, pitch_rad) = (a.roll_deg.to_radians(), a.pitch_deg.to_radians());
                t.attitude.push(at_s, Attitude { roll_rad, pitch_rad });
            }
            m::WheelSpeedJoint::ID => {
                let j = m::WheelSpeedJoint::decode(frame)?;
                t.joint_rad.push(at_s, [j.front_joint_deg, j.rear_joint_deg].map(f64::to_radians));
            }
            m::WheelSpeedSigned::ID => {
                let w = m::WheelSpeedSigned::decode(frame)?;
                let rpm = [w.fr_rpm, w.fl_rpm, w.mr_rpm, w.ml_rpm, w.br_rpm, w.bl_rpm];
                let rad_s = rpm.map(|rpm| rpm * std::f64::consts::TAU / 60.0);
                t.wheel_speed_rad_s.push(at_s, PerWheel(rad_s));
            }
            _ => return self.decode_arms(at_s, frame),
        }
        Ok(())
    }

    fn decode_arms(&mut self, at_s: f64, frame: &Frame) -> Result<(), xt28_dbc::DecodeError> {
        match frame.id() {
            m::PosFront::ID => {
                let p = m::PosFront::decode(frame)?;
                self.stroke.front = Some([p.fr_mm, p.fl_mm].map(|mm| mm * M_PER_MM));
            }
            m::PosMidRear::ID => {
                let p = m::PosMidRear::decode(frame)?;
                let mm = [p.mr_mm, p.ml_mm, p.br_mm, p.bl_mm];
                self.stroke.others = Some(mm.map(|mm| mm * M_PER_MM));
            }
            m::CylLoadFront::ID => {
                let l = m::CylLoadFront::decode(frame)?;
                self.load.front = Some([l.fr_dan, l.fl_dan].map(|dan| dan * N_PER_DAN));
            }
            m::CylLoadMidRear::ID => {
                let l = m::CylLoadMidRear::decode(frame)?;
                let dan = [l.mr_dan, l.ml_dan, l.br_dan, l.bl_dan];
                self.load.others = Some(dan.map(|dan| dan * N_PER_DAN));
            }
            _ => return self.decode_commands(at_s, frame),
        }
        if let Some(stroke_m) = self.stroke.join() {
            self.trace.stroke_m.push(at_s, stroke_m);
        }
        if let Some(load_n) = self.load.join() {
            self.trace.cylinder_load_n.push(at_s, load_n);
        }
        Ok(())
    }

    fn decode_commands(&mut self, at_s: f64, frame: &Frame) -> Result<(), xt28_dbc::DecodeError> {
        let t = &mut self.trace;
        match frame.id() {
            m::ArmTarget::ID => {
                let a = m::ArmTarget::decode(frame)?;
                let mm = [a.fr_mm, a.fl_mm, a.mr_mm, a.ml_mm, a.br_mm, a.bl_mm];
                let hold_mm = 510.0; // raw 255
                let target = mm.map(|mm| (mm < hold_mm).then_some(mm * M_PER_MM));
                t.stroke_target_m.push(at_s, PerWheel(target));
            }
            m::DriveTarget::ID => {
                let d = m::DriveTarget::decode(frame)?;
                let command = DriveCommand {
                    throttle: d.throttle_percent / 100.0,
                    front_joint_rad: d.front_angle_deg.to_radians(),
                    enable: d.enable,
                };
                t.drive_target.push(at_s, command);
            }
            m::ArmStatus::ID => {
                let state = match m::ArmStatus::decode(frame)?.state {
                    m::ArmStatusState::Init => EcuState::Init,
                    m::ArmStatusState::Standby => EcuState::Standby,
                    m::ArmStatusState::Active => EcuState::Active,
                    m::ArmStatusState::SafeStop => EcuState::SafeStop,
                    m::ArmStatusState::Fault => EcuState::Fault,
                };
                t.arm_state.push(at_s, state);
            }
            m::DriveStatus::ID => {
                let state = match m::DriveStatus::decode(frame)?.state {
                    m::DriveStatusState::Init => EcuState::Init,
                    m::DriveStatusState::Standby => EcuState::Standby,
                    m::DriveStatusState::Active => EcuState::Active,
                    m::DriveStatusState::SafeStop => EcuState::SafeStop,
                    m::DriveStatusState::Fault => EcuState::Fault,
                };
                t.drive_state.push(at_s, state);
            }
            _ => {}
        }
        Ok(())
    }
}
