//! Identifiers of SAE J1939-21: priority, parameter group, addresses.

use xt28_dbc::CanId;

/// Every node.
pub(crate) const GLOBAL: u8 = 0xFF;
/// A node without an address.
pub(crate) const NULL: u8 = 0xFE;

/// Parameter groups in use here.
pub(crate) mod pgn {
    pub(crate) const ACKNOWLEDGEMENT: u32 = 0xE800;
    pub(crate) const REQUEST: u32 = 0xEA00;
    pub(crate) const TRANSPORT_DATA: u32 = 0xEB00;
    pub(crate) const TRANSPORT_CONTROL: u32 = 0xEC00;
    pub(crate) const ADDRESS_CLAIMED: u32 = 0xEE00;
    pub(crate) const DM1: u32 = 0xFECA;
    pub(crate) const DM2: u32 = 0xFECB;
    pub(crate) const DM3: u32 = 0xFECC;
    pub(crate) const DM11: u32 = 0xFED3;
    /// UDS, physical and functional (ISO 15765-2, normal fixed addressing).
    pub(crate) const UDS_PHYSICAL: u32 = 0xDA00;
    pub(crate) const UDS_FUNCTIONAL: u32 = 0xDB00;
}

/// A 29-bit identifier taken apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Id {
    /// 0 to 7, 0 wins.
    pub(crate) priority: u8,
    /// The group; without its low byte where that is an address.
    pub(crate) pgn: u32,
    /// Whom it is for.
    pub(crate) to: u8,
    /// Whom it is from.
    pub(crate) from: u8,
}

/// Below this the PDU's second byte is an address (PDU1).
const PDU2: u32 = 0xF000;

impl Id {
    /// Of a frame; `None` for 11 bits.
    pub(crate) fn of(id: CanId) -> Option<Self> {
        let CanId::Extended(raw) = id else { return None };
        let [from, specific, format, head] = raw.to_le_bytes();
        let group = u32::from(head & 3) << 16 | u32::from(format) << 8;
        let broadcast = group & 0xFF00 >= PDU2;
        Some(Self {
            priority: head >> 2 & 7,
            pgn: if broadcast { group | u32::from(specific) } else { group },
            to: if broadcast { GLOBAL } else { specific },
            from,
        })
    }

    /// The identifier.
    pub(crate) fn can(self) -> CanId {
        let specific = if self.pgn & 0xFF00 >= PDU2 { 0 } else { u32::from(self.to) << 8 };
        CanId::Extended(
            u32::from(self.priority) << 26 | self.pgn << 8 | specific | u32::from(self.from),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_formats_go_both_ways() {
        let dm1 = Id { priority: 6, pgn: pgn::DM1, to: GLOBAL, from: 0x28 };
        assert_eq!(dm1.can(), CanId::Extended(0x18FE_CA28));
        let request = Id { priority: 6, pgn: pgn::REQUEST, to: 0x29, from: 0xF9 };
        assert_eq!(request.can(), CanId::Extended(0x18EA_29F9));
        for id in [dm1, request] {
            assert_eq!(Id::of(id.can()), Some(id));
        }
        assert_eq!(Id::of(CanId::Standard(0x123)), None);
    }
}
