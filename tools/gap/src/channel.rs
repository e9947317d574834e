//! What a replay reads from a log, each thing with a name, a dimension and the signal it usually is.

use std::fmt;

use xt28_machine::Wheel;

use crate::Dimension;

/// One time series of a log.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Channel {
    /// Cylinder extension.
    Stroke(Wheel),
    /// Estimated vertical wheel force (facts 3.3).
    WheelLoad(Wheel),
    /// Cylinder load, bore less rod.
    CylinderLoad(Wheel),
    /// Pressure of chamber A.
    BorePressure(Wheel),
    /// Pressure of chamber B.
    RodPressure(Wheel),
    /// Reference current of solenoid A, which retracts.
    RetractCurrent(Wheel),
    /// Reference current of solenoid B, which extends.
    ExtendCurrent(Wheel),
    /// Wheel speed, forward positive.
    WheelSpeed(Wheel),
    /// Front articulation joint, left positive.
    FrontJoint,
    /// Rear articulation joint, left positive.
    RearJoint,
    /// Roll of the front frame, right side high positive.
    Roll,
    /// Pitch of the front frame, nose up positive.
    Pitch,
    /// Pressure of a pump's side.
    PumpPressure(PumpSide),
    /// Current of a pump's side.
    PumpCurrent(PumpSide),
    /// Current of a wheel's motor, none where it has all of its displacement.
    MotorCurrent(Wheel),
    /// Current of a steering solenoid.
    SteerCurrent(SteerSide),
    /// GNSS antenna, east.
    East,
    /// GNSS antenna, north.
    North,
    /// Heading that the receiver says, counter-clockwise from east, 0 to one turn.
    Heading,
    /// Commanded: stroke.
    TargetStroke(Wheel),
    /// Commanded: mode of the arms, 0 off to 3 manual valve.
    ArmMode,
    /// Commanded: valve opening, positive extends.
    TargetOpening(Wheel),
    /// Commanded: throttle, negative is reverse.
    Throttle,
    /// Commanded: front joint angle.
    TargetJoint,
    /// Commanded: engine speed.
    TargetEngineSpeed,
    /// Commanded: brake, 0 or 1.
    Brake,
    /// Commanded: drive enable, 0 or 1.
    Enable,
}

/// A side of one of the two transmission pumps; A is reverse, B forward (facts 1.1).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[allow(missing_docs)]
pub enum PumpSide {
    OneA,
    OneB,
    TwoA,
    TwoB,
}

/// A steering solenoid; A turns left (facts 1.1).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[allow(missing_docs)]
pub enum SteerSide {
    FrontA,
    FrontB,
    RearA,
    RearB,
}

impl PumpSide {
    /// In the order of the wire.
    pub const ALL: [Self; 4] = [Self::OneA, Self::OneB, Self::TwoA, Self::TwoB];

    const fn name(self) -> &'static str {
        ["1A", "1B", "2A", "2B"][self as usize]
    }
}

impl SteerSide {
    /// In the order of the wire.
    pub const ALL: [Self; 4] = [Self::FrontA, Self::FrontB, Self::RearA, Self::RearB];

    const fn name(self) -> &'static str {
        ["front_A", "front_B", "rear_A", "rear_B"][self as usize]
    }
}

/// What a log must hold for a replay to be possible and judged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Need {
    /// Without it there is nothing to feed or to judge.
    Required,
    /// Compared, or fed, where the log has it.
    Optional,
}

impl Channel {
    /// Every channel, in the order of a report.
    #[must_use]
    pub fn all() -> Vec<Self> {
        const PER_WHEEL: [fn(Wheel) -> Channel; 11] = [
            Channel::Stroke,
            Channel::WheelSpeed,
            Channel::WheelLoad,
            Channel::CylinderLoad,
            Channel::BorePressure,
            Channel::RodPressure,
            Channel::RetractCurrent,
            Channel::ExtendCurrent,
            Channel::MotorCurrent,
            Channel::TargetStroke,
            Channel::TargetOpening,
        ];
        let mut all: Vec<Self> = PER_WHEEL.iter().flat_map(|&make| Wheel::ALL.map(make)).collect();
        all.extend(PumpSide::ALL.map(Self::PumpPressure));
        all.extend(PumpSide::ALL.map(Self::PumpCurrent));
        all.extend(SteerSide::ALL.map(Self::SteerCurrent));
        all.extend([Self::FrontJoint, Self::RearJoint, Self::Roll, Self::Pitch]);
        all.extend([
            Self::East,
            Self::North,
            Self::Heading,
            Self::ArmMode,
            Self::Throttle,
            Self::TargetJoint,
        ]);
        all.extend([Self::TargetEngineSpeed, Self::Brake, Self::Enable]);
        all
    }

