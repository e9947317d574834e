//! How many bits a data frame takes on the wire, from its actual bits.
//!
//! | Field | 11-bit | 29-bit | Stuffed |
//! |---|---|---|---|
//! | start of frame | 1 | 1 | yes |
//! | identifier, its first eleven bits | 11 | 11 | yes |
//! | SRR, IDE (both recessive) | | 2 | yes |
//! | identifier, its last eighteen bits | | 18 | yes |
//! | RTR (dominant: a data frame) | 1 | 1 | yes |
//! | IDE, r0 (dominant) or r1, r0 (dominant) | 2 | 2 | yes |
//! | data length code | 4 | 4 | yes |
//! | data | 0 to 64 | 0 to 64 | yes |
//! | CRC-15 | 15 | 15 | yes |
//! | CRC delimiter, ACK slot, ACK delimiter | 3 | 3 | no |
//! | end of frame | 7 | 7 | no |
//! | intermission | 3 | 3 | no |
//!
//! After five equal bits, stuff bits counted, the sender inserts one of the other level
//! (ISO 11898-1); also after the last bit of the CRC. The CRC covers the bits before it,
//! unstuffed: CRC-15/CAN, polynomial 0x4599, initial value 0.

use xt28_dbc::{CanId, Frame};

/// Bits from the CRC delimiter to the last bit of end-of-frame: never stuffed.
pub const TRAILER_BITS: u32 = 3 + 7;
/// Recessive bits between a frame and the next start of frame.
pub const INTERMISSION_BITS: u32 = 3;

const CRC_BITS: u32 = 15;
const CRC_POLYNOMIAL: u16 = 0x4599;
/// The length of a run after which a stuff bit goes in.
const STUFF_AFTER: u8 = 5;

/// Bits from start of frame to the last bit of end-of-frame, stuff bits included: the instant
/// receivers have the frame. 44 to 132 for eleven bits, 64 to 157 for twenty-nine.
#[must_use]
pub fn frame_bits(frame: &Frame) -> u32 {
    let (bits, len) = with_crc(frame);
    len + stuff_bits(bits, len) + TRAILER_BITS
}

/// The stuffed part without its stuff bits, start of frame to CRC, right-aligned; and its length.
fn with_crc(frame: &Frame) -> (u128, u32) {
    let (bits, len) = before_crc(frame);
    (bits << CRC_BITS | u128::from(crc15(bits)), len + CRC_BITS)
}

/// Start of frame to the end of the data, right-aligned; and how many bits that is.
fn before_crc(frame: &Frame) -> (u128, u32) {
    let data = frame.data();
    #[allow(clippy::cast_possible_truncation)] // at most 8
    let dlc = data.len() as u32;
    // Start of frame and all dominant bits are zeros: only lengths count them.
    let (head, head_len) = match frame.id() {
        CanId::Standard(id) => (u64::from(id) << 7, 1 + 11 + 1 + 2 + 4),
        CanId::Extended(id) => {
            let id = u64::from(id);
            (((id >> 18) << 20 | 0b11 << 18 | (id & 0x3_FFFF)) << 7, 1 + 11 + 2 + 18 + 1 + 2 + 4)
        }
    };
    let mut bytes = [0; 8];
    bytes[..data.len()].copy_from_slice(data);
    // Eight bytes left-aligned, moved right by the unused ones; a u64 shift by 64 would overflow.
    let payload = u128::from(u64::from_be_bytes(bytes)) >> (64 - 8 * dlc);
    (u128::from(head | u64::from(dlc)) << (8 * dlc) | payload, head_len + 8 * dlc)
}

/// CRC-15/CAN of right-aligned bits. With an initial value of zero, the zeros in front of them
/// change nothing, so whole bytes can be taken.
fn crc15(bits: u128) -> u16 {
    let bytes = bits.to_be_bytes();
    // At most 39 + 64 bits: the first three bytes are always empty.
    bytes[3..].iter().fold(0, |crc, &byte| {
        let top = (crc >> (CRC_BITS - 8)) ^ u16::from(byte);
        (crc << 8 & 0x7FFF) ^ CRC_TABLE[usize::from(top & 0xFF)]
    })
}

const CRC_TABLE: [u16; 256] = {
    let mut table = [0; 256];
    let mut byte = 0;
    while byte < 256 {
        #[allow(clippy::cast_possible_truncation)] // below 256
        let mut crc = (byte as u16) << (CRC_BITS - 8);
        let mut bit = 0;
        while bit < 8 {
            crc = if crc & 0x4000 == 0 { crc << 1 } else { crc << 1 ^ CRC_POLYNOMIAL } & 0x7FFF;
            bit += 1;
        }
        table[byte] = crc;
        byte += 1;
    }
    table
};

/// How many stuff bits go into the last `len` of right-aligned `bits`.
fn stuff_bits(bits: u128, len: u32) -> u32 {
    let mut run = Run::NONE;
    let mut stuffed = 0;
    let mut left = len;
    while !left.is_multiple_of(8) {
        left -= 1;
        stuffed += u32::from(run.push(bits >> left & 1 == 1));
    }
    let mut state = run.index();
    while left > 0 {
        left -= 8;
        #[allow(clippy::cast_possible_truncation)] // masked
        let step = STUFF_TABLE[state][(bits >> left) as usize & 0xFF];
        stuffed += u32::from(step.stuffed);
        state = usize::from(step.state);
    }
    stuffed
}

