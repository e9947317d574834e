//! Data identifiers: what can be read, and by whom. `docs/diagnostics.md` is held to these tables.

use super::reply::Reply;

/// Sessions in which something is to be had.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Access {
    /// Every session.
    Any,
    /// The extended session: signals as they stand on the pins.
    Extended,
}

/// One thing that can be read (service 22).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Identifier {
    /// Its number.
    pub did: u16,
    /// What it is.
    pub name: &'static str,
    /// How it is written, high byte first.
    pub layout: &'static str,
    /// Who may read it.
    pub access: Access,
}

const fn any(did: u16, name: &'static str, layout: &'static str) -> Identifier {
    Identifier { did, name, layout, access: Access::Any }
}

const fn extended(did: u16, name: &'static str, layout: &'static str) -> Identifier {
    Identifier { did, name, layout, access: Access::Extended }
}

/// What both ECUs say of themselves.
pub const COMMON: &[Identifier] = &[
    any(0x0100, "state", "u8: 0 init, 1 standby, 2 active, 3 safe stop, 4 fault"),
    any(0x0101, "supply voltage", "u16, 1 mV"),
    any(0xF186, "active session", "u8: 1 default, 3 extended"),
    any(0xF189, "software version", "text"),
    any(0xF18C, "serial number of the ECU", "text"),
    any(0xF190, "serial number of the machine", "text, 17 characters"),
    any(0xF197, "name of the ECU", "text"),
];

/// What the pendulum-arm ECU says besides. Wheels in the order FR FL MR ML BR BL.
pub const ARM: &[Identifier] = &[
    any(0x0110, "strokes", "6 x u16, 1 mm"),
    any(0x0111, "pressures A", "6 x u16, 1 kPa"),
    any(0x0112, "pressures B", "6 x u16, 1 kPa"),
    any(0x0113, "cylinder loads", "6 x s16, 1 daN"),
    any(0x0114, "pitch, roll", "2 x s16, 0.01 deg"),
    any(0x0115, "solenoid currents A", "6 x u16, 1 mA"),
    any(0x0116, "solenoid currents B", "6 x u16, 1 mA"),
    extended(0x0210, "inputs of the strokes", "6 x u16, 1 mV"),
    extended(0x0211, "inputs of the pressures A", "6 x u16, 1 mV"),
    extended(0x0212, "inputs of the pressures B", "6 x u16, 1 mV"),
];

/// What the transmission and steering ECU says besides.
pub const DRIVE: &[Identifier] = &[
    any(0x0120, "joint angles", "2 x s16, 0.01 deg: front, rear"),
    any(0x0121, "wheel speeds", "6 x s16, 0.1 rpm"),
    any(0x0122, "pump pressures", "4 x u16, 0.01 bar: 1A 1B 2A 2B"),
    any(0x0123, "engine speed", "u16, 0.125 rpm"),
    any(0x0124, "pump currents", "4 x u16, 1 mA: 1A 1B 2A 2B"),
    any(0x0125, "motor currents", "6 x u16, 1 mA"),
    extended(0x0220, "inputs of the joints", "2 x u16, 1 mV: front, rear"),
    extended(0x0221, "inputs of the pump pressures", "4 x u16, 1 mV: 1A 1B 2A 2B"),
    extended(0x0222, "inputs of the wheel speeds", "6 x u16, 1 Hz"),
];

/// What an ECU can be asked for.
pub(crate) trait Readings {
    /// What of it there is, besides [`COMMON`].
    const IDENTIFIERS: &'static [Identifier];

    /// State as the status frames number it.
    fn state(&self) -> u8;

    /// Supply, mV.
    fn supply_mv(&self) -> f64;

    /// Writes what `did`, one of the table's, stands for.
    fn write(&self, did: u16, reply: &mut Reply);
}

/// Who an ECU is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Identity {
    pub(crate) name: &'static str,
    pub(crate) serial: &'static str,
}

/// The machine's serial number, in the form of a vehicle identification number.
const MACHINE_SERIAL: &str = "XT28BENCH00000001";

/// Writes `did` into `reply`; false if there is none for a session that is `extended` or not.
pub(crate) fn read<R: Readings>(
    did: u16,
    session: u8,
    extended: bool,
    identity: &Identity,
    readings: &R,
    reply: &mut Reply,
) -> bool {
    let found = COMMON.iter().chain(R::IDENTIFIERS).find(|known| known.did == did);
    if !found.is_some_and(|known| extended || known.access == Access::Any) {
        return false;
    }
    reply.push(&did.to_be_bytes());
    match did {
        0x0100 => reply.push(&[readings.state()]),
        0x0101 => reply.unsigned(&[readings.supply_mv()]),
        0xF186 => reply.push(&[session]),
        0xF189 => reply.push(env!("CARGO_PKG_VERSION").as_bytes()),
        0xF18C => reply.push(identity.serial.as_bytes()),
        0xF190 => reply.push(MACHINE_SERIAL.as_bytes()),
        0xF197 => reply.push(identity.name.as_bytes()),
        _ => readings.write(did, reply),
    }
    true
}
