//! What the gateway hears from the machine's sensors, in SI.

use core::time::Duration;

use xt28_dbc::Frame;
use xt28_dbc::e2e::{Alive, AliveCheck};
use xt28_dbc::messages::{
    Attitude as AttitudeFrame, CylLoadFront, CylLoadMidRear, PosFront, PosMidRear, WheelSpeedJoint,
    WheelSpeedSigned,
};
use xt28_machine::{PerWheel, SimTime};
use xt28_safety::Measured;

use crate::Attitude;
use crate::running::Running;

const M_PER_MM: f64 = 1e-3;
/// From here on a stroke of 16 bits is one below zero.
const WRAPS_MM: f64 = 32_768.0;
const N_PER_DAN: f64 = 10.0;
/// Loads older than this are lost: four of their periods (assumed).
const LOADS_GOOD_FOR: Duration = Duration::from_millis(200);
const RAD_S_PER_RPM: f64 = core::f64::consts::TAU / 60.0;

/// Running lists of everything the policy sees, one per frame.
#[derive(Clone, Debug)]
pub(crate) struct Sensors {
    stroke_front_m: Running<2>,
    stroke_rest_m: Running<4>,
    load_front_n: Running<2>,
    load_rest_n: Running<4>,
    /// Roll, pitch.
    attitude_rad: Running<2>,
    /// Front, rear.
    joint_rad: Running<2>,
    wheel_rad_s: Running<6>,
    wheel_alive: AliveCheck,
    /// Frames with one of our identifiers that did not decode, or came twice.
    refused: u64,
}

/// The means since the last observation.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Means {
    pub(crate) stroke_m: PerWheel<f64>,
    pub(crate) load_n: PerWheel<f64>,
    pub(crate) attitude: Attitude,
    pub(crate) front_joint_rad: f64,
    pub(crate) rear_joint_rad: f64,
    pub(crate) wheel_speed_rad_s: PerWheel<f64>,
}

impl Sensors {
    pub(crate) fn new() -> Self {
        Self {
            stroke_front_m: Running::new(),
            stroke_rest_m: Running::new(),
            load_front_n: Running::new(),
            load_rest_n: Running::new(),
            attitude_rad: Running::new(),
            joint_rad: Running::new(),
            wheel_rad_s: Running::new(),
            wheel_alive: AliveCheck::default(),
            refused: 0,
        }
    }

    /// Takes a sensor frame; others are left alone.
    pub(crate) fn on_frame(&mut self, now: SimTime, frame: &Frame) {
        let taken = match frame.id() {
            PosFront::ID => PosFront::decode(frame).map(|f| {
                self.stroke_front_m.push(now, [f.fr_mm, f.fl_mm].map(stroke_m));
            }),
            PosMidRear::ID => PosMidRear::decode(frame).map(|f| {
                let mm = [f.mr_mm, f.ml_mm, f.br_mm, f.bl_mm];
                self.stroke_rest_m.push(now, mm.map(stroke_m));
            }),
            CylLoadFront::ID => CylLoadFront::decode(frame).map(|f| {
                self.load_front_n.push(now, [f.fr_dan, f.fl_dan].map(|dan| dan * N_PER_DAN));
            }),
            CylLoadMidRear::ID => CylLoadMidRear::decode(frame).map(|f| {
                let dan = [f.mr_dan, f.ml_dan, f.br_dan, f.bl_dan];
                self.load_rest_n.push(now, dan.map(|dan| dan * N_PER_DAN));
            }),
            AttitudeFrame::ID => AttitudeFrame::decode(frame).map(|f| {
                self.attitude_rad.push(now, [f.roll_deg, f.pitch_deg].map(f64::to_radians));
            }),
            WheelSpeedJoint::ID => WheelSpeedJoint::decode(frame).map(|f| {
                self.joint_rad
                    .push(now, [f.front_joint_deg, f.rear_joint_deg].map(f64::to_radians));
            }),
            WheelSpeedSigned::ID => {
                WheelSpeedSigned::decode(frame).map(|f| self.on_wheels(now, &f))
            }
            _ => return,
        };
        self.refused += u64::from(taken.is_err());
    }

