//! The plant: a vehicle made of blocks that can be stepped alone on measured inputs.
//!
//! A block is a pure `step(state, input, dt)`: arm hydraulics, drive, steering, tyre, sensors.
//! [`Vehicle`] joins them to a solver of the rigid bodies ([`Bodies`]). What the nominal machine
//! leaves out is in [`effects`]. Nothing here knows of frames or of a bus.
#![forbid(unsafe_code)]

// Under its own name too, for a rig that unit and integration tests share.
#[cfg(test)]
extern crate self as xt28_sim;

mod actuation;
mod actuators;
mod blocks;
mod bodies;
pub mod effects;
mod end_stop;
mod fleet;
mod parts;
mod plant;
mod rapier;
mod reduced;
mod sensors;
mod solver;
mod state;
mod vehicle;

pub use actuation::Actuation;
pub use blocks::{
    Accumulator, Arm, ArmInput, ArmState, Cylinder, CylinderForce, CylinderMotion, CylinderState,
    Drive, DriveInput, DriveOutput, DriveState, FlowSharing, Lock, PATCHES_MAX, PatchInput,
    PatchState, Patches, Pressed, Steering, SteeringInput, SteeringState, Tyre, Valve, ValveState,
    slip_trim_nm,
};
pub use bodies::{Bodies, HingeMotion, HingeSpring, Loads, Motion, Placed, RollingDrag, Wrench};
pub use effects::Effects;
pub use fleet::Fleet;
pub use parts::{
    ArmPart, Brush, HullBall, Part, Parts, REFERENCE_STROKE_M, RollHinge, Tilt, TyrePart,
};
pub use plant::{Held, Plant, STEP, Track};
pub use rapier::{RapierBodies, Tread};
pub use reduced::ReducedBodies;
pub use sensors::{GnssFix, GnssReceiver, HeightMapReader, Imu, ImuSample, Readings, Sensors};
pub use solver::{Solver, UnknownSolver};
pub use state::VehicleState;
pub use vehicle::Vehicle;
pub use xt28_terrain::{self as terrain, Ramp, Terrain, TerrainError, TerrainSpec};
