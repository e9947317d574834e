//! The reference solver: the vehicle as a multibody of the engine rapier3d.

mod bodies;
mod ground_contact;
mod insert;

pub use bodies::RapierBodies;
