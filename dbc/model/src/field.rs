//! A number in a frame: where its bits are, and the one conversion between raw and physical.
//!
//! Generated code and databases read at run time both convert through here.

/// How the bits of a field are read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Unsigned integer.
    Unsigned,
    /// Two's complement.
    Signed,
    /// IEEE 754, 32 bits.
    Float32,
    /// IEEE 754, 64 bits.
    Float64,
}

/// A number in a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Field {
    /// Start bit as the database counts: lowest bit of a little-endian field, highest of a
    /// big-endian one.
    pub start: u16,
    /// Length, 1 to 64 bits.
    pub length: u16,
    /// Most significant byte first.
    pub big_endian: bool,
    /// How the bits are read.
    pub kind: Kind,
    /// Physical value per raw unit; never zero.
    pub factor: f64,
    /// Physical value at raw zero.
    pub offset: f64,
    /// Least physical value allowed.
    pub min: f64,
    /// Greatest physical value allowed.
    pub max: f64,
}

/// Why a number cannot be written, or was not believed when read.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum ValueError {
    /// NaN or infinite.
    #[error("{0} is not a finite number")]
    NotFinite(f64),
    /// Outside the range the database gives, or outside what the bits hold.
    #[error("{value} is outside {min} to {max}")]
    OutOfRange {
        /// The value.
        value: f64,
        /// Least allowed.
        min: f64,
        /// Greatest allowed.
        max: f64,
    },
}

impl Field {
    /// Bits of the field, as an unsigned number; bits beyond `data` read as zero.
    #[must_use]
    pub fn raw(&self, data: &[u8]) -> u64 {
        let mut raw = 0_u64;
        for i in 0..self.length {
            let (byte, bit) = self.position(i);
            let value = data.get(usize::from(byte)).map_or(0, |b| b >> bit & 1);
            raw |= u64::from(value) << i;
        }
        raw
    }

    /// Writes the lowest bits of `raw` into the field; bits beyond `data` are dropped.
    pub fn set_raw(&self, data: &mut [u8], raw: u64) {
        for i in 0..self.length {
            let (byte, bit) = self.position(i);
            if let Some(b) = data.get_mut(usize::from(byte)) {
                *b = *b & !(1 << bit) | (((raw >> i & 1) as u8) << bit);
            }
        }
    }

    /// Physical value, checked against the range.
    ///
    /// # Errors
    /// [`ValueError`] when the bits say something the database does not allow.
    pub fn read(&self, data: &[u8]) -> Result<f64, ValueError> {
        let value = self.physical(self.raw(data));
        self.check(value)?;
        Ok(value)
    }

    /// Writes a physical value, rounded half away from zero to the next raw unit.
    ///
    /// # Errors
    /// [`ValueError`] when it is not finite or out of range; `data` is then unchanged.
    pub fn write(&self, data: &mut [u8], value: f64) -> Result<(), ValueError> {
        let raw = self.to_raw(value)?;
        self.set_raw(data, raw);
        Ok(())
    }

    /// Physical value of raw bits, unchecked.
    #[must_use]
    #[allow(clippy::cast_precision_loss, clippy::cast_possible_truncation)]
    pub fn physical(&self, raw: u64) -> f64 {
        let number = match self.kind {
            Kind::Unsigned => raw as f64,
            Kind::Signed => self.sign_extended(raw) as f64,
            Kind::Float32 => f64::from(f32::from_bits(raw as u32)),
            Kind::Float64 => f64::from_bits(raw),
        };
        number * self.factor + self.offset
    }

    /// Raw bits of a physical value, rounded half away from zero.
    ///
    /// # Errors
    /// [`ValueError`].
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    pub fn to_raw(&self, value: f64) -> Result<u64, ValueError> {
        if !value.is_finite() {
            return Err(ValueError::NotFinite(value));
        }
        // Half a raw unit of slack, so that 510.3 mm at 2 mm a bit means 510 and not an error.
        let slack = |end| if self.is_float() { self.slack(end) } else { self.factor.abs() / 2.0 };
        let out = ValueError::OutOfRange { value, min: self.min, max: self.max };
        if value < self.min - slack(self.min) || value > self.max + slack(self.max) {
            return Err(out);
        }
        let number = (value - self.offset) / self.factor;
        let raw = match self.kind {
            Kind::Float32 => u64::from((number as f32).to_bits()),
            Kind::Float64 => number.to_bits(),
            Kind::Unsigned | Kind::Signed => {
                let whole = round_half_away(number);
                if whole < self.raw_range().0 || whole >= self.raw_end() {
                    return Err(out);
                }
                let bits = if whole < 0.0 { (whole as i64) as u64 } else { whole as u64 };
                bits & self.mask()
            }
        };
        // What is sent must itself be allowed: rounding may step over the end of the range, and a
        // float may overflow.
        if self.check(self.physical(raw)).is_err() {
            return Err(out);
        }
        Ok(raw)
    }

