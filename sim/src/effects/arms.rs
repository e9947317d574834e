//! What may be true of the arms' hydraulics, in the order from command to cylinder.

pub(super) mod accumulator_gas;
pub(super) mod arm_delay;
pub(super) mod arm_gain;
pub(super) mod leakage_drift;
pub(super) mod load_dependent_speed;
pub(super) mod lock_damping;
pub(super) mod lock_stiffness;
pub(super) mod pump_flow_limit;
pub(super) mod seal_stiction;
pub(super) mod speed_asymmetry;
pub(super) mod unsupported_sag;
pub(super) mod valve_deadband;
pub(super) mod valve_gain;
pub(super) mod valve_hysteresis;
pub(super) mod valve_lag;

pub use accumulator_gas::AccumulatorGas;
pub use arm_delay::ArmDelay;
pub use arm_gain::ArmGain;
pub use leakage_drift::LeakageDrift;
pub use load_dependent_speed::LoadDependentSpeed;
pub use lock_damping::LockDamping;
pub use lock_stiffness::{LOCK_STIFFNESS, LockStiffness};
pub use pump_flow_limit::PumpFlowLimit;
pub use seal_stiction::SealStiction;
pub use speed_asymmetry::SpeedAsymmetry;
pub use unsupported_sag::UnsupportedSag;
pub use valve_deadband::ValveDeadband;
pub use valve_gain::ValveGain;
pub use valve_hysteresis::ValveHysteresis;
pub use valve_lag::ValveLag;

/// What is true of one arm's hydraulics.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ArmEffects {
    /// In the ECU.
    pub gain: ArmGain,
    /// Command to spool.
    pub delay: ArmDelay,
    /// Command to spool.
    pub lag: ValveLag,
    /// Command to spool.
    pub hysteresis: ValveHysteresis,
    /// Spool to flow.
    pub deadband: ValveDeadband,
    /// Spool to flow.
    pub valve_gain: ValveGain,
    /// Spool to flow.
    pub asymmetry: SpeedAsymmetry,
    /// Spool to flow.
    pub load_dependence: LoadDependentSpeed,
    /// Flow past piston and valve.
    pub leakage: LeakageDrift,
    /// Flow past piston and valve.
    pub sag: UnsupportedSag,
    /// Oil to force.
    pub gas: AccumulatorGas,
    /// Oil to force.
    pub lock_stiffness: LockStiffness,
    /// Oil to force.
    pub lock_damping: LockDamping,
    /// Rod against barrel.
    pub stiction: SealStiction,
}
