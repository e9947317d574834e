//! The plant: a rapier3d vehicle made of blocks that can be stepped alone on measured inputs.
//!
//! A block is a pure `step(state, input, dt)`: the arm cylinder, the drive, the steering, the
//! sensors. [`Vehicle`] joins them to rigid bodies. Nothing here knows of frames or of a bus.
#![forbid(unsafe_code)]

mod actuation;
mod cylinder;
mod drive;
mod gnss;
mod ground_contact;
mod ground_minima;
mod imu;
mod rigid_bodies;
mod rigid_parts;
mod state;
mod steering;
mod terrain;
mod terrain_file;
mod vehicle;

pub use actuation::Actuation;
pub use cylinder::{Cylinder, CylinderForce, CylinderInput, CylinderState};
pub use drive::{Drive, DriveInput, DriveOutput, DriveState};
pub use gnss::{GnssFix, GnssReceiver};
pub use imu::{Imu, ImuSample};
pub use state::VehicleState;
pub use steering::{Steering, SteeringInput, SteeringState};
pub use terrain::{Ramp, Terrain};
pub use terrain_file::TerrainError;
pub use vehicle::{Plant, STEP, Vehicle};
