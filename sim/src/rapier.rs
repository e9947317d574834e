//! The reference solver: the vehicle as a multibody of the engine rapier3d.

mod bodies;
mod ground_contact;
mod hinge;
mod hull_watch;
mod insert;
mod rolling;
mod shapes;
mod spin;
mod tyre_contact;

pub use bodies::RapierBodies;
pub use tyre_contact::Tread;
