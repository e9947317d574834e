//! One ECU as the gateway knows it: is it alive, ready, and does it accept what we send?

use xt28_dbc::DecodeError;
use xt28_dbc::e2e::{Alive, AliveCheck};
use xt28_dbc::messages::{ArmStatus, ArmStatusState, DriveStatus, DriveStatusState};
use xt28_machine::SimTime;
use xt28_safety::Link;

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

/// One ECU.
#[derive(Clone, Debug, Default)]
pub(crate) struct Peer {
    alive: AliveCheck,
    heard_at: Option<SimTime>,
    state: PeerState,
    accepted: u8,
    refused: u64,
}

impl Peer {
    /// A status frame, decoded or not.
    pub(crate) fn on_status<T: Into<PeerReport>>(
        &mut self,
        now: SimTime,
        status: Result<T, DecodeError>,
    ) {
        let report = match status {
            Ok(status) => status.into(),
            // Damaged on the way; its silence will tell if it goes on.
            Err(_) => return self.refused += 1,
        };
        if matches!(self.alive.check(report.counter), Alive::Repeated) {
            return self.refused += 1;
        }
        self.heard_at = Some(now);
        self.state = report.state;
        self.accepted = report.accepted;
    }

    pub(crate) const fn state(&self) -> PeerState {
        self.state
    }

    /// Status frames that were damaged or repeated.
    pub(crate) const fn refused(&self) -> u64 {
        self.refused
    }

    /// What the kernel may know, with the counter last `sent` to it.
    pub(crate) fn link(&self, sent: Option<u8>) -> Link {
        Link {
            heard_at_ns: self.heard_at.map(SimTime::as_nanos),
            ready: matches!(self.state, PeerState::Standby | PeerState::Active),
            sent,
            accepted: self.accepted,
        }
    }
}

/// What either status frame says.
pub(crate) struct PeerReport {
    state: PeerState,
    accepted: u8,
    counter: u8,
}

impl From<ArmStatus> for PeerReport {
    fn from(status: ArmStatus) -> Self {
        let state = match status.state {
            ArmStatusState::Init => PeerState::Init,
            ArmStatusState::Standby => PeerState::Standby,
            ArmStatusState::Active => PeerState::Active,
            ArmStatusState::SafeStop => PeerState::SafeStop,
            ArmStatusState::Fault => PeerState::Fault,
        };
        Self { state, accepted: status.accepted, counter: status.counter }
    }
}

impl From<DriveStatus> for PeerReport {
    fn from(status: DriveStatus) -> Self {
        let state = match status.state {
            DriveStatusState::Init => PeerState::Init,
            DriveStatusState::Standby => PeerState::Standby,
            DriveStatusState::Active => PeerState::Active,
            DriveStatusState::SafeStop => PeerState::SafeStop,
            DriveStatusState::Fault => PeerState::Fault,
        };
        Self { state, accepted: status.accepted, counter: status.counter }
    }
}

#[cfg(test)]
mod tests {
    use xt28_dbc::messages::{ArmStatusMode, ArmStatusReason};

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
