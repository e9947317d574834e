//! What may be true of engine, circuits and rolling wheels.

pub(super) mod drive_lag;
pub(super) mod engine_droop;
pub(super) mod rolling_resistance;
pub(super) mod standstill_drag;
pub(super) mod throttle_delay;

pub use drive_lag::DriveLag;
pub use engine_droop::EngineDroop;
pub use rolling_resistance::RollingResistance;
pub use standstill_drag::StandstillDrag;
pub use throttle_delay::ThrottleDelay;

/// What is true of engine and circuits.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DriveEffects {
    /// Displacement to speed.
    pub throttle_delay: ThrottleDelay,
    /// Displacement to speed.
    pub lag: DriveLag,
    /// Of the engine.
    pub engine_droop: EngineDroop,
}
