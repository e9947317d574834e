//! What the nominal machine leaves out: every effect's parameters, neutral unless set.
//!
//! One folder a part of the machine, one file an effect: what it is, where it acts, its parameters with unit,
//! tolerance and range, its law and a source. Blocks read [`Effects`] when they are built; an effect
//! at its neutral values changes no bit of what the plant does. [`CATALOGUE`] lists them all, so that
//! an overlay file, a trainer and a diagnoser reach every parameter by name.

mod arms;
mod bus;
mod catalogue;
mod delay_line;
mod drive;
mod effect;
mod ground;
mod idle;
mod lag;
mod overlay;
mod payload;
mod scope;
mod sensors;
mod steering;
mod tyres;
mod values;

pub use arms::{
    AccumulatorGas, ArmDelay, ArmEffects, ArmGain, LOCK_STIFFNESS, LeakageDrift,
    LoadDependentSpeed, LockDamping, LockStiffness, PumpFlowLimit, SealStiction, SpeedAsymmetry,
    UnsupportedSag, ValveDeadband, ValveGain, ValveHysteresis, ValveLag,
};
pub use bus::{BusEffects, CommandJitter, FrameLoss};
pub use catalogue::{CATALOGUE, find};
pub use delay_line::DelayLine;
pub use drive::{
    DriveEffects, DriveLag, EngineDroop, RollingResistance, StandstillDrag, ThrottleDelay,
};
pub use effect::{Block, Effect, Parameter, Slot};
pub use ground::TerrainSlope;
pub use lag::Lag;
pub use overlay::{Entry, Overlay, OverlayError};
pub use payload::{ComShift, MassEffects, Payload};
pub use scope::{Scope, UnknownScope};
pub use sensors::{
    GnssLatency, GnssLeverArm, ImuOffset, PressureBias, PressureScale, SensorEffects, StrokeBias,
    StrokeScale, WheelSpeedScale,
};
pub use steering::{
    RearFollowerLag, SteerBacklash, SteerDelay, SteerGain, SteerLag, SteerRate, SteeringEffects,
};
pub use tyres::{SlipperyGround, SoftTyre};
pub use values::{Effects, WheelEffects};
