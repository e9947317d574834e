//! What a gateway says of itself.

use xt28_machine::SimTime;
use xt28_safety::{Phase, Reason, Stream};

use crate::epoch::Quality;
use crate::peer::EcuReport;
use crate::{Located, Outcome};

/// A gateway at one instant.
#[derive(Clone, Debug, PartialEq)]
pub struct Status {
    /// Where the safety kernel is in its life.
    pub phase: Phase,
    /// Why nothing leaves just now.
    pub blocked: Option<Reason>,
    /// Hazards that stopped an armed or arming kernel.
    pub stops: Stops,
    /// How the policy's task stands.
    pub outcome: Outcome,
    /// When the kernel was armed last.
    pub armed_at: Option<SimTime>,
    /// The last usable fix.
    pub located: Option<Located>,
    /// How good the last fix was.
    pub quality: Option<Quality>,
    /// What the arm ECU said of itself last.
    pub arm_ecu: EcuReport,
    /// What the drive ECU said of itself last.
    pub drive_ecu: EcuReport,
    /// What was counted so far.
    pub counts: Tally,
}

impl Status {
    /// `reason` in words, with what the ECUs say of themselves where it is about them.
    #[must_use]
    pub fn told(&self, reason: Reason) -> String {
        let arm = || format!("the arm ECU says {}", self.arm_ecu);
        let drive = || format!("the drive ECU says {}", self.drive_ecu);
        match reason {
            Reason::ArmEcuNotReady => format!("{reason}; {}", arm()),
            Reason::DriveEcuNotReady => format!("{reason}; {}", drive()),
            Reason::NotAcknowledged
            | Reason::HandshakeTimeout
            | Reason::MeasurementNotFinite
            | Reason::MeasurementImplausible
            | Reason::Stale(Stream::Observation) => {
                format!("{reason}; {}; {}", arm(), drive())
            }
            _ => reason.to_string(),
        }
    }
}

/// Hazards that stopped an armed or arming kernel, or one that stood still for another.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Stops {
    /// How many there were.
    pub count: u32,
    /// The first, and when.
    pub first: Option<(SimTime, Reason)>,
    /// The last one.
    pub last: Option<(SimTime, Reason)>,
}

impl Stops {
    pub(crate) fn note(&mut self, at: SimTime, reason: Reason) {
        self.count = self.count.saturating_add(1);
        self.first.get_or_insert((at, reason));
        self.last = Some((at, reason));
    }
}

impl core::fmt::Display for Stops {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        let (Some((at, reason)), Some((last_at, last))) = (self.first, self.last) else {
            return f.write_str("no safety stop");
        };
        write!(f, "safety stop at {at}: {reason}")?;
        if self.count > 1 {
            write!(f, "; {} stops in all, the last at {last_at}: {last}", self.count)?;
        }
        Ok(())
    }
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
    /// Bytes that came from the receiver.
    pub gnss_bytes: u64,
    /// UBX messages in them, of any kind.
    pub gnss_messages: u64,
    /// Faults in the receiver's stream: checksum, length, version.
    pub gnss_faults: u64,
    /// Frames that did not decode, or repeated their counter.
    pub frames_refused: u64,
    /// Values that had no form on the wire, so that their frame was left out.
    pub frames_unsent: u64,
}

#[cfg(test)]
mod tests {
    use xt28_machine::Machine;

    use super::*;
    use crate::policy::Hold;
    use crate::{Gateway, GatewayConfig};

    #[test]
    fn a_reason_that_is_about_an_ecu_comes_with_what_that_says() {
        let machine = Machine::xt28();
        let gateway = Gateway::new(&machine, GatewayConfig::new(&machine), Box::new(Hold));
        let told = |reason| gateway.status().told(reason);
        let drive = "the drive ECU says not heard";
        assert!(told(Reason::DriveEcuNotReady).ends_with(&format!("; {drive}")));
        assert!(told(Reason::NotAcknowledged).ends_with(&format!("says not heard; {drive}")));
        assert_eq!(told(Reason::BusFault), "bus fault");
    }
}