    /// A frame that repeats its counter is an old one sent again.
    fn on_wheels(&mut self, now: SimTime, f: &WheelSpeedSigned) {
        if matches!(self.wheel_alive.check(f.counter), Alive::Repeated) {
            self.refused += 1;
            return;
        }
        let rpm = [f.fr_rpm, f.fl_rpm, f.mr_rpm, f.ml_rpm, f.br_rpm, f.bl_rpm];
        self.wheel_rad_s.push(now, rpm.map(|rpm| rpm * RAD_S_PER_RPM));
    }

    /// The means since the last call.
    pub(crate) fn take_means(&mut self) -> Means {
        let [roll_rad, pitch_rad] = self.attitude_rad.take_mean();
        let [front_joint_rad, rear_joint_rad] = self.joint_rad.take_mean();
        Means {
            stroke_m: six(self.stroke_front_m.take_mean(), self.stroke_rest_m.take_mean()),
            load_n: six(self.load_front_n.take_mean(), self.load_rest_n.take_mean()),
            attitude: Attitude { roll_rad, pitch_rad },
            front_joint_rad,
            rear_joint_rad,
            wheel_speed_rad_s: PerWheel(self.wheel_rad_s.take_mean()),
        }
    }

    /// Attitude at the middle of the time since the last observation; level before the first frame.
    pub(crate) fn attitude(&self) -> Attitude {
        let [roll_rad, pitch_rad] = self.attitude_rad.mean();
        if roll_rad.is_nan() { Attitude::default() } else { Attitude { roll_rad, pitch_rad } }
    }

    /// The newest values, for the safety kernel; `speed_m_s` is what six wheels together say of it.
    pub(crate) fn measured(&self, speed_m_s: impl Fn(&PerWheel<f64>) -> f64) -> Measured {
        let [roll_rad, pitch_rad] = self.attitude_rad.last();
        Measured {
            stroke_m: six(self.stroke_front_m.last(), self.stroke_rest_m.last()).0,
            front_angle_rad: self.joint_rad.last()[0],
            speed_m_s: speed_m_s(&PerWheel(self.wheel_rad_s.last())),
            roll_rad,
            pitch_rad,
        }
    }

    /// When the oldest of the 100 Hz sensors spoke last; `None` until each has.
    pub(crate) fn oldest_at(&self) -> Option<SimTime> {
        let at = [
            self.stroke_front_m.at(),
            self.stroke_rest_m.at(),
            self.attitude_rad.at(),
            self.joint_rad.at(),
            self.wheel_rad_s.at(),
        ];
        at.into_iter().min().flatten()
    }

    /// True while a whole observation can be made: each sensor has spoken, and the loads, which no
    /// deadline of the safety kernel watches, not long ago. They come at 20 Hz and are last.
    pub(crate) fn complete(&self, now: SimTime) -> bool {
        let loads = [self.load_front_n.at(), self.load_rest_n.at()];
        let fresh = |at: Option<SimTime>| at.is_some_and(|at| now.since(at) <= LOADS_GOOD_FOR);
        self.oldest_at().is_some() && loads.into_iter().all(fresh)
    }

    /// Frames that were not what their identifier says.
    pub(crate) const fn refused(&self) -> u64 {
        self.refused
    }
}

/// A stroke on the wire as metres. The firmware says one a little below zero in the two's complement of a number that
/// is read as unsigned (facts 3.2): no cylinder is 32 m long.
fn stroke_m(mm: f64) -> f64 {
    (if mm >= WRAPS_MM { mm - 2.0 * WRAPS_MM } else { mm }) * M_PER_MM
}

/// The firmware sends the front pair and the other four apart.
const fn six([fr, fl]: [f64; 2], [mr, ml, br, bl]: [f64; 4]) -> PerWheel<f64> {
    PerWheel([fr, fl, mr, ml, br, bl])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stroke_a_little_below_zero_is_no_long_one() {
        assert_eq!([170.0, 0.0, 65_535.0].map(stroke_m), [0.17, 0.0, -0.001]);
    }

    #[test]
    fn wheel_speeds_sent_again_are_no_news() {
        let mut sensors = Sensors::new();
        let frame = WheelSpeedSigned { fr_rpm: 10.0, counter: 7, ..WheelSpeedSigned::default() };
        let frame = frame.encode().unwrap();
        for at_ms in [10, 20, 30] {
            sensors.on_frame(SimTime::from_millis(at_ms), &frame);
        }
        assert_eq!(sensors.wheel_rad_s.at(), Some(SimTime::from_millis(10)));
        assert_eq!(sensors.refused(), 2);
    }
}