    /// Least and greatest physical value that the bits can hold.
    #[must_use]
    pub fn physical_range(&self) -> (f64, f64) {
        if self.is_float() {
            let max = if self.kind == Kind::Float32 { f64::from(f32::MAX) } else { f64::MAX };
            return (-max, max);
        }
        let (low, high) = self.raw_range();
        let (a, b) = (low * self.factor + self.offset, high * self.factor + self.offset);
        (a.min(b), a.max(b))
    }

    /// Bit positions the field covers, counted from bit 0 of byte 0.
    pub fn bits(&self) -> impl Iterator<Item = u16> + '_ {
        (0..self.length).map(|i| {
            let (byte, bit) = self.position(i);
            byte * 8 + u16::from(bit)
        })
    }

    /// True for IEEE 754 fields.
    #[must_use]
    pub const fn is_float(&self) -> bool {
        matches!(self.kind, Kind::Float32 | Kind::Float64)
    }

    /// Byte and bit of the `i`-th lowest bit.
    #[allow(clippy::cast_possible_truncation)]
    const fn position(&self, i: u16) -> (u16, u8) {
        if self.big_endian {
            // Counted along the wire: bit 7 of byte 0 first, so lower bits come later.
            let first = self.start / 8 * 8 + 7 - self.start % 8;
            let along = first + self.length - 1 - i;
            (along / 8, (7 - along % 8) as u8)
        } else {
            let bit = self.start + i;
            (bit / 8, (bit % 8) as u8)
        }
    }

    fn check(&self, value: f64) -> Result<(), ValueError> {
        if !value.is_finite() {
            return Err(ValueError::NotFinite(value));
        }
        if value < self.min - self.slack(self.min) || value > self.max + self.slack(self.max) {
            return Err(ValueError::OutOfRange { value, min: self.min, max: self.max });
        }
        Ok(())
    }

    /// How far beyond an end of the range a value still counts as that end. The end is a decimal
    /// number, the value a product or the nearest float: 0.18 is 0.180000007 in 32 bits.
    fn slack(&self, end: f64) -> f64 {
        let step = match self.kind {
            Kind::Float32 => f64::from(f32::EPSILON),
            Kind::Float64 => f64::EPSILON,
            Kind::Unsigned | Kind::Signed => return self.factor.abs() * 1e-6,
        };
        // The raw number's last place, and that of the sum with the offset.
        (end - self.offset).abs() * step + (end.abs() + self.offset.abs()) * f64::EPSILON
    }

    #[allow(clippy::cast_possible_wrap)]
    const fn sign_extended(&self, raw: u64) -> i64 {
        let unused = 64 - self.length;
        (raw << unused) as i64 >> unused
    }

    const fn mask(&self) -> u64 {
        u64::MAX >> (64 - self.length)
    }

    /// The first whole number above all raw ones. A power of two, so exact where the greatest raw
    /// number of a long field is not.
    fn raw_end(&self) -> f64 {
        let bits = if self.kind == Kind::Signed { self.length - 1 } else { self.length };
        2.0_f64.powi(i32::from(bits))
    }

    #[allow(clippy::cast_precision_loss)]
    const fn raw_range(&self) -> (f64, f64) {
        match self.kind {
            Kind::Signed => {
                let half = (1_u64 << (self.length - 1)) as f64;
                (-half, half - 1.0)
            }
            _ => (0.0, self.mask() as f64),
        }
    }
}

