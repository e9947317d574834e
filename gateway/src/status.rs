//! What a gateway says of itself.

use xt28_machine::SimTime;
use xt28_safety::{Phase, Reason};

use crate::epoch::Quality;
use crate::peer::PeerState;
use crate::{Located, Outcome};

/// A gateway at one instant.
#[derive(Clone, Debug, PartialEq)]
pub struct Status {
    /// Where the safety kernel is in its life.
    pub phase: Phase,
    /// Why nothing leaves just now.
    pub blocked: Option<Reason>,
    /// The first hazard that stopped an armed or arming kernel, and when.
    pub first_hazard: Option<(SimTime, Reason)>,
    /// How the policy's task stands.
    pub outcome: Outcome,
    /// When the kernel was armed last.
    pub armed_at: Option<SimTime>,
    /// The last usable fix.
    pub located: Option<Located>,
    /// How good the last fix was.
    pub quality: Option<Quality>,
    /// The arm ECU.
    pub arm_ecu: PeerState,
    /// The drive ECU.
    pub drive_ecu: PeerState,
    /// What was counted so far.
    pub counts: Tally,
}

/// Counts since the start.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// Ticks in which a command left as the policy wanted it.
    pub allowed: u64,
    /// Ticks in which it left held to the limits.
    pub clamped: u64,
    /// Fixes used.
    pub fixes: u64,
    /// Epochs without a fix, or whose fix is not good enough to drive by.
    pub fixes_refused: u64,
    /// Epochs whose fix is good enough, but whose heading the receiver does not vouch for.
    pub fixes_without_heading: u64,
    /// Epochs that a newer one of the same tick replaced.
    pub fixes_overtaken: u64,
    /// Epochs that were never complete.
    pub fixes_incomplete: u64,
    /// Faults in the receiver's stream: checksum, length, version.
    pub gnss_faults: u64,
    /// Frames that did not decode, or repeated their counter.
    pub frames_refused: u64,
    /// Values that had no form on the wire, so that their frame was left out.
    pub frames_unsent: u64,
}
