//! Who wins the bus: arbitration fields as numbers that compare as the wire compares bits.

use xt28_dbc::CanId;

/// The arbitration field of a data frame as one number; the smaller wins.
///
/// On the wire both formats begin with eleven identifier bits. Then a standard frame sends RTR
/// and IDE dominant (0) where an extended frame sends SRR and IDE recessive (1), so of equal
/// first eleven bits the standard frame wins. The eighteen remaining identifier bits come last
/// (ISO 11898-1, MAC frame formats).
#[must_use]
pub const fn priority(id: CanId) -> u32 {
    const EXTENSION_BITS: u32 = 18;
    match id {
        CanId::Standard(raw) => (raw as u32) << (EXTENSION_BITS + 1),
        CanId::Extended(raw) => {
            let base = raw >> EXTENSION_BITS;
            let extension = raw & ((1 << EXTENSION_BITS) - 1);
            base << (EXTENSION_BITS + 1) | 1 << EXTENSION_BITS | extension
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_standard_frame_wins_over_an_extended_one_with_the_same_base() {
        let base = 0x155;
        assert!(priority(CanId::Standard(base)) < priority(CanId::Extended(u32::from(base) << 18)));
    }

    #[test]
    fn an_extended_frame_with_a_lower_base_wins_over_a_standard_one() {
        assert!(
            priority(CanId::Extended(0x154 << 18 | 0x3_FFFF)) < priority(CanId::Standard(0x155))
        );
    }

    #[test]
    fn within_a_format_the_lower_identifier_wins() {
        assert!(priority(CanId::Standard(0x0FF)) < priority(CanId::Standard(0x100)));
        assert!(priority(CanId::Extended(0x0CFF_4027)) < priority(CanId::Extended(0x0CFF_4127)));
    }
}
