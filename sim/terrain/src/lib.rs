//! The ground: heights on a 0.1 m grid of triangles, made of layers or read from height maps.
#![forbid(unsafe_code)]

mod canvas;
mod extent;
mod grid;
mod layers;
mod minima;
mod terrain;

pub use extent::Extent;
pub use grid::{Grid, SPACING_M};
pub use layers::ramp::Ramp;
pub use minima::{Minima, Nearest};
pub use terrain::{Plane, Terrain};
