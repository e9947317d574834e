//! Frames of a log to a [`Trace`]: wire units become SI, halves of a measurement are joined.

use xt28_dbc::{Frame, messages as m};
use xt28_machine::PerWheel;

use crate::Series;
use crate::frame_check::FrameCheck;
use crate::trace::{Attitude, DriveCommand, EcuState, Fault, Motion, Trace, wrapped_rad};
use crate::trouble::TroubleReader;

/// Reads frames in bus order into a [`Trace`].
#[derive(Clone, Debug)]
pub struct Decoder {
    trace: Trace,
    check: FrameCheck,
    stroke: Halves,
    load: Halves,
    /// Of the pendulum-arm ECU, of the transmission ECU.
    trouble: [TroubleReader; 2],
    /// Wheel speeds of a machine that does not say which way its wheels turn.
    unsigned_speed_rpm: Halves,
    unsigned_speed_rad_s: Series<PerWheel<f64>>,
}

impl Default for Decoder {
    fn default() -> Self {
        Self {
            trace: Trace::default(),
            check: FrameCheck::default(),
            stroke: Halves::default(),
            load: Halves::default(),
            trouble: [ARM_ADDRESS, DRIVE_ADDRESS].map(TroubleReader::new),
            unsigned_speed_rpm: Halves::default(),
            unsigned_speed_rad_s: Series::default(),
        }
    }
}

/// Source addresses of the two ECUs on J1939.
const ARM_ADDRESS: u8 = 0x28;
const DRIVE_ADDRESS: u8 = 0x29;

/// A per-wheel measurement that comes in two frames of one tick: one pair, and the four others.
#[derive(Clone, Copy, Debug, Default)]
struct Halves {
    pair: Option<[f64; 2]>,
    four: Option<[f64; 4]>,
}

impl Halves {
    /// The four and the pair, once both are there; then waits for the next two.
    fn join(&mut self) -> Option<([f64; 4], [f64; 2])> {
        let joined = self.four.zip(self.pair);
        if joined.is_some() {
            *self = Self::default();
        }
        joined
    }

    /// The whole, where the pair is the front one.
    fn join_front(&mut self) -> Option<PerWheel<f64>> {
        self.join().map(|([mr, ml, br, bl], [fr, fl])| PerWheel([fr, fl, mr, ml, br, bl]))
    }
}

const M_PER_MM: f64 = 1e-3;
const RAD_S_PER_RPM: f64 = std::f64::consts::TAU / 60.0;
const N_PER_DAN: f64 = 10.0;

impl Decoder {
    /// Takes in `frame`, which ended at `at_s` from the start of the run. A frame of our
    /// database that does not fit it becomes a [`Fault`]; one that is not of it is only counted.
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
        // Whether or not anything is read from it.
        let checked = self.check.push(at_s, frame).map_err(|problem| problem.to_string());
        let decoded = self.decode(at_s, frame).map_err(|error| error.to_string());
        if let Err(problem) = checked.and(decoded) {
            self.trace.faults.push(Fault { at_s, what: format!("{frame:?}: {problem}") });
        }
    }

    /// What was read.
    #[must_use]
    pub fn finish(mut self) -> Trace {
        if self.trace.wheel_speed_rad_s.samples().is_empty() {
            self.trace.wheel_speed_rad_s = self.unsigned_speed_rad_s;
        }
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
                self.unsigned_speed_rpm.pair = Some([j.wheel5_rpm, j.wheel6_rpm]);
            }
            m::WheelSpeed::ID => {
                let w = m::WheelSpeed::decode(frame)?;
                let rpm = [w.wheel1_rpm, w.wheel2_rpm, w.wheel3_rpm, w.wheel4_rpm];
                self.unsigned_speed_rpm.four = Some(rpm);
            }
            m::WheelSpeedSigned::ID => {
                let w = m::WheelSpeedSigned::decode(frame)?;
                let rpm = [w.fr_rpm, w.fl_rpm, w.mr_rpm, w.ml_rpm, w.br_rpm, w.bl_rpm];
                t.wheel_speed_rad_s.push(at_s, PerWheel(rpm.map(|rpm| rpm * RAD_S_PER_RPM)));
            }
            _ => return self.decode_arms(at_s, frame),
        }
        if let Some(([fr, fl, mr, ml], [br, bl])) = self.unsigned_speed_rpm.join() {
            let rad_s = [fr, fl, mr, ml, br, bl].map(|rpm| rpm * RAD_S_PER_RPM);
            self.unsigned_speed_rad_s.push(at_s, PerWheel(rad_s));
        }
        Ok(())
    }

    fn decode_arms(&mut self, at_s: f64, frame: &Frame) -> Result<(), xt28_dbc::DecodeError> {
        match frame.id() {
            m::PosFront::ID => {
                let p = m::PosFront::decode(frame)?;
                self.stroke.pair = Some([p.fr_mm, p.fl_mm].map(|mm| mm * M_PER_MM));
            }
            m::PosMidRear::ID => {
                let p = m::PosMidRear::decode(frame)?;
                let mm = [p.mr_mm, p.ml_mm, p.br_mm, p.bl_mm];
                self.stroke.four = Some(mm.map(|mm| mm * M_PER_MM));
            }
            m::CylLoadFront::ID => {
                let l = m::CylLoadFront::decode(frame)?;
                self.load.pair = Some([l.fr_dan, l.fl_dan].map(|dan| dan * N_PER_DAN));
            }
            m::CylLoadMidRear::ID => {
                let l = m::CylLoadMidRear::decode(frame)?;
                let dan = [l.mr_dan, l.ml_dan, l.br_dan, l.bl_dan];
                self.load.four = Some(dan.map(|dan| dan * N_PER_DAN));
            }
            _ => return self.decode_commands(at_s, frame),
        }
        if let Some(stroke_m) = self.stroke.join_front() {
            self.trace.stroke_m.push(at_s, stroke_m);
        }
        if let Some(load_n) = self.load.join_front() {
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