    /// The channel that [`fmt::Display`] calls `name`, as a mapping file does.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::all().into_iter().find(|channel| channel.to_string() == name)
    }

    /// Its dimension; values are in that dimension's SI unit.
    #[must_use]
    pub const fn dimension(self) -> Dimension {
        match self {
            Self::Stroke(_) | Self::TargetStroke(_) | Self::East | Self::North => Dimension::Length,
            Self::WheelLoad(_) | Self::CylinderLoad(_) => Dimension::Force,
            Self::BorePressure(_) | Self::RodPressure(_) | Self::PumpPressure(_) => {
                Dimension::Pressure
            }
            Self::RetractCurrent(_)
            | Self::ExtendCurrent(_)
            | Self::PumpCurrent(_)
            | Self::MotorCurrent(_)
            | Self::SteerCurrent(_) => Dimension::Current,
            Self::WheelSpeed(_) | Self::TargetEngineSpeed => Dimension::AngularSpeed,
            Self::FrontJoint
            | Self::RearJoint
            | Self::Roll
            | Self::Pitch
            | Self::Heading
            | Self::TargetJoint => Dimension::Angle,
            Self::TargetOpening(_) | Self::Throttle => Dimension::Ratio,
            Self::ArmMode | Self::Brake | Self::Enable => Dimension::Plain,
        }
    }

    /// Whether a diagnosis and a replay alike can do without it.
    #[must_use]
    pub const fn need(self) -> Need {
        match self {
            Self::Stroke(_)
            | Self::WheelSpeed(_)
            | Self::FrontJoint
            | Self::RearJoint
            | Self::Roll
            | Self::Pitch
            | Self::TargetStroke(_)
            | Self::ArmMode
            | Self::Throttle
            | Self::TargetJoint => Need::Required,
            _ => Need::Optional,
        }
    }

    /// True for what a receiver says: a fix is where the machine was then, and no longer.
    pub(crate) const fn is_fix(self) -> bool {
        matches!(self, Self::East | Self::North | Self::Heading)
    }

    /// True for what the gateway commands, false for what the machine measures.
    #[must_use]
    pub const fn is_command(self) -> bool {
        matches!(
            self,
            Self::TargetStroke(_)
                | Self::ArmMode
                | Self::TargetOpening(_)
                | Self::Throttle
                | Self::TargetJoint
                | Self::TargetEngineSpeed
                | Self::Brake
                | Self::Enable
        )
    }
}

impl fmt::Display for Channel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (kind, part) = match self {
            Self::Stroke(w) => ("stroke", w.name()),
            Self::WheelLoad(w) => ("wheel_load", w.name()),
            Self::CylinderLoad(w) => ("cylinder_load", w.name()),
            Self::BorePressure(w) => ("bore_pressure", w.name()),
            Self::RodPressure(w) => ("rod_pressure", w.name()),
            Self::RetractCurrent(w) => ("retract_current", w.name()),
            Self::ExtendCurrent(w) => ("extend_current", w.name()),
            Self::WheelSpeed(w) => ("wheel_speed", w.name()),
            Self::FrontJoint => ("joint", "front"),
            Self::RearJoint => ("joint", "rear"),
            Self::Roll => ("attitude", "roll"),
            Self::Pitch => ("attitude", "pitch"),
            Self::PumpPressure(side) => ("pump_pressure", side.name()),
            Self::PumpCurrent(side) => ("pump_current", side.name()),
            Self::MotorCurrent(w) => ("motor_current", w.name()),
            Self::SteerCurrent(side) => ("steer_current", side.name()),
            Self::East => ("position", "east"),
            Self::North => ("position", "north"),
            Self::Heading => ("position", "heading"),
            Self::TargetStroke(w) => ("target_stroke", w.name()),
            Self::ArmMode => ("target", "arm_mode"),
            Self::TargetOpening(w) => ("target_opening", w.name()),
            Self::Throttle => ("target", "throttle"),
            Self::TargetJoint => ("target", "front_joint"),
            Self::TargetEngineSpeed => ("target", "engine_speed"),
            Self::Brake => ("target", "brake"),
            Self::Enable => ("target", "enable"),
        };
        write!(f, "{kind}.{part}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_unique_and_lead_back() {
        let all = Channel::all();
        for channel in &all {
            assert_eq!(Channel::from_name(&channel.to_string()), Some(*channel));
        }
        let mut sorted = all.clone();
        sorted.sort();
        sorted.dedup();
        assert_eq!(sorted.len(), all.len());
        assert_eq!(Channel::from_name("stroke.XX"), None);
    }
}
