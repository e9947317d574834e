//! The frames that a foreign machine and its gateway put on the bus, in the order they send them.

use xt28_dbc::e2e::AliveCounter;
use xt28_dbc::messages::{
    ArmTarget, ArmTargetMode, Attitude, CylLoadFront, CylLoadMidRear, DriveCurrent, DriveTarget,
    Eec1, GnssPosition, GnssQuality, GnssQualityFix, GnssVelocity, PosFront, PosMidRear,
    PressFront, PressMid, PressRear, PumpPressure, RefCurrentFront, RefCurrentMid, RefCurrentRear,
    WheelForceFront, WheelForceMidRear, WheelSpeedJoint, WheelSpeedSigned,
};
use xt28_dbc::{EncodeError, Frame};
use xt28_machine::{PerWheel, Wheel};

use crate::ecu::arm::ArmReport;
use crate::ecu::drive::DriveReport;
use crate::manoeuvre::Command;
use crate::sensing::Fix;

/// Rated speed of the engine that the gateway asks for, rpm.
const ENGINE_RPM: f64 = 1200.0;
/// What the receiver says of itself.
const SATELLITES: u8 = 17;
const ACCURACY_MM: f64 = 14.0;

/// Turns readings into frames; counts what has a counter.
#[derive(Debug, Default)]
pub(crate) struct Wire {
    arm: AliveCounter,
    drive: AliveCounter,
    wheels: AliveCounter,
}

type Frames = Result<Vec<Frame>, EncodeError>;

impl Wire {
    /// The gateway's two commands.
    pub(crate) fn commands(&mut self, command: &Command) -> Result<[Frame; 2], EncodeError> {
        let [fr_mm, fl_mm, mr_mm, ml_mm, br_mm, bl_mm] = command.stroke_mm.0;
        let counter = self.arm.next_count();
        let mode = ArmTargetMode::ManualPosition;
        let arm = ArmTarget { fr_mm, fl_mm, mr_mm, ml_mm, br_mm, bl_mm, mode, counter };
        let drive = DriveTarget {
            throttle_percent: command.throttle_percent,
            front_angle_deg: command.front_deg,
            engine_speed_rpm: ENGINE_RPM,
            brake: false,
            enable: true,
            counter: self.drive.next_count(),
        };
        Ok([arm.encode()?, drive.encode()?])
    }

    /// The gateway's three on a fix.
    pub(crate) fn fix(fix: &Fix) -> Frames {
        let word = |m_s: f64| (m_s * 1e3).clamp(-32_768.0, 32_767.0);
        let position =
            GnssPosition { east_mm: fix.position_m[0] * 1e3, north_mm: fix.position_m[1] * 1e3 };
        let velocity = GnssVelocity {
            east_mm_s: word(fix.velocity_m_s[0]),
            north_mm_s: word(fix.velocity_m_s[1]),
            up_mm_s: word(fix.velocity_m_s[2]),
            heading_deg: fix.heading_rad.to_degrees(),
        };
        let quality = GnssQuality {
            fix: GnssQualityFix::RtkFixed,
            satellites: SATELLITES,
            accuracy_mm: ACCURACY_MM,
            latency_ms: 0.0,
        };
        Ok(vec![position.encode()?, velocity.encode()?, quality.encode()?])
    }

    /// The arm ECU's, with those of every fifth tick where `slow`.
    pub(crate) fn arm(report: &ArmReport, slow: bool) -> Frames {
        use Wheel::{Bl, Br, Fl, Fr, Ml, Mr};
        let (kpa, mm, ma) = (&report.pressure_kpa, &report.stroke_mm, &report.current_ma);
        let mut frames = vec![
            PressRear {
                br_a_kpa: kpa[Br][0],
                br_b_kpa: kpa[Br][1],
                bl_a_kpa: kpa[Bl][0],
                bl_b_kpa: kpa[Bl][1],
            }
            .encode()?,
            PressMid {
                mr_a_kpa: kpa[Mr][0],
                mr_b_kpa: kpa[Mr][1],
                ml_a_kpa: kpa[Ml][0],
                ml_b_kpa: kpa[Ml][1],
            }
            .encode()?,
            PressFront {
                fr_a_kpa: kpa[Fr][0],
                fr_b_kpa: kpa[Fr][1],
                fl_a_kpa: kpa[Fl][0],
                fl_b_kpa: kpa[Fl][1],
            }
            .encode()?,
            PosMidRear { mr_mm: mm[Mr], ml_mm: mm[Ml], br_mm: mm[Br], bl_mm: mm[Bl] }.encode()?,
            PosFront { fr_mm: mm[Fr], fl_mm: mm[Fl] }.encode()?,
        ];
        if slow {
            frames.extend(Self::loads(&report.load_dan, &report.wheel_force_dan)?);
        }
        frames.push(
            Attitude {
                mean_stroke_mm: mm.mean().trunc(),
                mean_stroke_rate: 0,
                pitch_deg: report.pitch_deg,
                roll_deg: report.roll_deg,
            }
            .encode()?,
        );
        frames.extend(Self::currents(ma)?);
        Ok(frames)
    }

