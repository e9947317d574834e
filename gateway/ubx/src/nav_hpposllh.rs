//! NAV-HPPOSLLH: the antenna position to 1e-9 deg and 0.1 mm, 36 bytes.
//!
//! NAV-PVT's 1e-7 deg is 11 mm on a meridian, twice the noise of an RTK fix (5 mm, paper 3.4), so a
//! receiver that sends both is read from here.

use crate::encode::{EncodeError, WireInt, steps};
use crate::frame;
use crate::geodetic::Geodetic;
use crate::payload::Payload;

const DEGREE: f64 = core::f64::consts::PI / 180.0;

/// The antenna position, fine.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct NavHpPosLlh {
    /// Time of the epoch in the GPS week, ms.
    pub time_of_week_ms: u32,
    /// False when the receiver marks the position as not to be used.
    pub valid: bool,
    /// Antenna position on WGS-84; 1e-9 deg (0.11 mm) and 0.1 mm on the wire.
    pub position: Geodetic,
    /// Height above mean sea level, m; 0.1 mm on the wire.
    pub height_msl_m: f64,
    /// Horizontal accuracy estimate, m; 0.1 mm on the wire.
    pub accuracy_horizontal_m: f64,
    /// Vertical accuracy estimate, m; 0.1 mm on the wire.
    pub accuracy_vertical_m: f64,
}

impl NavHpPosLlh {
    /// UBX class.
    pub const CLASS: u8 = 0x01;
    /// UBX identifier.
    pub const ID: u8 = 0x14;
    /// Payload length, bytes.
    pub const LEN: usize = 36;

    /// Appends the message's frame to `bytes`.
    ///
    /// # Errors
    /// [`EncodeError`] when a field does not fit; `bytes` is then unchanged.
    pub fn encode(&self, bytes: &mut Vec<u8>) -> Result<(), EncodeError> {
        let mut p = Payload([0; Self::LEN]);
        p.put(3, [u8::from(!self.valid)]);
        p.put(4, self.time_of_week_ms.to_le_bytes());
        let position = &self.position;
        for (coarse_at, fine_at, field, value, coarse_per_unit, fine_per_coarse) in [
            (8, 24, "longitude", position.longitude_rad / DEGREE, 1e7, 100.0),
            (12, 25, "latitude", position.latitude_rad / DEGREE, 1e7, 100.0),
            (16, 26, "height", position.height_m, 1e3, 10.0),
            (20, 27, "height above sea level", self.height_msl_m, 1e3, 10.0),
        ] {
            let (coarse, fine) = split(value, coarse_per_unit, fine_per_coarse)
                .ok_or(EncodeError::Range { field, value })?;
            p.put(coarse_at, coarse.to_le_bytes());
            p.put(fine_at, fine.to_le_bytes());
        }
        for (at, field, metres) in [
            (28, "horizontal accuracy", self.accuracy_horizontal_m),
            (32, "vertical accuracy", self.accuracy_vertical_m),
        ] {
            p.put(at, steps::<u32>(field, metres, 1e4)?.to_le_bytes());
        }
        frame::write(Self::CLASS, Self::ID, &p.0, bytes);
        Ok(())
    }

    /// The message in a payload, `None` when length or version are others.
    #[must_use]
    pub fn decode(payload: &[u8]) -> Option<Self> {
        let p = Payload::<{ Self::LEN }>::read(payload)?;
        if p.u8(0) != 0 {
            return None;
        }
        let degrees = |coarse, fine| {
            (f64::from(p.i32(coarse)) * 100.0 + f64::from(p.i8(fine))) * 1e-9 * DEGREE
        };
        let metres =
            |coarse, fine| (f64::from(p.i32(coarse)) * 10.0 + f64::from(p.i8(fine))) * 1e-4;
        Some(Self {
            time_of_week_ms: p.u32(4),
            valid: p.u8(3) & 1 == 0,
            position: Geodetic {
                longitude_rad: degrees(8, 24),
                latitude_rad: degrees(12, 25),
                height_m: metres(16, 26),
            },
            height_msl_m: metres(20, 27),
            accuracy_horizontal_m: f64::from(p.u32(28)) * 1e-4,
            accuracy_vertical_m: f64::from(p.u32(32)) * 1e-4,
        })
    }
}

/// `value` as coarse steps and the rest in fine steps, the whole rounded once, both of one sign.
pub(crate) fn split(value: f64, coarse_per_unit: f64, fine_per_coarse: f64) -> Option<(i32, i8)> {
    let fine_steps = (value * coarse_per_unit * fine_per_coarse).round();
    let coarse = (fine_steps / fine_per_coarse).trunc();
    Some((i32::nearest(coarse)?, i8::nearest(fine_steps - coarse * fine_per_coarse)?))
}
