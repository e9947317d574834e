//! What two sensors tell of one thing and tell differently, beyond any fault: a database or a mapping is to blame.

use crate::diagnosis::{
    AttitudeScale, JointScale, LoadScale, OddHeading, SideOrder, SpeedScale, StrokeScale,
    SwappedChambers, TurnedValves, WheelScale,
};

/// What does not agree, and what to look at.
#[derive(Debug, thiserror::Error)]
pub enum Disagreement {
    /// The pressures of a cylinder's chambers are in each other's places.
    #[error(
        "the chambers of a cylinder look swapped: {swapped}, for so they make the load that the frames tell (or that load has the wrong sign); mend DBC or mapping"
    )]
    ChamberOrder {
        /// Where.
        swapped: SwappedChambers,
    },
    /// The chambers' pressures and the cylinders' loads are not on one scale.
    #[error(
        "the chambers' pressures do not make the cylinders' loads: {scale} times what the frames tell; check unit and factor of both in DBC and mapping"
    )]
    LoadScale {
        /// Where, and by how much.
        scale: LoadScale,
    },
    /// The solenoids of a valve are in each other's places.
    #[error(
        "an arm goes out where its valve is to let it in, and in where out: {turned}, or their strokes count the other way; mend DBC or mapping"
    )]
    ValveSense {
        /// Which.
        turned: TurnedValves,
    },
    /// Wheel speeds are not on the scale of the receiver's ways and the throttle.
    #[error(
        "the wheels roll {scale}, which no machine does; check unit, factor and sign of {} in DBC and mapping",
        scale.to_mend()
    )]
    SpeedScale {
        /// By how much.
        scale: SpeedScale,
    },
    /// A wheel's speed is not on the scale of the other wheels' and of the throttle.
    #[error(
        "not all wheels turn as one machine's do: {scale} as fast as the others; check unit, factor and sign of it in DBC and mapping"
    )]
    WheelScale {
        /// Which, and by how much.
        scale: WheelScale,
    },
    /// A joint does not turn as its valve and the command say.
    #[error("the joints do not turn as they are steered: {scale} in DBC and mapping")]
    JointScale {
        /// Which, by how much, and what to look at.
        scale: JointScale,
    },
    /// Wheels turn faster inside a bend than outside.
    #[error(
        "the wheels on the right turn slower than those on the left where the joints bend to the left, and the other way round ({order}), which no machine does: left and right are exchanged in the wheel speeds, or in all that is read of wheels, or the joints' sign is turned in readings, targets and currents alike; compare the names of wheels in DBC and mapping with the machine"
    )]
    SideOrder {
        /// How far.
        order: SideOrder,
    },
    /// A stroke is not on the scale of its target.
    #[error(
        "the strokes are not what their targets make them: {scale}; check unit and factor of stroke and target in DBC and mapping"
    )]
    StrokeScale {
        /// Which, and by how much.
        scale: StrokeScale,
    },
    /// Roll or pitch is not on the scale of the strokes.
    #[error(
        "the machine's attitude is not what its strokes make it: {scale} what they say; {}",
        scale.to_mend()
    )]
    AttitudeScale {
        /// Which, and by how much.
        scale: AttitudeScale,
    },
    /// The heading is not the way in which the fixes go.
    #[error(
        "the receiver's heading should count counter-clockwise from east, as its fixes go, but {odd} (docs/diagnosis.md)"
    )]
    HeadingSense {
        /// How it counts.
        odd: OddHeading,
    },
}
