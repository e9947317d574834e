//! NAV-PVT: position, velocity and time of one epoch, 92 bytes.

use crate::encode::{EncodeError, steps};
use crate::frame;
use crate::geodetic::Geodetic;
use crate::payload::Payload;

const DEGREE: f64 = core::f64::consts::PI / 180.0;

/// What the position rests on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FixType {
    /// Nothing.
    #[default]
    None,
    /// Dead reckoning alone.
    DeadReckoning,
    /// Satellites, height assumed.
    TwoD,
    /// Satellites.
    ThreeD,
    /// Satellites and dead reckoning.
    Combined,
    /// Time only.
    TimeOnly,
    /// A value the interface description leaves reserved.
    Reserved(u8),
}

/// What is known of the carrier phase: the step from decimetres to millimetres.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum CarrierSolution {
    /// Code only.
    #[default]
    None,
    /// Ambiguities estimated as reals.
    Float,
    /// Ambiguities fixed to integers: centimetres and better.
    Fixed,
    /// A value the interface description leaves reserved.
    Reserved,
}

/// UTC of the epoch, as the receiver gives it; `valid` says what of it may be used.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[allow(missing_docs)]
pub struct Utc {
    pub year: u16,
    /// 1 to 12.
    pub month: u8,
    /// 1 to 31.
    pub day: u8,
    pub hour: u8,
    pub minute: u8,
    /// 0 to 60, a leap second included.
    pub second: u8,
    /// -1e9 to 1e9, added to `second`.
    pub nanosecond: i32,
    /// Bit 0 date, bit 1 time, bit 2 fully resolved.
    pub valid: u8,
}

/// Position, velocity and time. The position's resolution is 1e-7 deg, up to 11 mm on the ground:
/// coarser than an RTK fix, so [`crate::NavHpPosLlh`] of the same epoch is preferred when there is one.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct NavPvt {
    /// Time of the epoch in the GPS week, ms.
    pub time_of_week_ms: u32,
    /// Calendar time of the epoch.
    pub utc: Utc,
    /// What the position rests on.
    pub fix_type: FixType,
    /// The receiver's own judgement that the fix is within its limits.
    pub fix_ok: bool,
    /// Corrections were applied.
    pub differential: bool,
    /// State of the carrier phase.
    pub carrier: CarrierSolution,
    /// Longitude, latitude and height are valid (bit `invalidLlh` is clear).
    pub position_valid: bool,
    /// Satellites used.
    pub satellites: u8,
    /// Antenna position on WGS-84; 1e-7 deg and 1 mm on the wire.
    pub position: Geodetic,
    /// Height above mean sea level, m; 1 mm on the wire.
    pub height_msl_m: f64,
    /// Horizontal accuracy estimate, m; 1 mm on the wire.
    pub accuracy_horizontal_m: f64,
    /// Vertical accuracy estimate, m; 1 mm on the wire.
    pub accuracy_vertical_m: f64,
    /// Velocity north, m/s; 1 mm/s on the wire.
    pub velocity_north_m_s: f64,
    /// Velocity east, m/s; 1 mm/s on the wire.
    pub velocity_east_m_s: f64,
    /// Velocity down, m/s; 1 mm/s on the wire.
    pub velocity_down_m_s: f64,
    /// Ground speed, m/s, never negative; 1 mm/s on the wire.
    pub speed_ground_m_s: f64,
    /// Direction of motion, rad clockwise from north; 1e-5 deg on the wire.
    pub course_rad: f64,
    /// Speed accuracy estimate, m/s; 1 mm/s on the wire.
    pub accuracy_speed_m_s: f64,
    /// Accuracy estimate of the direction of motion, rad; 1e-5 deg on the wire.
    pub accuracy_course_rad: f64,
    /// Position dilution of precision; 0.01 on the wire.
    pub dilution: f64,
}

impl NavPvt {
    /// UBX class.
    pub const CLASS: u8 = 0x01;
    /// UBX identifier.
    pub const ID: u8 = 0x07;
    /// Payload length, bytes.
    pub const LEN: usize = 92;

