//! One ECU as the gateway knows it: is it alive, ready, and does it accept what we send?

use core::fmt;

use xt28_dbc::DecodeError;
use xt28_dbc::e2e::{Alive, AliveCheck};
use xt28_dbc::messages::{
    ArmStatus, ArmStatusReason, ArmStatusState, DriveStatus, DriveStatusReason, DriveStatusState,
};
use xt28_machine::SimTime;
use xt28_safety::Link;

/// What the fault bits of either ECU mean, from bit 0 on (comments of the DBC).
const ARM_FAULTS: &[&str] = &["position sensor", "pressure sensor", "attitude sensor", "supply"];
const DRIVE_FAULTS: &[&str] =
    &["joint sensor", "wheel speed sensor", "pump pressure sensor", "supply", "engine"];

/// Bits of the arm ECU's sensors, whose readings the gateway goes by.
pub(crate) const POSITION_SENSOR: u32 = 0;
pub(crate) const PRESSURE_SENSOR: u32 = 1;
pub(crate) const ATTITUDE_SENSOR: u32 = 2;
/// That of the drive ECU's joint sensors.
pub(crate) const JOINT_SENSOR: u32 = 0;
/// That of its six wheel speed sensors, of one or more of them.
pub(crate) const WHEEL_SPEED_SENSOR: u32 = 1;

/// What an ECU says of itself.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PeerState {
    /// Nothing heard yet.
    #[default]
    Unknown,
    /// Starting.
    Init,
    /// Waits for commands.
    Standby,
    /// Carries out commands.
    Active,
    /// Stopped by itself, for instance since commands stayed away.
    SafeStop,
    /// Something is broken.
    Fault,
}

/// What an ECU said of itself last.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct EcuReport {
    /// Where it is in its life.
    pub state: PeerState,
    /// Why it refused the last command that it refused, in the words of the DBC; nothing where it refused none.
    pub refusal: Option<&'static str>,
    faults: u16,
    fault_names: &'static [&'static str],
}

impl EcuReport {
    /// What it found broken.
    pub fn faults(&self) -> impl Iterator<Item = String> {
        let (bits, names) = (self.faults, self.fault_names);
        (0..u16::BITS as usize).filter(move |bit| bits >> bit & 1 == 1).map(|bit| {
            names.get(bit).map_or_else(|| format!("fault bit {bit}"), |name| (*name).to_owned())
        })
    }
}

/// One ECU.
#[derive(Clone, Debug, Default)]
pub(crate) struct Peer {
    alive: AliveCheck,
    heard_at: Option<SimTime>,
    report: EcuReport,
    accepted: u8,
    /// Of the drive ECU: the parking brake is on.
    is_braked: bool,
    refused: u64,
}

impl Peer {
    /// A status frame, decoded or not.
    pub(crate) fn on_status<T: Into<PeerStatus>>(
        &mut self,
        now: SimTime,
        status: Result<T, DecodeError>,
    ) {
        let status = match status {
            Ok(status) => status.into(),
            // Damaged on the way; its silence will tell if it goes on.
            Err(_) => return self.refused += 1,
        };
        if matches!(self.alive.check(status.counter), Alive::Repeated) {
            return self.refused += 1;
        }
        self.heard_at = Some(now);
        self.report = status.report;
        self.accepted = status.accepted;
        self.is_braked = status.is_braked;
    }

    /// Whether it said last that the parking brake is on.
    pub(crate) const fn is_braked(&self) -> bool {
        self.is_braked
    }

    /// Whether it said last that what this fault bit is of is broken.
    pub(crate) const fn finds_broken(&self, bit: u32) -> bool {
        self.report.faults >> bit & 1 == 1
    }

    /// What it said last.
    pub(crate) const fn report(&self) -> EcuReport {
        self.report
    }

    /// Status frames that were damaged or repeated.
    pub(crate) const fn refused(&self) -> u64 {
        self.refused
    }

    /// What the kernel may know, with the counter last `sent` to it.
    pub(crate) fn link(&self, sent: Option<u8>) -> Link {
        Link {
            heard_at_ns: self.heard_at.map(SimTime::as_nanos),
            ready: matches!(self.report.state, PeerState::Standby | PeerState::Active),
            sent,
            accepted: self.accepted,
        }
    }
}

/// What either status frame says.
pub(crate) struct PeerStatus {
    report: EcuReport,
    accepted: u8,
    is_braked: bool,
    counter: u8,
}

