//! NAV-RELPOSNED version 1: the vector from the base antenna to the rover antenna, 64 bytes.
//!
//! With both antennas on one roof its direction is the machine's heading.

use crate::CarrierSolution;
use crate::encode::{EncodeError, steps};
use crate::frame;
use crate::nav_hpposllh::split;
use crate::payload::Payload;

const DEGREE: f64 = core::f64::consts::PI / 180.0;

/// The vector between the two antennas.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct NavRelPosNed {
    /// Reference station, 0 to 4095.
    pub reference_station: u16,
    /// Time of the epoch in the GPS week, ms.
    pub time_of_week_ms: u32,
    /// North component, m; 0.1 mm on the wire.
    pub north_m: f64,
    /// East component, m; 0.1 mm on the wire.
    pub east_m: f64,
    /// Down component, m; 0.1 mm on the wire.
    pub down_m: f64,
    /// Length, m; 0.1 mm on the wire.
    pub length_m: f64,
    /// Direction, rad clockwise from north; 1e-5 deg on the wire.
    pub heading_rad: f64,
    /// Accuracy estimate north, m; 0.1 mm on the wire.
    pub accuracy_north_m: f64,
    /// Accuracy estimate east, m; 0.1 mm on the wire.
    pub accuracy_east_m: f64,
    /// Accuracy estimate down, m; 0.1 mm on the wire.
    pub accuracy_down_m: f64,
    /// Accuracy estimate of the length, m; 0.1 mm on the wire.
    pub accuracy_length_m: f64,
    /// Accuracy estimate of the direction, rad; 1e-5 deg on the wire.
    pub accuracy_heading_rad: f64,
    /// The fix is within the receiver's limits.
    pub fix_ok: bool,
    /// Corrections were applied.
    pub differential: bool,
    /// The vector may be used.
    pub position_valid: bool,
    /// State of the carrier phase.
    pub carrier: CarrierSolution,
    /// The base moves (it does on one roof).
    pub moving_base: bool,
    /// `heading_rad` may be used.
    pub heading_valid: bool,
}

impl NavRelPosNed {
    /// UBX class.
    pub const CLASS: u8 = 0x01;
    /// UBX identifier.
    pub const ID: u8 = 0x3C;
    /// Payload length, bytes.
    pub const LEN: usize = 64;
    /// The message version read and written.
    pub const VERSION: u8 = 1;

    /// Appends the message's frame to `bytes`.
    ///
    /// # Errors
    /// [`EncodeError`] when a field does not fit; `bytes` is then unchanged.
    pub fn encode(&self, bytes: &mut Vec<u8>) -> Result<(), EncodeError> {
        let mut p = Payload([0; Self::LEN]);
        p.put(0, [Self::VERSION]);
        p.put(2, self.reference_station.to_le_bytes());
        p.put(4, self.time_of_week_ms.to_le_bytes());
        for (coarse_at, fine_at, field, value) in [
            (8, 32, "north", self.north_m),
            (12, 33, "east", self.east_m),
            (16, 34, "down", self.down_m),
            (20, 35, "length", self.length_m),
        ] {
            let (centimetres, tenths) =
                split(value, 1e2, 100.0).ok_or(EncodeError::Range { field, value })?;
            p.put(coarse_at, centimetres.to_le_bytes());
            p.put(fine_at, tenths.to_le_bytes());
        }
        p.put(24, steps::<i32>("heading", self.heading_rad / DEGREE, 1e5)?.to_le_bytes());
        for (at, field, metres) in [
            (36, "accuracy north", self.accuracy_north_m),
            (40, "accuracy east", self.accuracy_east_m),
            (44, "accuracy down", self.accuracy_down_m),
            (48, "accuracy of the length", self.accuracy_length_m),
        ] {
            p.put(at, steps::<u32>(field, metres, 1e4)?.to_le_bytes());
        }
        let heading =
            steps::<u32>("accuracy of the heading", self.accuracy_heading_rad / DEGREE, 1e5)?;
        p.put(52, heading.to_le_bytes());
        p.put(60, self.flags().to_le_bytes());
        frame::write(Self::CLASS, Self::ID, &p.0, bytes);
        Ok(())
    }

    /// The message in a payload, `None` when length or version are others.
    #[must_use]
    pub fn decode(payload: &[u8]) -> Option<Self> {
        let p = Payload::<{ Self::LEN }>::read(payload)?;
        if p.u8(0) != Self::VERSION {
            return None;
        }
        let metres =
            |coarse, fine| (f64::from(p.i32(coarse)) * 100.0 + f64::from(p.i8(fine))) * 1e-4;
        let accuracy = |at| f64::from(p.u32(at)) * 1e-4;
        let flags = p.u32(60);
        Some(Self {
            reference_station: p.u16(2),
            time_of_week_ms: p.u32(4),
            north_m: metres(8, 32),
            east_m: metres(12, 33),
            down_m: metres(16, 34),
            length_m: metres(20, 35),
            heading_rad: f64::from(p.i32(24)) * 1e-5 * DEGREE,
            accuracy_north_m: accuracy(36),
            accuracy_east_m: accuracy(40),
            accuracy_down_m: accuracy(44),
            accuracy_length_m: accuracy(48),
            accuracy_heading_rad: f64::from(p.u32(52)) * 1e-5 * DEGREE,
            fix_ok: flags & 1 != 0,
            differential: flags & 2 != 0,
            position_valid: flags & 4 != 0,
            #[allow(clippy::cast_possible_truncation)] // two bits
            carrier: CarrierSolution::from_code((flags >> 3 & 3) as u8),
            moving_base: flags & 0x20 != 0,
            heading_valid: flags & 0x100 != 0,
        })
    }

    fn flags(&self) -> u32 {
        u32::from(self.fix_ok)
            | u32::from(self.differential) << 1
            | u32::from(self.position_valid) << 2
            | u32::from(self.carrier.code()) << 3
            | u32::from(self.moving_base) << 5
            | u32::from(self.heading_valid) << 8
    }
}