/// Equal bits in a row, up to here.
#[derive(Clone, Copy)]
struct Run {
    recessive: bool,
    len: u8,
}

impl Run {
    const NONE: Self = Self { recessive: true, len: 0 };
    /// Lengths 0 to 4 at two levels: a fifth equal bit is followed by a stuff bit, length 1.
    const STATES: usize = 2 * STUFF_AFTER as usize;

    /// Takes one more bit, and the stuff bit after it where one is due; true if it was.
    const fn push(&mut self, recessive: bool) -> bool {
        self.len = if recessive == self.recessive { self.len + 1 } else { 1 };
        self.recessive = recessive;
        let due = self.len == STUFF_AFTER;
        if due {
            *self = Self { recessive: !recessive, len: 1 };
        }
        due
    }

    const fn index(self) -> usize {
        self.len as usize * 2 + self.recessive as usize
    }

    const fn from_index(index: usize) -> Self {
        #[allow(clippy::cast_possible_truncation)] // below STATES
        Self { recessive: index % 2 == 1, len: (index / 2) as u8 }
    }
}

/// What eight bits do to a run: the stuff bits they take, and the run after them.
#[derive(Clone, Copy)]
struct StuffStep {
    stuffed: u8,
    state: u8,
}

static STUFF_TABLE: [[StuffStep; 256]; Run::STATES] = {
    let mut table = [[StuffStep { stuffed: 0, state: 0 }; 256]; Run::STATES];
    let mut state = 0;
    while state < Run::STATES {
        let mut byte = 0;
        while byte < 256 {
            let mut run = Run::from_index(state);
            let mut stuffed = 0;
            let mut bit = 8;
            while bit > 0 {
                bit -= 1;
                stuffed += run.push(byte >> bit & 1 == 1) as u8;
            }
            #[allow(clippy::cast_possible_truncation)] // below STATES
            let next = run.index() as u8;
            table[state][byte] = StuffStep { stuffed, state: next };
            byte += 1;
        }
        state += 1;
    }
    table
};

#[cfg(test)]
#[allow(clippy::unusual_byte_groupings)] // grouped by field
mod tests {
    use super::*;

    fn frame(id: CanId, data: &[u8]) -> Frame {
        Frame::new(id, data).unwrap()
    }

    #[test]
    fn crc_gives_the_catalogue_check_value() {
        // CRC-15/CAN of "123456789" is 0x059E (catalogue of parametrised CRC algorithms).
        let bits = b"123456789".iter().fold(0, |bits, &byte| bits << 8 | u128::from(byte));
        assert_eq!(crc15(bits), 0x059E);
    }

    #[test]
    fn all_dominant_standard_frame_by_hand() {
        // 19 zeros, and their CRC is zero: 34 zeros, a stuff bit after each 5 of them: 6.
        let all_dominant = frame(CanId::Standard(0), &[]);
        assert_eq!(with_crc(&all_dominant), (0, 34));
        assert_eq!(frame_bits(&all_dominant), 34 + 6 + 10);
    }

    #[test]
    fn layout_of_a_standard_frame_by_hand() {
        // SOF, identifier, RTR IDE r0, DLC 1, data.
        let expected = 0b0_101_0101_0101_000_0001_1010_0101;
        assert_eq!(before_crc(&frame(CanId::Standard(0x555), &[0xA5])), (expected, 27));
    }

    #[test]
    fn layout_of_an_extended_frame_by_hand() {
        // SOF, eleven bits, SRR IDE, eighteen bits, RTR r1 r0, DLC 0.
        let expected = 0b0_00011001111_11_111101000000100111_000_0000;
        assert_eq!(before_crc(&frame(CanId::Extended(0x0CFF_4027 & 0x1FFF_FFFF), &[])).1, 39);
        let id = 0b00011001111_111101000000100111;
        assert_eq!(before_crc(&frame(CanId::Extended(id), &[])), (expected, 39));
    }

    #[test]
    fn unstuffed_lengths_are_those_of_the_standard() {
        // 44 + 8 n and 64 + 8 n bits up to end-of-frame, before stuffing.
        for n in 0..=8 {
            let data = vec![0; n];
            let n = u32::try_from(n).unwrap();
            assert_eq!(with_crc(&frame(CanId::Standard(1), &data)).1 + TRAILER_BITS, 44 + 8 * n);
            assert_eq!(with_crc(&frame(CanId::Extended(1), &data)).1 + TRAILER_BITS, 64 + 8 * n);
        }
    }

    #[test]
    fn the_worst_run_takes_a_stuff_bit_every_four_bits() {
        // 11111 0000 1111 0000 ..: each stuff bit opens the next run of five.
        let mut bits: u128 = 0b1_1111;
        let mut len = 5;
        for run in 0..20 {
            bits = bits << 4 | if run % 2 == 0 { 0 } else { 0b1111 };
            len += 4;
            assert_eq!(stuff_bits(bits, len), (len - 1) / 4);
        }
    }

    #[test]
    fn a_run_that_ends_the_crc_is_stuffed_too() {
        assert_eq!(stuff_bits(0b0_1111, 5), 0);
        assert_eq!(stuff_bits(0b0_1_1111, 6), 1);
    }
}
