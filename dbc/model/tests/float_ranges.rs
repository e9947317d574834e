//! Floats at the ends of their range, which are decimal numbers that no float may be.

use proptest::prelude::*;
use xt28_dbc_model::{Field, Kind};

const SINGLE: Field = Field {
    start: 0,
    length: 32,
    big_endian: false,
    kind: Kind::Float32,
    factor: 1.0,
    offset: 0.0,
    min: 0.0,
    max: 0.18,
};

#[test]
fn a_float_at_the_declared_end_is_believed_and_one_beyond_it_is_not() {
    // As 32 bits, 0.18 is 0.180000007.
    let raw = SINGLE.to_raw(0.18).unwrap();
    assert!(SINGLE.read(&raw.to_le_bytes()).unwrap() > 0.18);
    for beyond in [0.180_000_1, -1e-9] {
        assert!(SINGLE.to_raw(beyond).is_err(), "{beyond}");
    }
}

proptest! {
    #[test]
    fn both_ends_are_written_and_read(
        ends in (-1e6..1e6_f64, -1e6..1e6_f64),
        factor in prop_oneof![Just(1.0), Just(0.001), Just(-0.37)],
        offset in prop_oneof![Just(0.0), Just(-273.15), Just(1e3)],
        double: bool,
    ) {
        let (kind, length) = if double { (Kind::Float64, 64) } else { (Kind::Float32, 32) };
        let (min, max) = (ends.0.min(ends.1), ends.0.max(ends.1));
        let f = Field { kind, length, factor, offset, min, max, ..SINGLE };
        for end in [min, max] {
            let raw = f.to_raw(end);
            prop_assert!(raw.is_ok_and(|raw| f.read(&raw.to_le_bytes()).is_ok()), "{end} {raw:?}");
        }
    }
}
