//! The arms' hydraulics: valves, pump, load-holding cylinders.

pub(crate) mod arm;
mod compensator;
mod holding;
mod reservoir;
mod seal;
pub(crate) mod spool;
pub(crate) mod supply;

pub(crate) use arm::Arm;
pub(crate) use holding::RodMotion;
pub(crate) use supply::Supply;
