//! Demands and fixes as frames: the one place where SI becomes what the wire says.

use core::f64::consts::TAU;

use xt28_dbc::e2e::AliveCounter;
use xt28_dbc::messages::{
    ArmTarget, ArmTargetMode, ArmValve, DriveTarget, GnssPosition, GnssQuality, GnssQualityFix,
    GnssVelocity,
};
use xt28_dbc::{EncodeError, Outbox};
use xt28_safety::{Arms, Command};
use xt28_ubx::Enu;

use crate::epoch::{Epoch, Fix, Quality};

/// On the wire, this target holds the arm: raw 255 at 2 mm a bit.
const HOLD_MM: f64 = 510.0;
/// Resolution of a target stroke, mm.
const STROKE_STEP_MM: f64 = 2.0;
/// The longest target stroke that the wire can say, m: the next one holds.
pub(crate) const STROKE_MAX_M: f64 = 0.508;
/// The largest joint angle that the wire can say, either way, deg.
pub(crate) const ANGLE_MAX_DEG: f64 = 25.0;
/// The highest engine speed that the wire can say, rpm.
const ENGINE_SPEED_MAX_RPM: f64 = 2550.0;

/// Whether frames may move anything.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Drive {
    /// As commanded.
    Enabled,
    /// Throttle zero and not enabled, whatever the command.
    Neutral,
}

/// Writes the gateway's frames and counts them alive.
#[derive(Clone, Debug, Default)]
pub(crate) struct FrameWriter {
    arm: AliveCounter,
    drive: AliveCounter,
    valve: AliveCounter,
    /// Counters last sent to the arm and the drive ECU.
    sent: Option<(u8, u8)>,
    /// What was asked of the brake last; nothing after silence.
    is_braking: bool,
    engine_speed_rpm: f64,
}

impl FrameWriter {
    pub(crate) fn new(engine_speed_rpm: f64) -> Self {
        Self { engine_speed_rpm: engine_speed_rpm.min(ENGINE_SPEED_MAX_RPM), ..Self::default() }
    }

    /// Counters last sent to the arm and the drive ECU, none after silence.
    pub(crate) const fn sent(&self) -> Option<(u8, u8)> {
        self.sent
    }

    /// Whether the last frames close the brake.
    pub(crate) const fn is_braking(&self) -> bool {
        self.is_braking
    }

    /// Nothing was sent: what is acknowledged from now on is old.
    pub(crate) const fn silence(&mut self) {
        (self.sent, self.is_braking) = (None, false);
    }

    /// The frames that carry `command` to both ECUs: all of them, or none where one has no form on the
    /// wire.
    pub(crate) fn actuate(
        &mut self,
        command: &Command,
        drive: Drive,
        out: &mut Outbox,
    ) -> Result<(), EncodeError> {
        let (arm_counter, drive_counter) = (self.arm.next_count(), self.drive.next_count());
        let (mode, strokes) = match command.arms {
            Arms::Off => (ArmTargetMode::Off, [None; 6]),
            Arms::Automatic => (ArmTargetMode::Automatic, [None; 6]),
            Arms::Position(strokes) => (ArmTargetMode::ManualPosition, strokes),
            Arms::Valve(_) => (ArmTargetMode::ManualValve, [None; 6]),
        };
        let [fr_mm, fl_mm, mr_mm, ml_mm, br_mm, bl_mm] = strokes.map(stroke_mm);
        let arm =
            ArmTarget { fr_mm, fl_mm, mr_mm, ml_mm, br_mm, bl_mm, mode, counter: arm_counter };
        let arm = arm.encode()?;
        let mut valves = None;
        if let Arms::Valve(openings) = command.arms {
            let [fr_percent, fl_percent, mr_percent, ml_percent, br_percent, bl_percent] =
                openings.map(|opening| opening * 100.0);
            let counter = self.valve.next_count();
            let valve = ArmValve {
                fr_percent,
                fl_percent,
                mr_percent,
                ml_percent,
                br_percent,
                bl_percent,
                counter,
            };
            valves = Some(valve.encode()?);
        }
        let enable = drive == Drive::Enabled;
        let target = DriveTarget {
            throttle_percent: if enable { command.throttle * 100.0 } else { 0.0 },
            // A joint that stands beyond what the wire can say is told as at its end.
            front_angle_deg: hundredths(command.front_angle_rad.to_degrees())
                .clamp(-ANGLE_MAX_DEG, ANGLE_MAX_DEG),
            engine_speed_rpm: self.engine_speed_rpm,
            brake: command.brake,
            enable,
            counter: drive_counter,
        };
        let target = target.encode()?;
        [Some(arm), valves, Some(target)].into_iter().flatten().for_each(|frame| out.push(frame));
        (self.sent, self.is_braking) = (Some((arm_counter, drive_counter)), command.brake);
        Ok(())
    }
}

