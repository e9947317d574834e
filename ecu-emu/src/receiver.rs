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

#[cfg(test)]
mod tests {
    use xt28_machine::SimTime;
    use xt28_ubx::{Message, Parser};

    use super::*;

    /// 3 m east, 4 m north and 5 m up of its origin, going 0.6 m/s east and 0.8 m/s north, 0.1 m/s up, and facing
    /// 30 degrees to the left of east: 60 to the right of north.
    #[test]
    fn a_fix_is_said_in_the_receivers_own_axes() {
        let fix = GnssFix {
            at: SimTime::from_millis(12_125),
            position_m: [3.0, 4.0, 5.0],
            velocity_m_s: [0.6, 0.8, 0.1],
            heading_rad: 30.0_f64.to_radians(),
            accuracy_m: 0.02,
        };
        let mut bytes = Vec::new();
        Receiver::new(Geodetic::BENCH_ORIGIN).encode(&fix, &mut bytes).unwrap();
        let mut parser = Parser::new();
        let said: Vec<Message> = parser.push(&bytes).collect();
        let [Message::HpPosLlh(place), Message::Pvt(pvt), Message::RelPosNed(baseline)] = &said[..]
        else {
            panic!("{said:?}")
        };
        assert_eq!(
            [place.time_of_week_ms, pvt.time_of_week_ms, baseline.time_of_week_ms],
            [12_125; 3]
        );
        let local = LocalFrame::new(Geodetic::BENCH_ORIGIN).to_local(place.position);
        let off_m = [local.east_m - 3.0, local.north_m - 4.0, local.up_m - 5.0];
        assert!(off_m.iter().all(|off_m| off_m.abs() < 1e-3), "{local:?}");
        let near = |a: f64, b: f64| (a - b).abs() < 2e-3;
        assert!(near(pvt.velocity_east_m_s, 0.6) && near(pvt.velocity_north_m_s, 0.8), "{pvt:?}");
        assert!(near(pvt.velocity_down_m_s, -0.1) && near(pvt.speed_ground_m_s, 1.0), "{pvt:?}");
        // Right of north: atan(0.6 / 0.8).
        assert!(near(pvt.course_rad, 0.6435), "{pvt:?}");
        assert!(near(baseline.heading_rad, 60.0_f64.to_radians()), "{baseline:?}");
        assert!(near(baseline.north_m, 0.5) && near(baseline.east_m, 0.866), "{baseline:?}");
    }
}