    fn loads(cylinder: &PerWheel<f64>, wheel: &PerWheel<f64>) -> Frames {
        let [fr, fl, mr, ml, br, bl] = cylinder.0;
        let middle = CylLoadMidRear { mr_dan: mr, ml_dan: ml, br_dan: br, bl_dan: bl };
        let front = CylLoadFront { fr_dan: fr, fl_dan: fl };
        let [vfr, vfl, vmr, vml, vbr, vbl] = wheel.0;
        Ok(vec![
            middle.encode()?,
            front.encode()?,
            WheelForceMidRear { mr_dan: vmr, ml_dan: vml, br_dan: vbr, bl_dan: vbl }.encode()?,
            WheelForceFront { fr_dan: vfr, fl_dan: vfl }.encode()?,
        ])
    }

    fn currents(ma: &PerWheel<[f64; 2]>) -> Frames {
        let [fr, fl, mr, ml, br, bl] = ma.0;
        Ok(vec![
            RefCurrentFront { fr_a_ma: fr[0], fr_b_ma: fr[1], fl_a_ma: fl[0], fl_b_ma: fl[1] }
                .encode()?,
            RefCurrentMid { mr_a_ma: mr[0], mr_b_ma: mr[1], ml_a_ma: ml[0], ml_b_ma: ml[1] }
                .encode()?,
            RefCurrentRear { br_a_ma: br[0], br_b_ma: br[1], bl_a_ma: bl[0], bl_b_ma: bl[1] }
                .encode()?,
        ])
    }

    /// The transmission ECU's, `tick` counting its task's periods.
    pub(crate) fn drive(
        &mut self,
        report: &DriveReport,
        wheel_rad_s: &PerWheel<f64>,
        joint_deg: [f64; 2],
        pump_pa: [f64; 4],
        tick: u64,
    ) -> Frames {
        let rpm = wheel_rad_s.map(|rad_s| rad_s * 60.0 / std::f64::consts::TAU);
        let mut frames = Vec::with_capacity(4);
        if tick.is_multiple_of(5) {
            let [pump1_a_bar, pump1_b_bar, pump2_a_bar, pump2_b_bar] = pump_pa.map(|pa| pa * 1e-5);
            let pumps = PumpPressure { pump1_a_bar, pump1_b_bar, pump2_a_bar, pump2_b_bar };
            frames.push(pumps.encode()?);
        }
        let speeds = WheelSpeedJoint {
            wheel5_rpm: rpm[Wheel::Br].abs(),
            wheel6_rpm: rpm[Wheel::Bl].abs(),
            front_joint_deg: joint_deg[0],
            rear_joint_deg: joint_deg[1],
        };
        frames.push(speeds.encode()?);
        if tick.is_multiple_of(2) {
            let [pump1_a_ma, pump1_b_ma, pump2_a_ma, pump2_b_ma] = report.pump_ma;
            let [steer_front_a_ma, steer_front_b_ma, steer_rear_a_ma, steer_rear_b_ma] =
                report.steer_ma;
            let currents = DriveCurrent {
                pump1_a_ma,
                pump1_b_ma,
                pump2_a_ma,
                pump2_b_ma,
                steer_front_a_ma,
                steer_front_b_ma,
                steer_rear_a_ma,
                steer_rear_b_ma,
            };
            frames.push(currents.encode()?);
        }
        let [fr_rpm, fl_rpm, mr_rpm, ml_rpm, br_rpm, bl_rpm] =
            rpm.map(|rpm| rpm.clamp(-51.2, 51.1)).0;
        let counter = self.wheels.next_count();
        let signed = WheelSpeedSigned { fr_rpm, fl_rpm, mr_rpm, ml_rpm, br_rpm, bl_rpm, counter };
        frames.push(signed.encode()?);
        Ok(frames)
    }

    /// The engine's.
    pub(crate) fn engine(rpm: f64) -> Result<Frame, EncodeError> {
        Eec1 { engine_speed_rpm: rpm }.encode()
    }
}
