//! Whole numbers as the firmware stores them: cut off towards zero, and wrapped where C wraps.

/// `value` cut off towards zero; 0 for what is not a number, the nearest end beyond 32 bits.
#[allow(clippy::cast_possible_truncation)] // `as` cuts off, saturates, and gives 0 for NaN
pub(super) const fn cut(value: f64) -> i32 {
    value as i32
}

/// `value` as a signed word on the wire, wrapped.
#[allow(clippy::cast_possible_truncation)] // wrapping is what a 16-bit store does
pub(super) fn s16(value: i32) -> f64 {
    f64::from(value as i16)
}

/// `value` as an unsigned word on the wire, wrapped.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // as above
pub(super) fn u16(value: i32) -> f64 {
    f64::from(value as u16)
}

/// `value` as an unsigned byte on the wire, wrapped.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // as above
pub(super) const fn u8(value: i32) -> u8 {
    value as u8
}

/// A sensor value that the firmware keeps in an unsigned word: negative ones wrap, or are held at 0
/// where `wraps` is off.
pub(super) fn unsigned(value: i32, wraps: bool) -> i32 {
    if wraps { cut(u16(value)) } else { value.max(0) }
}

/// A voltage as an input reads it: whole mV, 0 to 5500 (assumed).
pub(super) fn input_mv(mv: f64) -> i32 {
    cut(mv.clamp(0.0, 5500.0).round())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cuts_towards_zero_and_wraps_like_c() {
        assert_eq!([cut(1.9), cut(-1.9), cut(f64::NAN)], [1, -1, 0]);
        assert_eq!(unsigned(-1, true), 65_535);
        assert_eq!(unsigned(-1, false), 0);
        assert_eq!([s16(40_000), u16(-2), f64::from(u8(256 + 7))], [-25_536.0, 65_534.0, 7.0]);
        assert_eq!([input_mv(1902.06), input_mv(f64::NAN), input_mv(9e9)], [1902, 0, 5500]);
    }
}
