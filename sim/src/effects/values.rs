//! The values of all effects, block by block.

use xt28_machine::{Machine, PerWheel};

use super::{
    ArmEffects, BusEffects, DriveEffects, MassEffects, PressureBias, PressureScale, PumpFlowLimit,
    RollingResistance, SensorEffects, SlipperyGround, SoftTyre, StandstillDrag, SteeringEffects,
    StrokeBias, StrokeScale, TerrainSlope, WheelSpeedScale,
};

/// What is true of this machine beyond the nominal one. The default is nothing.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Effects {
    /// Of each arm's hydraulics.
    pub arms: PerWheel<ArmEffects>,
    /// Of the pump that arms and steering share.
    pub pump_flow: PumpFlowLimit,
    /// Of the articulation joints.
    pub steering: SteeringEffects,
    /// Of engine and circuits.
    pub drive: DriveEffects,
    /// Of each wheel and of the sensors at it.
    pub wheels: PerWheel<WheelEffects>,
    /// Of the masses.
    pub masses: MassEffects,
    /// Of the whole ground.
    pub slope: TerrainSlope,
    /// Of the sensors of which there is one.
    pub sensors: SensorEffects,
    /// Of the way to the ECUs.
    pub bus: BusEffects,
}

impl Effects {
    /// No effect on this machine: the default, but with the machine file's own numbers where effects
    /// replace some.
    #[must_use]
    pub fn none_on(machine: &Machine) -> Self {
        let soft_tyre = SoftTyre::of(machine);
        let wheels = PerWheel::splat(WheelEffects { soft_tyre, ..WheelEffects::default() });
        Self { wheels, ..Self::default() }
    }

    /// The values from which each effect sets in on this machine as its severity grows. They are those of
    /// no effect, but that a pump which never runs short has no flow to begin with.
    pub(super) fn onset_on(machine: &Machine) -> Self {
        Self { pump_flow: PumpFlowLimit::least_ample_on(machine), ..Self::none_on(machine) }
    }
}

/// What is true of one wheel and of the sensors of its arm.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WheelEffects {
    /// Ground against wheel.
    pub rolling_resistance: RollingResistance,
    /// Motor against wheel.
    pub standstill_drag: StandstillDrag,
    /// Ground against wheel.
    pub slippery_ground: SlipperyGround,
    /// The tyre.
    pub soft_tyre: SoftTyre,
    /// Position sensor.
    pub stroke_bias: StrokeBias,
    /// Position sensor.
    pub stroke_scale: StrokeScale,
    /// Bore pressure sensor.
    pub pressure_bias: PressureBias,
    /// Both pressure sensors.
    pub pressure_scale: PressureScale,
    /// Speed sensor.
    pub wheel_speed_scale: WheelSpeedScale,
}
