//! From SI to the integers of the wire: rounded to nearest, refused when they do not fit.

/// Why a message has no wire form.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum EncodeError {
    /// A number is not finite, or too large for its field.
    #[error(
        "{field} = {value} does not fit its UBX field; it must be finite and in the field's range"
    )]
    Range {
        /// The field of the message.
        field: &'static str,
        /// Its value, in the unit of the struct.
        value: f64,
    },
}

/// An integer type of the UBX wire.
pub(crate) trait WireInt: Sized {
    /// The integer nearest to `steps`, if the type has it.
    fn nearest(steps: f64) -> Option<Self>;
}

macro_rules! wire_int {
    ($($kind:ty),*) => {$(
        impl WireInt for $kind {
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // range checked
            fn nearest(steps: f64) -> Option<Self> {
                let whole = steps.round();
                // NaN fails the comparison; every bound here is exact in f64.
                (whole >= Self::MIN as f64 && whole <= Self::MAX as f64).then_some(whole as Self)
            }
        }
    )*};
}

wire_int!(u8, i8, u16, i16, u32, i32);

/// `value` as a whole number of steps of size `1 / per_unit`.
pub(crate) fn steps<T: WireInt>(
    field: &'static str,
    value: f64,
    per_unit: f64,
) -> Result<T, EncodeError> {
    T::nearest(value * per_unit).ok_or(EncodeError::Range { field, value })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounds_to_nearest_and_refuses_what_does_not_fit() {
        assert_eq!(steps::<i32>("x", -1.0006, 1e3), Ok(-1001));
        assert_eq!(steps::<i8>("x", 127.4, 1.0), Ok(127));
        for value in [127.5, -129.0, f64::NAN, f64::INFINITY] {
            assert!(steps::<i8>("x", value, 1.0).is_err(), "{value}");
        }
    }
}
