//! What the kernel remembers from step to step.

use crate::steady::Steadiness;
use crate::{Command, Reason};

/// Where in its life the kernel is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Phase {
    /// Silent; waits for an order.
    #[default]
    Disarmed,
    /// Neutral frames go out; both ECUs must accept them in step.
    Handshake {
        /// When it began, ns.
        since_ns: u64,
        /// Steps in a row that both ECUs acknowledged.
        acknowledged: u32,
    },
    /// Requests pass, within limits.
    Armed,
    /// A hazard stopped it; only a new order arms again.
    Blocked(Reason),
}

/// The kernel's whole memory.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State {
    pub(crate) phase: Phase,
    /// The last command let through; what rates are relative to.
    pub(crate) last: Command,
    pub(crate) last_ns: u64,
    /// Since when the brake has been asked for, ns; `None` while it is not.
    pub(crate) braking_since_ns: Option<u64>,
    /// When both ECUs last were in step, ns.
    pub(crate) acknowledged_ns: u64,
    /// When measured strokes and joint were last where they can be, ns.
    pub(crate) plausible_ns: u64,
    /// Which strokes and whether the joint can be started from.
    pub(crate) steadiness: Steadiness,
}

impl State {
    /// Disarmed, before the first step.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            phase: Phase::Disarmed,
            last: Command::rest(0.0),
            last_ns: 0,
            braking_since_ns: None,
            acknowledged_ns: 0,
            plausible_ns: 0,
            steadiness: Steadiness::UNKNOWN,
        }
    }

    /// Where in its life it is.
    #[must_use]
    pub const fn phase(&self) -> Phase {
        self.phase
    }

    /// True while requests may pass.
    #[must_use]
    pub const fn is_armed(&self) -> bool {
        matches!(self.phase, Phase::Armed)
    }

    pub(crate) const fn emergency(&self) -> bool {
        matches!(self.phase, Phase::Blocked(Reason::EmergencyStop))
    }

    pub(crate) const fn go(self, phase: Phase) -> Self {
        Self { phase, ..self }
    }
}

impl Default for State {
    fn default() -> Self {
        Self::new()
    }
}
