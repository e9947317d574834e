//! The NAME: who a node is, and how it ranks when two want one address (SAE J1939-81, 4.1).

/// A node's NAME by its fields.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Name {
    /// Takes another address when it loses its own; ours do not.
    pub arbitrary_address: bool,
    /// Industry, 3 bits.
    pub industry: u8,
    /// Which of several machines in a train, 4 bits.
    pub system_instance: u8,
    /// Kind of machine within the industry, 7 bits.
    pub system: u8,
    /// What the node does.
    pub function: u8,
    /// Which of several that do it, 5 bits.
    pub function_instance: u8,
    /// Which of several ECUs that do it together, 3 bits.
    pub ecu_instance: u8,
    /// Maker, 11 bits.
    pub manufacturer: u16,
    /// The unit, 21 bits.
    pub identity: u32,
}

impl Name {
    /// As 64 bits; the lower number wins an address.
    #[must_use]
    pub const fn bits(&self) -> u64 {
        (self.arbitrary_address as u64) << 63
            | (self.industry as u64 & 0x7) << 60
            | (self.system_instance as u64 & 0xF) << 56
            | (self.system as u64 & 0x7F) << 49
            | (self.function as u64) << 40
            | (self.function_instance as u64 & 0x1F) << 35
            | (self.ecu_instance as u64 & 0x7) << 32
            | (self.manufacturer as u64 & 0x7FF) << 21
            | self.identity as u64 & 0x1F_FFFF
    }
}

/// Agricultural and forestry equipment.
const FORESTRY: u8 = 2;
/// Forwarders, within that (ISO 11783-1 annex).
const FORWARDER: u8 = 20;
/// Not one of SAE's makers: the bench is nobody's product.
const NO_MANUFACTURER: u16 = 0;

const XT28: Name = Name {
    arbitrary_address: false,
    industry: FORESTRY,
    system_instance: 0,
    system: FORWARDER,
    function: 0,
    function_instance: 0,
    ecu_instance: 0,
    manufacturer: NO_MANUFACTURER,
    identity: 0,
};

/// The pendulum-arm ECU; its function is "suspension, drive axle".
pub const ARM: Name = Name { function: 18, identity: 28_001, ..XT28 };
/// The transmission and steering ECU; its function is "transmission".
pub const DRIVE: Name = Name { function: 3, identity: 28_002, ..XT28 };

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_field_has_its_bits() {
        assert_eq!(XT28.bits(), 0x2028_0000_0000_0000);
        assert_eq!(ARM.bits(), 0x2028_1200_0000_6D61);
        let full = Name {
            arbitrary_address: true,
            industry: 7,
            system_instance: 15,
            system: 127,
            function: 255,
            function_instance: 31,
            ecu_instance: 7,
            manufacturer: 0x7FF,
            identity: 0x1F_FFFF,
        };
        assert_eq!(full.bits(), !(1 << 48), "all but the reserved bit");
    }
}
