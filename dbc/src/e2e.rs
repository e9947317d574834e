//! End-to-end protection of our frames: CRC-8 with a data ID, and alive counters.
//!
//! The CRC is that of AUTOSAR E2E profile 11 (CRC-8 SAE J1850: polynomial 1D, initial value and
//! final exclusive-or FF) over the data ID, low byte first, and the payload without the CRC, which
//! sits in byte 7.

use crate::DecodeError;

/// Where the CRC sits.
const CRC_BYTE: usize = 7;
const POLYNOMIAL: u8 = 0x1D;

const TABLE: [u8; 256] = {
    let mut table = [0; 256];
    let mut i = 0;
    while i < 256 {
        #[allow(clippy::cast_possible_truncation)]
        let mut crc = i as u8;
        let mut bit = 0;
        while bit < 8 {
            crc = if crc & 0x80 == 0 { crc << 1 } else { crc << 1 ^ POLYNOMIAL };
            bit += 1;
        }
        table[i] = crc;
        i += 1;
    }
    table
};

/// The CRC of a payload whose bytes before the CRC are `payload`.
#[must_use]
pub fn crc(data_id: u16, payload: &[u8]) -> u8 {
    let id = data_id.to_le_bytes();
    let bytes = id.iter().chain(payload);
    bytes.fold(0xFF, |crc, byte| TABLE[usize::from(crc ^ byte)]) ^ 0xFF
}

pub(crate) fn protect(data_id: u16, data: &mut [u8; 8]) {
    data[CRC_BYTE] = crc(data_id, &data[..CRC_BYTE]);
}

pub(crate) fn verify(data_id: u16, data: &[u8], message: &'static str) -> Result<(), DecodeError> {
    let (payload, rest) = data.split_at(CRC_BYTE.min(data.len()));
    let (want, got) = (crc(data_id, payload), rest.first().copied().unwrap_or(0));
    if want == got { Ok(()) } else { Err(DecodeError::Crc { message, want, got }) }
}

/// The sender's side of an alive counter: 0 to 15 and around.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct AliveCounter(u8);

impl AliveCounter {
    /// The counter of the next frame.
    pub fn next_count(&mut self) -> u8 {
        let count = self.0;
        self.0 = (count + 1) % 16;
        count
    }
}

/// The receiver's side: what a counter says of the frames since the last.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct AliveCheck(Option<u8>);

/// What a counter says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Alive {
    /// The first frame, or the next in line.
    Fresh,
    /// The same as the last: a sender that is stuck, or a frame sent twice.
    Repeated,
    /// This many frames are missing, 1 to 14.
    Lost(u8),
}

impl AliveCheck {
    /// Takes the counter of a frame, 0 to 15.
    pub fn check(&mut self, counter: u8) -> Alive {
        let counter = counter % 16;
        let before = self.0.replace(counter);
        match before.map(|before| (counter + 16 - before) % 16) {
            None | Some(1) => Alive::Fresh,
            Some(0) => Alive::Repeated,
            Some(step) => Alive::Lost(step - 1),
        }
    }

    /// Forgets the last counter: the next frame is fresh whatever it says.
    pub fn reset(&mut self) {
        self.0 = None;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::messages::{ArmTarget, ArmTargetMode, DriveTarget};
    use crate::{CanId, Frame};

    /// Frames of a recorded machine.
    const LOGGED: [(u32, u16, [u8; 8]); 3] = [
        (0x0CFF_4027, 0x4027, [0x55, 0x55, 0x55, 0x55, 0x55, 0x55, 0x12, 0x99]),
        (0x0CFF_4127, 0x4127, [0, 0, 0, 0, 0x78, 0x02, 0x01, 0xA6]),
        (0x0CFF_4027, 0x4027, [0x55, 0x55, 0x55, 0x55, 0x55, 0x55, 0x22, 0xD3]),
    ];

    #[test]
    fn logged_frames_verify() {
        for (_, data_id, data) in LOGGED {
            assert_eq!(crc(data_id, &data[..7]), data[7]);
        }
        let frame = Frame::new(CanId::Extended(LOGGED[0].0), &LOGGED[0].2).unwrap();
        let target = ArmTarget::decode(&frame).unwrap();
        assert_eq!((target.fr_mm, target.mode), (170.0, ArmTargetMode::ManualPosition));
        assert_eq!(target.encode().unwrap(), frame);
        let frame = Frame::new(CanId::Extended(LOGGED[1].0), &LOGGED[1].2).unwrap();
        let target = DriveTarget::decode(&frame).unwrap();
        assert_eq!((target.engine_speed_rpm, target.enable), (1200.0, true));
    }

    #[test]
    fn every_flipped_bit_and_pair_of_bits_is_caught() {
        let (id, _, data) = LOGGED[0];
        for a in 0..64 {
            for b in a..64 {
                let mut bad = data;
                bad[a / 8] ^= 1 << (a % 8);
                if b != a {
                    bad[b / 8] ^= 1 << (b % 8);
                }
                let frame = Frame::new(CanId::Extended(id), &bad).unwrap();
                let caught = matches!(ArmTarget::decode(&frame), Err(DecodeError::Crc { .. }));
                assert!(caught, "bits {a} and {b}");
            }
        }
    }

    #[test]
    fn a_frame_of_another_message_is_caught_by_the_data_id() {
        let (_, _, data) = LOGGED[0];
        let frame = Frame::new(DriveTarget::ID, &data).unwrap();
        assert!(matches!(DriveTarget::decode(&frame), Err(DecodeError::Crc { .. })));
    }

    #[test]
    fn counters_go_round_and_say_what_is_missing() {
        let (mut counter, mut check) = (AliveCounter::default(), AliveCheck::default());
        for _ in 0..40 {
            assert_eq!(check.check(counter.next_count()), Alive::Fresh);
        }
        let last = counter.next_count();
        assert_eq!(check.check(last), Alive::Fresh);
        assert_eq!(check.check(last), Alive::Repeated);
        counter.next_count();
        counter.next_count();
        assert_eq!(check.check(counter.next_count()), Alive::Lost(2));
        check.reset();
        assert_eq!(check.check(3), Alive::Fresh);
    }
}
