//! Trouble codes: which part (SPN) fails in which way (FMI), as SAE J1939-73 writes them.

/// How a part fails: the failure mode identifiers in use here (J1939-73, appendix A).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u8)]
pub enum Fmi {
    /// Valid, but below all that is normal: the most severe kind.
    FarBelow = 1,
    /// Erratic, intermittent or incorrect.
    Erratic = 2,
    /// Voltage above normal, or short to high.
    High = 3,
    /// Voltage below normal, or short to low.
    Low = 4,
    /// Open circuit.
    Open = 5,
    /// The mechanics do not answer.
    NotResponding = 7,
    /// Abnormal frequency or pulse width.
    Frequency = 8,
    /// Abnormal update rate: it stays away.
    UpdateRate = 9,
    /// It changes faster than the part can.
    ChangeRate = 10,
}

impl Fmi {
    /// The number on the wire, 0 to 31.
    #[must_use]
    pub const fn number(self) -> u8 {
        self as u8
    }

    /// What it means, for people.
    #[must_use]
    pub const fn meaning(self) -> &'static str {
        match self {
            Self::FarBelow => "far below normal",
            Self::Erratic => "erratic",
            Self::High => "short to battery",
            Self::Low => "short to ground",
            Self::Open => "open circuit",
            Self::NotResponding => "mechanics do not answer",
            Self::Frequency => "abnormal frequency",
            Self::UpdateRate => "stays away",
            Self::ChangeRate => "changes too fast",
        }
    }
}

/// A suspect parameter number and a failure mode: one trouble code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TroubleCode {
    /// Which part, 19 bits.
    pub spn: u32,
    /// In which way.
    pub fmi: Fmi,
}

impl TroubleCode {
    /// The three bytes that DM1 and UDS (format `SAE_J1939-73`) share: SPN low, SPN middle, and the
    /// SPN's upper three bits above the FMI.
    #[must_use]
    pub const fn bytes(self) -> [u8; 3] {
        let [low, middle, high, _] = self.spn.to_le_bytes();
        [low, middle, high << 5 | self.fmi.number()]
    }
}

/// The lamp that a code lights.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lamp {
    /// Amber: the machine works on, with less.
    Warning,
    /// Red: the ECU stops what it controls.
    Stop,
}

/// One way in which a part can fail.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FailureMode {
    /// Which.
    pub fmi: Fmi,
    /// What it lights.
    pub lamp: Lamp,
}

/// A part that an ECU watches.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Part {
    /// Suspect parameter number.
    pub spn: u32,
    /// What it is.
    pub name: &'static str,
    /// The ways it can fail.
    pub modes: &'static [FailureMode],
}

#[cfg(test)]
mod tests {
    use super::*;

    /// J1939-73, 5.7.1.7 works SPN 1208, FMI 3 out to B8 04 03.
    #[test]
    fn a_code_is_written_as_the_standard_shows() {
        assert_eq!(TroubleCode { spn: 1208, fmi: Fmi::High }.bytes(), [0xB8, 0x04, 0x03]);
        assert_eq!(TroubleCode { spn: 0x7_FFFF, fmi: Fmi::Open }.bytes(), [0xFF, 0xFF, 0xE5]);
    }
}
