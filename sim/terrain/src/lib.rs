//! The ground: heights on a 0.1 m grid of triangles, made of layers or read from height maps.
#![forbid(unsafe_code)]

mod build;
mod canvas;
mod error;
mod extent;
mod file;
mod grid;
mod layers;
mod map;
mod minima;
mod raster;
mod search;
mod spec;
mod terrain;

pub use error::TerrainError;
pub use extent::Extent;
pub use grid::{Grid, SPACING_M};
pub use layers::boulders::{Boulder, Boulders};
pub use layers::bumps::Bumps;
pub use layers::course::Course;
pub use layers::height_map::HeightMap;
pub use layers::perlin::Perlin;
pub use layers::ramp::Ramp;
pub use layers::slope::Slope;
pub use layers::step::Step;
pub use map::MapSpec;
pub use minima::{Minima, Nearest};
pub use spec::{Fault, LayerKind, TerrainSpec};
pub use terrain::{Plane, Terrain};
