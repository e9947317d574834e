//! What residual generators compare, and the floor of each: what separates two models of one machine.

use core::fmt;

use xt28_machine::Wheel;

/// What is compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[allow(missing_docs)]
pub enum Signal {
    Stroke,
    ArmOpening,
    JointAngle,
    JointFast,
    JointRelief,
    SteerOpening,
    DrivePressure,
    DriveDifference,
    DriveForce,
    Roll,
    Pitch,
    Weight,
    WeightX,
    WeightY,
    Contact(Wheel),
    RollSway,
    PitchSway,
    WheelSpeed(Wheel),
    TravelSpeed,
    TravelCourse,
    YawRate,
    BusMissing,
    BusPlace,
    BusUneven,
}

/// What separates two models of one clean machine.
#[derive(Clone, Copy, Debug)]
pub struct Floor {
    /// Standard deviation, SI.
    pub sigma: f64,
    /// Time after which it is drawn anew, s.
    pub correlation_s: f64,
}

impl Signal {
    /// How far two independent models of the nominal machine lie apart (measured on the logs of a
    /// second plant without effects; see docs/diagnosis.md).
    #[must_use]
    pub const fn floor(self) -> Floor {
        let (sigma, correlation_s) = match self {
            Self::Stroke => (0.2e-3, 0.8),
            Self::ArmOpening => (1.0e-3, 0.5),
            Self::JointAngle => (0.006, 2.0),
            Self::JointFast => (2.2e-3, 0.3),
            Self::JointRelief => (0.012, 2.0),
            Self::SteerOpening => (0.0025, 0.3),
            Self::DrivePressure => (3.5e5, 0.3),
            Self::DriveDifference => (0.7e5, 0.3),
            Self::DriveForce => (100.0, 2.5),
            Self::Roll => (0.0007, 5.0),
            Self::Pitch => (0.0006, 5.0),
            Self::Weight => (450.0, 5.0),
            Self::WeightX => (0.005, 5.0),
            Self::WeightY => (0.004, 5.0),
            Self::Contact(_) => (0.5e-3, 3.0),
            Self::RollSway => (0.0005, 1.5),
            Self::PitchSway => (0.0007, 1.5),
            Self::WheelSpeed(_) => (0.004, 1.0),
            Self::TravelSpeed => (0.012, 1.5),
            Self::TravelCourse => (0.03, 1.5),
            Self::YawRate => (0.003, 1.5),
            Self::BusMissing => (0.01, 1.0),
            Self::BusPlace => (0.03, 1.0),
            // A millisecond of scheduling, or one frame in a hundred.
            Self::BusUneven => (0.1, 1.0),
        };
        Floor { sigma, correlation_s }
    }

    /// Weight of one squared residual sample: correlated samples count once.
    #[must_use]
    pub fn weight(self) -> f64 {
        let floor = self.floor();
        1.0 / (floor.correlation_s * 10.0).max(1.0)
    }
}

impl Signal {
    /// Its name, with its wheel where it is one of six and its generator is not.
    #[must_use]
    pub fn with_wheel(self) -> String {
        match self {
            Self::Contact(wheel) | Self::WheelSpeed(wheel) => format!("{self}, {wheel}"),
            _ => self.to_string(),
        }
    }
}

impl fmt::Display for Signal {
    /// The signal's name in verdicts.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Stroke => "stroke",
            Self::ArmOpening => "arm opening",
            Self::JointAngle => "joint angle",
            Self::JointFast => "joint angle, within a second",
            Self::JointRelief => "rate that the joint does not follow",
            Self::SteerOpening => "steering opening",
            Self::DrivePressure => "pump pressure",
            Self::DriveDifference => "difference of the circuits' pressures",
            Self::DriveForce => "force that drives",
            Self::Roll => "roll",
            Self::Pitch => "pitch",
            Self::Weight => "weight",
            Self::WeightX => "place of the weight, forward",
            Self::WeightY => "place of the weight, left",
            Self::Contact(_) => "touch of the ground",
            Self::RollSway => "roll, within seconds",
            Self::PitchSway => "pitch, within seconds",
            Self::WheelSpeed(_) => "wheel speed",
            Self::TravelSpeed => "speed over ground",
            Self::TravelCourse => "course over ground",
            Self::YawRate => "yaw rate",
            Self::BusMissing => "share of commands missing",
            Self::BusPlace => "commands out of their places",
            Self::BusUneven => "intervals between commands",
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_signal_of_six_is_told_with_its_wheel() {
        assert_eq!(Signal::Contact(Wheel::Fl).with_wheel(), "touch of the ground, FL");
        assert_eq!(Signal::WheelSpeed(Wheel::Br).with_wheel(), "wheel speed, BR");
        assert_eq!(Signal::Stroke.with_wheel(), "stroke");
    }
}
