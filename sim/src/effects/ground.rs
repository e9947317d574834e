//! What may be true of the ground's lie.

pub(super) mod terrain_slope;

pub use terrain_slope::TerrainSlope;
