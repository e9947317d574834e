//! What the kernel answers.

use core::fmt;

use crate::{Command, WHEELS};

/// The answer to one request.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Verdict {
    /// The request as it was.
    Allow(Command),
    /// The request, held to the limits.
    Clamp(Command, Clamps),
    /// Nothing may leave.
    Block(Reason),
}

impl Verdict {
    /// What may be sent, if anything.
    #[must_use]
    pub const fn command(&self) -> Option<Command> {
        match self {
            Self::Allow(command) | Self::Clamp(command, _) => Some(*command),
            Self::Block(_) => None,
        }
    }
}

/// Which parts of a request were changed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Clamps {
    /// The throttle.
    pub throttle: bool,
    /// The front joint's target.
    pub steering: bool,
    /// Each arm's target stroke or opening.
    pub arms: [bool; WHEELS],
    /// The parking brake, which waits for the machine to stand.
    pub brake: bool,
}

impl Clamps {
    /// True when anything was changed.
    #[must_use]
    pub fn any(&self) -> bool {
        self.throttle || self.steering || self.brake || self.arms.contains(&true)
    }
}

/// A stream with a deadline.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stream {
    /// Status of the arm ECU.
    ArmStatus,
    /// Status of the drive ECU.
    DriveStatus,
    /// Strokes, attitude or joints.
    Sensors,
    /// The observation the policy acts on.
    Observation,
    /// The policy's answers.
    Policy,
}

/// Why nothing may leave.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reason {
    /// Nobody has armed the kernel.
    Disarmed,
    /// The handshake is going on.
    Handshake,
    /// The ECUs did not acknowledge in time.
    HandshakeTimeout,
    /// An emergency stop is latched.
    EmergencyStop,
    /// The bus is off or gone.
    BusFault,
    /// Somebody else commands the ECUs.
    NotAlone,
    /// A stream missed its deadline.
    Stale(Stream),
    /// A number in the request is NaN or infinite.
    RequestNotFinite,
    /// A measured number is NaN or infinite, as it is where an ECU calls its sensor broken.
    MeasurementNotFinite,
    /// A stroke or a joint is measured where it cannot be.
    MeasurementImplausible,
    /// A stroke or the front joint is read here and there, so that no target can start from it.
    MeasurementLeaps,
    /// Too much roll.
    Roll,
    /// Too much pitch.
    Pitch,
    /// The arm ECU left standby or active.
    ArmEcuNotReady,
    /// The drive ECU left standby or active.
    DriveEcuNotReady,
    /// An ECU stopped accepting our frames.
    NotAcknowledged,
    /// Time ran backwards.
    ClockBackwards,
    /// The limits themselves are not sound.
    LimitsUnsound,
}

impl fmt::Display for Reason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Disarmed => "disarmed",
            Self::Handshake => "handshake going on",
            Self::HandshakeTimeout => "the ECUs did not acknowledge in time",
            Self::EmergencyStop => "emergency stop",
            Self::BusFault => "bus fault",
            Self::NotAlone => "another node on the bus commands the ECUs",
            Self::Stale(Stream::ArmStatus) => "arm ECU status lost",
            Self::Stale(Stream::DriveStatus) => "drive ECU status lost",
            Self::Stale(Stream::Sensors) => "sensor frames lost",
            Self::Stale(Stream::Observation) => "observation too old",
            Self::Stale(Stream::Policy) => "policy silent",
            Self::RequestNotFinite => "policy asked for a number that is not finite",
            Self::MeasurementNotFinite => "a measured value is not known, or its sensor broken",
            Self::MeasurementImplausible => "a stroke or joint is measured where it cannot be",
            Self::MeasurementLeaps => "the reading of a stroke or of the front joint leaps about",
            Self::Roll => "roll above its limit",
            Self::Pitch => "pitch above its limit",
            Self::ArmEcuNotReady => "arm ECU in safe stop or fault",
            Self::DriveEcuNotReady => "drive ECU in safe stop or fault",
            Self::NotAcknowledged => "an ECU stopped accepting our frames",
            Self::ClockBackwards => "time ran backwards",
            Self::LimitsUnsound => "the limits are not sound",
        })
    }
}