    /// Appends the message's frame to `bytes`.
    ///
    /// # Errors
    /// [`EncodeError`] when a field does not fit; `bytes` is then unchanged.
    pub fn encode(&self, bytes: &mut Vec<u8>) -> Result<(), EncodeError> {
        let mut p = Payload([0; Self::LEN]);
        self.put_time(&mut p);
        p.put(20, [self.fix_type.code()]);
        p.put(21, [self.flags()]);
        p.put(23, [self.satellites]);
        p.put(
            24,
            steps::<i32>("longitude", self.position.longitude_rad / DEGREE, 1e7)?.to_le_bytes(),
        );
        p.put(
            28,
            steps::<i32>("latitude", self.position.latitude_rad / DEGREE, 1e7)?.to_le_bytes(),
        );
        for (at, field, metres) in [
            (32, "height", self.position.height_m),
            (36, "height above sea level", self.height_msl_m),
            (48, "velocity north", self.velocity_north_m_s),
            (52, "velocity east", self.velocity_east_m_s),
            (56, "velocity down", self.velocity_down_m_s),
            (60, "ground speed", self.speed_ground_m_s),
        ] {
            p.put(at, steps::<i32>(field, metres, 1e3)?.to_le_bytes());
        }
        p.put(64, steps::<i32>("course", self.course_rad / DEGREE, 1e5)?.to_le_bytes());
        for (at, field, metres) in [
            (40, "horizontal accuracy", self.accuracy_horizontal_m),
            (44, "vertical accuracy", self.accuracy_vertical_m),
            (68, "speed accuracy", self.accuracy_speed_m_s),
        ] {
            p.put(at, steps::<u32>(field, metres, 1e3)?.to_le_bytes());
        }
        let course = steps::<u32>("course accuracy", self.accuracy_course_rad / DEGREE, 1e5)?;
        p.put(72, course.to_le_bytes());
        p.put(76, steps::<u16>("dilution", self.dilution, 1e2)?.to_le_bytes());
        p.put(78, [u8::from(!self.position_valid)]);
        frame::write(Self::CLASS, Self::ID, &p.0, bytes);
        Ok(())
    }

    /// The message in a payload, `None` when the length is another.
    #[must_use]
    pub fn decode(payload: &[u8]) -> Option<Self> {
        let p = Payload::<{ Self::LEN }>::read(payload)?;
        let milli = |at| f64::from(p.i32(at)) * 1e-3;
        let milli_unsigned = |at| f64::from(p.u32(at)) * 1e-3;
        let flags = p.u8(21);
        Some(Self {
            time_of_week_ms: p.u32(0),
            utc: Self::utc(&p),
            fix_type: FixType::from_code(p.u8(20)),
            fix_ok: flags & 1 != 0,
            differential: flags & 2 != 0,
            carrier: CarrierSolution::from_code(flags >> 6),
            position_valid: p.u8(78) & 1 == 0,
            satellites: p.u8(23),
            position: Geodetic {
                longitude_rad: f64::from(p.i32(24)) * 1e-7 * DEGREE,
                latitude_rad: f64::from(p.i32(28)) * 1e-7 * DEGREE,
                height_m: milli(32),
            },
            height_msl_m: milli(36),
            accuracy_horizontal_m: milli_unsigned(40),
            accuracy_vertical_m: milli_unsigned(44),
            velocity_north_m_s: milli(48),
            velocity_east_m_s: milli(52),
            velocity_down_m_s: milli(56),
            speed_ground_m_s: milli(60),
            course_rad: f64::from(p.i32(64)) * 1e-5 * DEGREE,
            accuracy_speed_m_s: milli_unsigned(68),
            accuracy_course_rad: f64::from(p.u32(72)) * 1e-5 * DEGREE,
            dilution: f64::from(p.u16(76)) * 1e-2,
        })
    }

    fn put_time(&self, p: &mut Payload<{ Self::LEN }>) {
        let utc = &self.utc;
        p.put(0, self.time_of_week_ms.to_le_bytes());
        p.put(4, utc.year.to_le_bytes());
        p.put(6, [utc.month, utc.day, utc.hour, utc.minute, utc.second, utc.valid]);
        p.put(16, utc.nanosecond.to_le_bytes());
    }

    fn utc(p: &Payload<{ Self::LEN }>) -> Utc {
        Utc {
            year: p.u16(4),
            month: p.u8(6),
            day: p.u8(7),
            hour: p.u8(8),
            minute: p.u8(9),
            second: p.u8(10),
            valid: p.u8(11),
            nanosecond: p.i32(16),
        }
    }

    fn flags(&self) -> u8 {
        u8::from(self.fix_ok) | u8::from(self.differential) << 1 | self.carrier.code() << 6
    }
}

impl FixType {
    const fn code(self) -> u8 {
        match self {
            Self::None => 0,
            Self::DeadReckoning => 1,
            Self::TwoD => 2,
            Self::ThreeD => 3,
            Self::Combined => 4,
            Self::TimeOnly => 5,
            Self::Reserved(code) => code,
        }
    }

    const fn from_code(code: u8) -> Self {
        match code {
            0 => Self::None,
            1 => Self::DeadReckoning,
            2 => Self::TwoD,
            3 => Self::ThreeD,
            4 => Self::Combined,
            5 => Self::TimeOnly,
            other => Self::Reserved(other),
        }
    }
}

impl CarrierSolution {
    pub(crate) const fn code(self) -> u8 {
        match self {
            Self::None => 0,
            Self::Float => 1,
            Self::Fixed => 2,
            Self::Reserved => 3,
        }
    }

    /// From the low two bits.
    pub(crate) const fn from_code(code: u8) -> Self {
        match code & 3 {
            0 => Self::None,
            1 => Self::Float,
            2 => Self::Fixed,
            _ => Self::Reserved,
        }
    }
}
