//! Trouble codes off the bus: DM1 in one frame, or in the packets of a broadcast.

use xt28_dbc::{CanId, Frame};

/// What an ECU said is wrong at an instant.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Trouble {
    /// The codes, each a suspect parameter number and a failure mode.
    pub codes: Vec<(u32, u8)>,
}

/// DM1, less the sender's address.
const DM1: u32 = 0x18FE_CA00;
/// Connection management and data to all, less the sender's address.
const ANNOUNCE: u32 = 0x1CEC_FF00;
const PACKET: u32 = 0x1CEB_FF00;
const BAM: u8 = 0x20;
const DM1_GROUP: [u8; 3] = [0xCA, 0xFE, 0x00];

/// Puts the DM1 of one sender together.
#[derive(Clone, Debug)]
pub(crate) struct TroubleReader {
    address: u8,
    length: usize,
    bytes: Vec<u8>,
}

impl TroubleReader {
    /// For the node at `address`.
    pub(crate) const fn new(address: u8) -> Self {
        Self { address, length: 0, bytes: Vec::new() }
    }

    /// Takes a frame; gives what it completes.
    pub(crate) fn push(&mut self, frame: &Frame) -> Option<Trouble> {
        let CanId::Extended(raw) = frame.id() else { return None };
        if raw & 0xFF != u32::from(self.address) {
            return None;
        }
        match (raw & !0xFF, frame.data()) {
            (DM1, data) => Some(read(data)),
            (ANNOUNCE, &[BAM, low, high, _, _, a, b, c]) if [a, b, c] == DM1_GROUP => {
                self.length = usize::from(u16::from_le_bytes([low, high]));
                self.bytes.clear();
                None
            }
            (PACKET, [number, data @ ..]) if self.length > 0 => {
                if usize::from(*number) != self.bytes.len() / 7 + 1 {
                    self.length = 0;
                    return None;
                }
                self.bytes.extend(data);
                (self.bytes.len() >= self.length).then(|| {
                    self.bytes.truncate(self.length);
                    self.length = 0;
                    read(&self.bytes)
                })
            }
            _ => None,
        }
    }
}

/// Codes behind the two lamp bytes; four zeros are none.
fn read(data: &[u8]) -> Trouble {
    let codes = data.get(2..).unwrap_or_default().chunks_exact(4);
    let code = |c: &[u8]| {
        let spn = u32::from(c[0]) | u32::from(c[1]) << 8 | u32::from(c[2] >> 5) << 16;
        (spn, c[2] & 0x1F)
    };
    Trouble { codes: codes.filter(|c| *c != [0; 4]).map(code).collect() }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn push(reader: &mut TroubleReader, id: u32, data: &[u8]) -> Option<Vec<(u32, u8)>> {
        let frame = Frame::new(CanId::Extended(id), data).unwrap();
        reader.push(&frame).map(|trouble| trouble.codes)
    }

    #[test]
    fn one_frame_and_a_broadcast_are_read() {
        let mut reader = TroubleReader::new(0x28);
        let none = push(&mut reader, 0x18FE_CA28, &[0, 0xFF, 0, 0, 0, 0, 0xFF, 0xFF]);
        assert_eq!(none, Some(vec![]));
        let one = push(&mut reader, 0x18FE_CA28, &[4, 0xFF, 0x1C, 0xF0, 0xE9, 1, 0xFF, 0xFF]);
        assert_eq!(one, Some(vec![(520_220, 9)]));
        push(&mut reader, 0x1CEC_FF28, &[0x20, 10, 0, 2, 0xFF, 0xCA, 0xFE, 0]);
        push(&mut reader, 0x1CEB_FF29, &[1, 9, 9, 9, 9, 9, 9, 9]);
        assert_eq!(push(&mut reader, 0x1CEB_FF28, &[1, 0, 0xFF, 168, 0, 1, 1, 0]), None);
        let two = push(&mut reader, 0x1CEB_FF28, &[2, 0xF0, 0xE5, 1, 0xFF, 0xFF, 0xFF, 0xFF]);
        assert_eq!(two, Some(vec![(168, 1), (520_192, 5)]));
    }

    #[test]
    fn a_lost_packet_loses_the_message() {
        let mut reader = TroubleReader::new(0x28);
        push(&mut reader, 0x1CEC_FF28, &[0x20, 10, 0, 2, 0xFF, 0xCA, 0xFE, 0]);
        assert_eq!(push(&mut reader, 0x1CEB_FF28, &[2, 0, 0, 0, 0, 0, 0, 0]), None);
        assert_eq!(push(&mut reader, 0x1CEB_FF28, &[1, 0, 0, 0, 0, 0, 0, 0]), None);
    }
}
