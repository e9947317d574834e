//! Frame lengths against an independent model that writes every bit down.

use proptest::prelude::*;
use xt28_bus::virtual_bus::wire_bits::frame_bits;
use xt28_dbc::{CanId, Frame};

/// A frame on the wire, bit by bit.
#[derive(Default)]
struct Wire(Vec<bool>);

impl Wire {
    fn field(&mut self, value: u32, bits: u32) {
        self.0.extend((0..bits).rev().map(|bit| value & (1 << bit) != 0));
    }

    /// CRC as the standard gives it: a shift register, one bit after the other.
    fn crc(&self) -> u32 {
        self.0.iter().fold(0, |register, &bit| {
            let feedback = bit != (register & 0x4000 != 0);
            let shifted = register << 1 & 0x7FFF;
            if feedback { shifted ^ 0x4599 } else { shifted }
        })
    }

    /// With a bit of the other level after each five equal ones.
    fn stuffed(&self) -> Self {
        let mut wire: Vec<bool> = Vec::new();
        for &bit in &self.0 {
            wire.push(bit);
            // Looking back over what is on the wire, stuff bits included.
            if let Some([rest @ .., last]) = wire.last_chunk::<5>()
                && rest.iter().all(|level| level == last)
            {
                wire.push(!bit);
            }
        }
        Self(wire)
    }
}

/// Start of frame to the end of the CRC, not stuffed.
fn unstuffed(frame: &Frame) -> Wire {
    let mut wire = Wire::default();
    wire.field(0, 1);
    match frame.id() {
        CanId::Standard(id) => {
            wire.field(id.into(), 11);
            wire.field(0b000, 3);
        }
        CanId::Extended(id) => {
            wire.field(id >> 18, 11);
            wire.field(0b11, 2);
            wire.field(id & 0x3_FFFF, 18);
            wire.field(0b000, 3);
        }
    }
    wire.field(u32::try_from(frame.data().len()).unwrap(), 4);
    frame.data().iter().for_each(|&byte| wire.field(byte.into(), 8));
    wire.field(wire.crc(), 15);
    wire
}

/// CRC delimiter, ACK slot, ACK delimiter, seven bits end-of-frame.
fn reference_bits(frame: &Frame) -> usize {
    unstuffed(frame).stuffed().0.len() + 3 + 7
}

fn any_id() -> impl Strategy<Value = CanId> {
    prop_oneof![
        (0..=0x7FF_u16).prop_map(CanId::Standard),
        (0..=0x1FFF_FFFF_u32).prop_map(CanId::Extended),
        // Long runs are what stuffing is about.
        prop_oneof![Just(0), Just(0x7FF), Just(0x7C1)].prop_map(CanId::Standard),
        prop_oneof![Just(0), Just(0x1FFF_FFFF), Just(0x0787_8787)].prop_map(CanId::Extended),
    ]
}

fn any_data() -> impl Strategy<Value = Vec<u8>> {
    let runs = prop_oneof![Just(0x00), Just(0xFF), Just(0x0F), Just(0xF0), Just(0x78), Just(0x87)];
    proptest::collection::vec(prop_oneof![any::<u8>(), runs], 0..=8)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4_096))]

    #[test]
    fn every_length_is_that_of_the_bits(id in any_id(), data in any_data()) {
        let frame = Frame::new(id, &data).unwrap();
        prop_assert_eq!(frame_bits(&frame) as usize, reference_bits(&frame));
    }

    /// The bounds of the literature: no stuff bit, and one in every four after the first five
    /// (Nolte et al., "Using bit-stuffing distributions in CAN analysis", 2001).
    #[test]
    fn lengths_keep_the_known_bounds(id in any_id(), data in any_data()) {
        let frame = Frame::new(id, &data).unwrap();
        let n = 8 * u32::try_from(data.len()).unwrap();
        let stuffable = if id.is_extended() { 54 + n } else { 34 + n };
        let bits = frame_bits(&frame);
        prop_assert!(bits >= stuffable + 10);
        prop_assert!(bits <= stuffable + 10 + (stuffable - 1) / 4);
    }
}

/// Counted on paper: start of frame and 33 more dominant bits (their CRC is zero) take a stuff
/// bit after each five, 34 + 6; ten bits follow.
#[test]
fn the_reference_counts_as_one_does_on_paper() {
    let all_dominant = Frame::new(CanId::Standard(0), &[]).unwrap();
    assert_eq!(reference_bits(&all_dominant), 50);
    assert_eq!(frame_bits(&all_dominant), 50);
}

/// What `canbusload -e` of can-utils counts for these on a virtual interface, intermission
/// included.
#[test]
fn can_utils_counts_the_same_bits() {
    use xt28_bus::virtual_bus::wire_bits::INTERMISSION_BITS;
    let counted: [(CanId, &[u8], u32); 6] = [
        (CanId::Standard(0x000), &[], 53),
        (CanId::Standard(0x7FF), &[], 50),
        (CanId::Standard(0x555), &[0x55; 8], 112),
        (CanId::Extended(0x0CFF_4027), &[0x55, 0x55, 0x55, 0x55, 0x55, 0x55, 0x12, 0x99], 135),
        (CanId::Extended(0x0000_0000), &[0x00; 8], 150),
        (CanId::Extended(0x1FFF_FFFF), &[0xFF; 8], 149),
    ];
    for (id, data, bits) in counted {
        let frame = Frame::new(id, data).unwrap();
        assert_eq!(frame_bits(&frame) + INTERMISSION_BITS, bits, "{frame:?}");
    }
}
