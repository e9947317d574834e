//! The UBX frame around a payload: sync, class, identifier, length, payload, checksum.

use crate::{EncodeError, NavHpPosLlh, NavPvt, NavRelPosNed};

/// First two bytes of every frame.
pub(crate) const SYNC: [u8; 2] = [0xB5, 0x62];
/// Sync, class, identifier and length.
pub(crate) const HEADER: usize = 6;
/// Two checksum bytes.
pub(crate) const TRAILER: usize = 2;
/// Longest payload the parser waits for. The longest here has 92 bytes; the longest a ZED-F9P sends
/// on its own (NAV-SAT, NAV-SIG) stays below; a corrupt length can thus stall it for 2 KiB at most.
pub(crate) const PAYLOAD_MAX: usize = 2048;

/// A message of the three kinds the machine uses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Message {
    /// Position, velocity, time.
    Pvt(NavPvt),
    /// Position to a tenth of a millimetre.
    HpPosLlh(NavHpPosLlh),
    /// Where the second antenna is from the first: heading.
    RelPosNed(NavRelPosNed),
}

impl Message {
    /// Appends the message's frame to `bytes`.
    ///
    /// # Errors
    /// [`EncodeError`] when a field does not fit; `bytes` is then unchanged.
    pub fn encode(&self, bytes: &mut Vec<u8>) -> Result<(), EncodeError> {
        match self {
            Self::Pvt(pvt) => pvt.encode(bytes),
            Self::HpPosLlh(position) => position.encode(bytes),
            Self::RelPosNed(relative) => relative.encode(bytes),
        }
    }

    /// Milliseconds into the GPS week of the epoch the message belongs to.
    #[must_use]
    pub const fn time_of_week_ms(&self) -> u32 {
        match self {
            Self::Pvt(m) => m.time_of_week_ms,
            Self::HpPosLlh(m) => m.time_of_week_ms,
            Self::RelPosNed(m) => m.time_of_week_ms,
        }
    }
}

/// The UBX checksum over class, identifier, length and payload: an 8-bit Fletcher sum (RFC 1145 form).
#[must_use]
pub fn checksum(bytes: &[u8]) -> [u8; 2] {
    let (mut a, mut b) = (0_u8, 0_u8);
    for byte in bytes {
        a = a.wrapping_add(*byte);
        b = b.wrapping_add(a);
    }
    [a, b]
}

/// Appends a frame to `bytes`. Payloads here are constants below 64 KiB.
pub(crate) fn write<const N: usize>(class: u8, id: u8, payload: &[u8; N], bytes: &mut Vec<u8>) {
    const { assert!(N <= PAYLOAD_MAX) };
    bytes.extend_from_slice(&SYNC);
    let covered = bytes.len();
    #[allow(clippy::cast_possible_truncation)] // at most PAYLOAD_MAX
    let length = (N as u16).to_le_bytes();
    bytes.extend_from_slice(&[class, id, length[0], length[1]]);
    bytes.extend_from_slice(payload);
    let sum = checksum(&bytes[covered..]);
    bytes.extend_from_slice(&sum);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_checksum_of_a_known_frame() {
        // A poll of MON-VER is B5 62 0A 04 00 00 0E 34 in every u-blox manual.
        assert_eq!(checksum(&[0x0A, 0x04, 0x00, 0x00]), [0x0E, 0x34]);
    }
}