/// The nearest whole number, halves away from zero. A decimal half such as 0.15 / 0.1 comes out a
/// few units in the last place off; within four of them it counts as the half that was meant.
fn round_half_away(number: f64) -> f64 {
    // Where those units are coarse, no more than a thousandth: a whole number is not a half.
    let room = (4.0 * f64::EPSILON * number.abs()).min(1e-3);
    let half = number.trunc() + 0.5_f64.copysign(number);
    if (number - half).abs() <= room { half.round() } else { number.round() }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn field(start: u16, length: u16, big_endian: bool, kind: Kind) -> Field {
        let mut field =
            Field { start, length, big_endian, kind, factor: 1.0, offset: 0.0, min: 0.0, max: 0.0 };
        (field.min, field.max) = field.physical_range();
        field
    }

    #[test]
    fn rounds_half_away_from_zero() {
        let f = Field { factor: 2.0, ..field(0, 8, false, Kind::Signed) };
        let f = Field { min: f.physical_range().0, max: f.physical_range().1, ..f };
        for (value, raw) in [(3.0, 2), (-3.0, -2_i8), (5.0, 3), (4.9, 2), (-5.0, -3)] {
            assert_eq!(f.to_raw(value).unwrap() as u8 as i8, raw, "{value}");
        }
    }

    #[test]
    fn decimal_halves_round_away_from_zero_too() {
        let f = Field { factor: 0.1, min: -100.0, max: 100.0, ..field(0, 16, false, Kind::Signed) };
        for (value, raw) in
            [(0.15, 2), (0.35, 4), (-0.15, -2), (0.149, 1), (0.05, 1), (99.95, 1000)]
        {
            assert_eq!(f.to_raw(value).unwrap() as u16 as i16, raw, "{value}");
        }
        // As large as a half can still be told from a whole number, the whole one stays.
        let long = field(0, 51, false, Kind::Unsigned);
        assert_eq!(long.to_raw(562_949_953_421_312.0), Ok(562_949_953_421_312));
    }

    #[test]
    fn rounding_never_steps_over_the_range() {
        let f = Field { min: -100.0, max: 100.0, ..field(0, 8, false, Kind::Signed) };
        assert_eq!(f.to_raw(100.4), Ok(100));
        for value in [100.5, -100.5] {
            assert!(matches!(f.to_raw(value), Err(ValueError::OutOfRange { .. })), "{value}");
        }
    }

    #[test]
    fn sixty_four_bits_neither_wrap_nor_saturate() {
        let signed = field(0, 64, false, Kind::Signed);
        assert!(signed.to_raw(9_223_372_036_854_775_808.0).is_err());
        assert_eq!(signed.to_raw(-9_223_372_036_854_775_808.0), Ok(1 << 63));
        assert!(field(0, 64, false, Kind::Unsigned).to_raw(18_446_744_073_709_551_616.0).is_err());
    }

    #[test]
    fn a_float_that_overflows_is_refused() {
        let f = Field { factor: 1e-3, min: -1e38, max: 1e38, ..field(0, 32, false, Kind::Float32) };
        assert!(f.to_raw(1e37).is_err());
        assert!(f.to_raw(1e34).is_ok());
    }

    #[test]
    fn big_endian_counts_along_the_wire() {
        // Motorola 16 bits from bit 7 of byte 0: bytes 0 and 1, high byte first.
        let f = field(7, 16, true, Kind::Unsigned);
        assert_eq!(f.raw(&[0x12, 0x34]), 0x1234);
        // 12 bits from bit 3 of byte 0: low nibble of byte 0, all of byte 1.
        let f = field(3, 12, true, Kind::Unsigned);
        assert_eq!(f.raw(&[0xA5, 0xC3]), 0x5C3);
    }

    #[test]
    fn refuses_what_is_no_number_or_too_much() {
        let f = field(0, 8, false, Kind::Unsigned);
        assert!(matches!(f.to_raw(f64::NAN), Err(ValueError::NotFinite(_))));
        assert!(matches!(f.to_raw(f64::INFINITY), Err(ValueError::NotFinite(_))));
        assert!(matches!(f.to_raw(256.0), Err(ValueError::OutOfRange { .. })));
        assert!(matches!(f.to_raw(-1.0), Err(ValueError::OutOfRange { .. })));
    }

    proptest! {
        #[test]
        fn what_is_written_is_read(
            start in 0_u16..64,
            length in 1_u16..=64,
            big_endian: bool,
            signed: bool,
            raw: u64,
            before: [u8; 8],
        ) {
            let kind = if signed { Kind::Signed } else { Kind::Unsigned };
            let f = field(start, length, big_endian, kind);
            prop_assume!(f.bits().all(|bit| bit < 64));
            let mut data = before;
            let raw = raw & f.mask();
            f.set_raw(&mut data, raw);
            prop_assert_eq!(f.raw(&data), raw);
            // Nothing beside the field has changed.
            let covered: Vec<u16> = f.bits().collect();
            for bit in (0..64).filter(|bit| !covered.contains(bit)) {
                let at = |d: &[u8; 8]| d[usize::from(bit / 8)] >> (bit % 8) & 1;
                prop_assert_eq!(at(&data), at(&before));
            }
            if length <= 53 {
                prop_assert_eq!(f.to_raw(f.physical(raw)).unwrap(), raw);
            }
        }

        #[test]
        fn what_can_be_written_can_be_read(
            value: f64,
            near in -130.0..130.0_f64,
            length in 1_u16..=64,
            signed: bool,
            factor in prop_oneof![Just(1.0), Just(2.0), Just(0.1), Just(-0.5)],
        ) {
            let kind = if signed { Kind::Signed } else { Kind::Unsigned };
            let f = Field { factor, ..field(0, length, false, kind) };
            let (low, high) = f.physical_range();
            let f = Field { min: low.max(-100.0), max: high.min(100.0), ..f };
            for value in [value, near, near.round() + 0.5] {
                if let Ok(raw) = f.to_raw(value) {
                    prop_assert!(f.read(&raw.to_le_bytes()).is_ok(), "{value} as {raw}");
                }
            }
        }

        #[test]
        fn any_number_is_written_or_refused(value: f64, length in 1_u16..=64, signed: bool) {
            let kind = if signed { Kind::Signed } else { Kind::Unsigned };
            let f = Field { factor: 0.37, offset: -3.0, ..field(0, length, false, kind) };
            let f = Field { min: f.physical_range().0, max: f.physical_range().1, ..f };
            if let Ok(raw) = f.to_raw(value) {
                prop_assert!((f.physical(raw) - value).abs() <= 0.37 * 0.5001 + value.abs() * 1e-9);
            }
        }
    }
}