/// Rounded to what the wire resolves, so that 25 degrees come back from radians as 25 degrees and
/// not as a bit more than the range has.
fn hundredths(degrees: f64) -> f64 {
    (degrees * 100.0).round() / 100.0
}

/// A stroke target as the wire has it: rounded to its step, or the value that holds.
fn stroke_mm(stroke_m: Option<f64>) -> f64 {
    let step = |m: f64| (m.min(STROKE_MAX_M) * 1e3 / STROKE_STEP_MM).round() * STROKE_STEP_MM;
    stroke_m.map_or(HOLD_MM, step)
}

/// The log's record of a fix: position of the antenna, not of the front axle, and without regard to
/// its lean, as the field logs have it.
pub(crate) fn position(antenna: Enu, out: &mut Outbox) -> Result<(), EncodeError> {
    let (east_mm, north_mm) = (antenna.east_m * 1e3, antenna.north_m * 1e3);
    out.push(GnssPosition { east_mm, north_mm }.encode()?);
    Ok(())
}

/// Velocity of the antenna east, north, up, and the machine's heading.
pub(crate) fn velocity(
    velocity_m_s: [f64; 3],
    heading_rad: f64,
    out: &mut Outbox,
) -> Result<(), EncodeError> {
    let [east_mm_s, north_mm_s, up_mm_s] = velocity_m_s.map(|v| v * 1e3);
    // Rounded here, since 359.996 must become 0 and not 360.
    let heading_deg = hundredths(heading_rad.rem_euclid(TAU).to_degrees()) % 360.0;
    out.push(GnssVelocity { east_mm_s, north_mm_s, up_mm_s, heading_deg }.encode()?);
    Ok(())
}

/// How good the fix is and how long it waited, s.
pub(crate) fn quality(
    quality: &Quality,
    latency_s: f64,
    out: &mut Outbox,
) -> Result<(), EncodeError> {
    let frame = GnssQuality {
        fix: match quality.fix {
            Fix::None => GnssQualityFix::None,
            Fix::Single => GnssQualityFix::Single,
            Fix::Differential => GnssQualityFix::Differential,
            Fix::RtkFloat => GnssQualityFix::RtkFloat,
            Fix::RtkFixed => GnssQualityFix::RtkFixed,
        },
        satellites: quality.satellites,
        accuracy_mm: saturated(quality.accuracy_horizontal_m * 1e3),
        latency_ms: saturated(latency_s * 1e3),
    };
    out.push(frame.encode()?);
    Ok(())
}

/// Accuracy without a fix is kilometres; the field says 65.535 m at most.
fn saturated(value: f64) -> f64 {
    value.clamp(0.0, 65_535.0)
}

/// A fix in the log: its position where there is one, its velocity where there is a heading too (they
/// share a frame), its quality always, also where one of the others has no form on the wire.
pub(crate) fn fix(
    epoch: &Epoch,
    antenna: Enu,
    latency_s: f64,
    out: &mut Outbox,
) -> [Result<(), EncodeError>; 3] {
    let there = epoch.quality.fix > Fix::None;
    let heading_rad = epoch.heading_rad.filter(|_| there);
    [
        if there { position(antenna, out) } else { Ok(()) },
        heading_rad.map_or(Ok(()), |rad| velocity(epoch.velocity_m_s, rad, out)),
        quality(&epoch.quality, latency_s, out),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_joint_beyond_the_wire_costs_no_frame() {
        for (joint_rad, told_deg) in [(0.5, 25.0), (-0.5, -25.0)] {
            let (mut writer, mut out) = (FrameWriter::new(1200.0), Outbox::default());
            writer.actuate(&Command::rest(joint_rad), Drive::Neutral, &mut out).unwrap();
            let target = DriveTarget::decode(&out.frames()[1]).unwrap();
            assert_eq!(target.front_angle_deg, told_deg);
        }
    }

    #[test]
    fn the_longest_target_does_not_hold() {
        assert_eq!([0.508, 0.509, 0.6].map(|m| stroke_mm(Some(m))), [508.0; 3]);
        assert_eq!(stroke_mm(None), HOLD_MM);
    }

    #[test]
    fn a_heading_just_short_of_a_turn_is_none() {
        let mut out = Outbox::default();
        for heading_rad in [-1e-9, TAU, 359.996_f64.to_radians()] {
            out.clear();
            velocity([0.0; 3], heading_rad, &mut out).unwrap();
            assert_eq!(GnssVelocity::decode(&out.frames()[0]).unwrap().heading_deg, 0.0);
        }
    }
}
