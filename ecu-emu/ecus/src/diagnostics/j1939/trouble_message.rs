//! DM1 and DM2: lamps, then codes (SAE J1939-73, 5.7.1 and 5.7.2).

use super::transport::MESSAGE_MAX;
use crate::diagnostics::fault_memory::Entry;
use crate::diagnostics::trouble_code::Lamp;

/// A message under way to a frame or to the transport.
#[derive(Clone, Debug)]
pub(crate) struct TroubleMessage {
    bytes: [u8; MESSAGE_MAX],
    length: usize,
}

/// Bits of the lamp byte, two a lamp; 01 is on. The lamps of emissions stay off.
const RED_STOP_ON: u8 = 1 << 4;
const AMBER_WARNING_ON: u8 = 1 << 2;
/// No lamp flashes: "do not" is 11.
const NO_FLASH: u8 = 0xFF;

impl TroubleMessage {
    /// The codes of `listed`, under the lamps that `active` codes light.
    pub(crate) fn new(
        active: impl Iterator<Item = Entry>,
        listed: impl Iterator<Item = Entry>,
    ) -> Self {
        let lamps = active.fold(0, |lamps, entry| {
            lamps
                | match entry.lamp {
                    Lamp::Stop => RED_STOP_ON,
                    Lamp::Warning => AMBER_WARNING_ON,
                }
        });
        let mut message = Self { bytes: [0; MESSAGE_MAX], length: 2 };
        message.bytes[..2].copy_from_slice(&[lamps, NO_FLASH]);
        for entry in listed {
            let [low, middle, high] = entry.code.bytes();
            // Bit 7 clear: conversion method of version 4, the only one in use today.
            let room = message.bytes.get_mut(message.length..message.length + 4);
            if let Some(room) = room {
                room.copy_from_slice(&[low, middle, high, entry.occurrences & 0x7F]);
                message.length += 4;
            }
        }
        message
    }

    /// The bytes: a frame's eight, or more for the transport. Without codes, a code of zeros.
    pub(crate) fn bytes(&mut self) -> &[u8] {
        if self.length <= 6 {
            self.bytes[6..8].fill(0xFF);
            self.length = 8;
        }
        &self.bytes[..self.length]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnostics::fault_memory::FaultMemory;
    use crate::diagnostics::parts;
    use crate::diagnostics::trouble_code::Fmi;

    fn message(memory: &FaultMemory) -> TroubleMessage {
        let active = || memory.entries().filter(Entry::is_active);
        TroubleMessage::new(active(), active())
    }

    #[test]
    fn none_one_and_two_codes() {
        let mut memory = FaultMemory::new(parts::ARM);
        assert_eq!(message(&memory).bytes(), [0, 0xFF, 0, 0, 0, 0, 0xFF, 0xFF]);
        memory.report(parts::arm::IMU, Some(Fmi::UpdateRate));
        // 520220 is 7F01C.
        let imu = [0x1C, 0xF0, 0xE9, 1];
        assert_eq!(message(&memory).bytes(), [[4, 0xFF].as_slice(), &imu, &[0xFF, 0xFF]].concat());
        memory.report(parts::arm::STROKE, Some(Fmi::Open));
        let stroke = [0x00, 0xF0, 0xE5, 1];
        assert_eq!(message(&memory).bytes(), [[0x14, 0xFF].as_slice(), &stroke, &imu].concat());
    }
}
