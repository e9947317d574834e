//! Trouble codes read (service 19) and cleared (service 14).

use super::{Refused, Reply};
use crate::diagnostics::fault_memory::{Entry, FaultMemory, status};

const COUNT_BY_STATUS: u8 = 0x01;
const BY_STATUS: u8 = 0x02;
const SUPPORTED: u8 = 0x0A;
/// Codes are SPN and FMI (ISO 14229-1, `SAE_J1939-73_DTCFormat`).
const FORMAT: u8 = 0x02;
/// The group of all codes.
const ALL: [u8; 3] = [0xFF; 3];

/// Service 19 with sub-function `sub`; `rest` is behind it.
pub(super) fn read(
    sub: u8,
    rest: &[u8],
    memory: &FaultMemory,
    reply: &mut Reply,
) -> Result<(), Refused> {
    let mask = match (sub, rest) {
        (COUNT_BY_STATUS | BY_STATUS, &[mask]) => Some(mask),
        (SUPPORTED, []) => None,
        (COUNT_BY_STATUS | BY_STATUS | SUPPORTED, _) => return Err(Refused::Length),
        _ => return Err(Refused::SubFunction),
    };
    reply.push(&[status::AVAILABLE]);
    let wanted = |entry: &Entry| mask.is_none_or(|mask| entry.status & mask != 0);
    let entries = memory.entries().filter(wanted);
    if sub == COUNT_BY_STATUS {
        #[allow(clippy::cast_possible_truncation)] // at most 96
        let [high, low] = (entries.count() as u16).to_be_bytes();
        reply.push(&[FORMAT, high, low]);
        return Ok(());
    }
    for entry in entries {
        reply.push(&entry.code.bytes());
        reply.push(&[entry.status]);
    }
    Ok(())
}

/// Service 14: all codes, or one.
pub(super) fn clear(rest: &[u8], memory: &mut FaultMemory) -> Result<(), Refused> {
    let group: [u8; 3] = rest.try_into().map_err(|_| Refused::Length)?;
    let meant = |entry: &Entry| group == ALL || entry.code.bytes() == group;
    if !memory.entries().any(|entry| meant(&entry)) {
        return Err(Refused::OutOfRange);
    }
    memory.clear(meant);
    Ok(())
}
