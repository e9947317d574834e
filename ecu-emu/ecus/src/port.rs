//! The CAN connectors of an ECU.

/// A CAN connector. What hangs on it differs by ECU (facts 2).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Port {
    /// Commands and log, both ECUs.
    Can1,
    /// The inertial unit on the arm ECU, the right armrest on the drive ECU.
    Can2,
    /// The left armrest on the arm ECU, the engine on the drive ECU.
    Can3,
    /// Display, both ECUs.
    Can4,
}
