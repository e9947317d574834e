//! The GNSS receiver's serial port: fixes as the UBX messages of a moving-base pair.

use std::f64::consts::{FRAC_PI_2, TAU};

use xt28_sim::GnssFix;
use xt28_ubx::{
    CarrierSolution, EncodeError, Enu, FixType, Geodetic, LocalFrame, NavHpPosLlh, NavPvt,
    NavRelPosNed,
};

/// Spacing of the two antennas on the roof, m (assumed).
const BASELINE_M: f64 = 1.0;
/// Satellites an open sky gives (assumed).
const SATELLITES: u8 = 14;

/// Turns fixes into the receiver's bytes.
#[derive(Clone, Debug)]
pub(crate) struct Receiver {
    frame: LocalFrame,
}

impl Receiver {
    pub(crate) fn new(origin: Geodetic) -> Self {
        Self { frame: LocalFrame::new(origin) }
    }

    /// Appends NAV-HPPOSLLH, NAV-PVT and NAV-RELPOSNED of one fix.
    pub(crate) fn encode(&self, fix: &GnssFix, bytes: &mut Vec<u8>) -> Result<(), EncodeError> {
        let [east_m, north_m, up_m] = fix.position_m;
        let position = self.frame.to_geodetic(Enu { east_m, north_m, up_m });
        let [east, north, up] = fix.velocity_m_s;
        #[allow(clippy::cast_possible_truncation)] // a run is shorter than a GPS week
        let time_of_week_ms = (fix.at.as_nanos() / 1_000_000 % 604_800_000) as u32;
        NavHpPosLlh {
            time_of_week_ms,
            valid: true,
            position,
            height_msl_m: position.height_m,
            accuracy_horizontal_m: fix.accuracy_m,
            accuracy_vertical_m: fix.accuracy_m,
        }
        .encode(bytes)?;
        NavPvt {
            time_of_week_ms,
            fix_type: FixType::ThreeD,
            fix_ok: true,
            differential: true,
            carrier: CarrierSolution::Fixed,
            position_valid: true,
            satellites: SATELLITES,
            position,
            height_msl_m: position.height_m,
            accuracy_horizontal_m: fix.accuracy_m,
            accuracy_vertical_m: fix.accuracy_m,
            velocity_north_m_s: north,
            velocity_east_m_s: east,
            velocity_down_m_s: -up,
            speed_ground_m_s: east.hypot(north),
            course_rad: (FRAC_PI_2 - north.atan2(east)).rem_euclid(TAU),
            ..NavPvt::default()
        }
        .encode(bytes)?;
        let heading_rad = (FRAC_PI_2 - fix.heading_rad).rem_euclid(TAU);
        NavRelPosNed {
            time_of_week_ms,
            north_m: BASELINE_M * heading_rad.cos(),
            east_m: BASELINE_M * heading_rad.sin(),
            length_m: BASELINE_M,
            heading_rad,
            fix_ok: true,
            differential: true,
            position_valid: true,
            carrier: CarrierSolution::Fixed,
            moving_base: true,
            heading_valid: true,
            ..NavRelPosNed::default()
        }
        .encode(bytes)
    }
}