impl From<ArmStatus> for PeerStatus {
    fn from(status: ArmStatus) -> Self {
        let state = match status.state {
            ArmStatusState::Init => PeerState::Init,
            ArmStatusState::Standby => PeerState::Standby,
            ArmStatusState::Active => PeerState::Active,
            ArmStatusState::SafeStop => PeerState::SafeStop,
            ArmStatusState::Fault => PeerState::Fault,
        };
        let (reason, none) = (status.reason, ArmStatusReason::None);
        let refusal = (reason != none).then(|| reason.name());
        let (faults, fault_names) = (status.faults, ARM_FAULTS);
        let report = EcuReport { state, refusal, faults, fault_names };
        Self { report, accepted: status.accepted, is_braked: false, counter: status.counter }
    }
}

impl From<DriveStatus> for PeerStatus {
    fn from(status: DriveStatus) -> Self {
        let state = match status.state {
            DriveStatusState::Init => PeerState::Init,
            DriveStatusState::Standby => PeerState::Standby,
            DriveStatusState::Active => PeerState::Active,
            DriveStatusState::SafeStop => PeerState::SafeStop,
            DriveStatusState::Fault => PeerState::Fault,
        };
        let (reason, none) = (status.reason, DriveStatusReason::None);
        let refusal = (reason != none).then(|| reason.name());
        let (faults, fault_names) = (status.faults, DRIVE_FAULTS);
        let report = EcuReport { state, refusal, faults, fault_names };
        let (accepted, is_braked) = (status.accepted, status.brake);
        Self { report, accepted, is_braked, counter: status.counter }
    }
}

impl PeerState {
    /// In words.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Unknown => "not heard",
            Self::Init => "init",
            Self::Standby => "standby",
            Self::Active => "active",
            Self::SafeStop => "safe stop",
            Self::Fault => "fault",
        }
    }
}

impl fmt::Display for EcuReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.state.name())?;
        let faults: Vec<String> = self.faults().collect();
        if !faults.is_empty() {
            write!(f, " ({})", faults.join(", "))?;
        }
        self.refusal.map_or(Ok(()), |reason| write!(f, ", refused a command last for: {reason}"))
    }
}

#[cfg(test)]
mod tests {
    use xt28_dbc::messages::ArmStatusMode;

    use super::*;

    #[test]
    fn an_ecu_is_ready_in_standby_and_active_alone() {
        let ready = ArmStatusState::ALL.map(|state| {
            let mut peer = Peer::default();
            assert!(!peer.link(None).ready, "nothing heard");
            let status = ArmStatus { state, ..status() };
            peer.on_status(SimTime::ZERO, Ok(status));
            (state, peer.link(None).ready)
        });
        for (state, ready) in ready {
            let wanted = matches!(state, ArmStatusState::Standby | ArmStatusState::Active);
            assert_eq!(ready, wanted, "{state:?}");
        }
    }

    #[test]
    fn an_ecu_says_what_is_broken_and_why_it_refuses() {
        let said = |faults: u16, reason| {
            let mut peer = Peer::default();
            let state = ArmStatusState::Fault;
            peer.on_status(SimTime::ZERO, Ok(ArmStatus { state, faults, reason, ..status() }));
            peer.report().to_string()
        };
        assert_eq!(said(0, ArmStatusReason::None), "fault");
        assert_eq!(
            said(0b1_0000_0011, ArmStatusReason::None),
            "fault (position sensor, pressure sensor, fault bit 8)"
        );
        assert_eq!(said(0, ArmStatusReason::Crc), "fault, refused a command last for: crc");
    }

    #[test]
    fn fault_bits_are_called_as_the_database_says() {
        let dbc = include_str!("../../dbc/xt28.dbc");
        for names in [ARM_FAULTS, DRIVE_FAULTS] {
            let told = names.iter().enumerate().map(|(bit, name)| format!("{bit} {name}"));
            let told = format!("Fault bits: {}.", told.collect::<Vec<_>>().join(", "));
            assert!(dbc.contains(&told), "{told}");
        }
    }

    fn status() -> ArmStatus {
        ArmStatus {
            mode: ArmStatusMode::Off,
            state: ArmStatusState::Init,
            faults: 0,
            accepted: 0,
            reason: ArmStatusReason::None,
            supply_v: 24.0,
            counter: 0,
        }
    }
}
