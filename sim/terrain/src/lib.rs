//! The ground: heights on a 0.1 m grid of triangles, made of layers or read from height maps.
//!
//! | | |
//! |---|---|
//! | ground to stand on | [`Terrain`]: a plane without end or a shared [`Grid`] |
//! | where a ball touches it | [`Terrain::nearest`], [`Terrain::rest_m`] |
//! | a machine set down on it | [`Stance`] |
//! | what it is made of | [`TerrainSpec`], from a TOML file or a part of one |
//! | what a policy sees of it | [`LocalMap`] over the map of [`TerrainSpec::build_map`] |
//!
//! # A terrain in TOML
//!
//! A terrain is a list of layers whose heights add up. Each kind stands once, `[perlin]`, or as often
//! as wanted, `[[perlin]]`. Lengths are metres; x is ahead of the start, y to its left, and the front
//! axle starts above the origin. Keys shown with `#` may be left out and then have that value.
//!
//! ```toml
//! [slope]                   # a plane under everything, without end
//! grade = 0.08              # rise per run
//! uphill_deg = 0.0          # 0 ahead, 90 to the left
//!
//! [[perlin]]                # natural variation
//! amplitude_m = 0.25        # bound; the root mean square of four octaves is 0.19 of it
//! wavelength_m = 8.0
//! octaves = 4
//! persistence = 0.5
//! seed = 0
//!
//! [[boulders]]              # half ellipsoids; of two that overlap the higher counts
//! density_per_m2 = 0.05     # or count = 120
//! radius_m = [0.3, 0.8]     # half axes in plan, least and greatest
//! height_m = [0.1, 0.35]
//! seed = 0
//! [boulders.clear]          # where none reaches
//! x_m = [-9.0, 3.0]
//! y_m = [-3.0, 3.0]
//!
//! [[ramp]]                  # foot, crest, crest, foot in a lane
//! x_m = [4.0, 7.0, 8.5, 11.5]
//! height_m = 0.3
//! y_min_m = -1.9
//! y_max_m = -0.5
//!
//! [[step]]                  # a kerb; also end_x_m, y_min_m, y_max_m
//! x_m = 14.0
//! height_m = 0.15
//!
//! [[bumps]]                 # an egg carton
//! height_m = 0.1
//! wavelength_m = 3.0
//!
//! [[course]]                # a vibration course; the layout is assumed, see `Course`
//! x_m = 18.0
//!
//! [grid]                    # where the grid lies; this is the default
//! x_m = [-15.0, 45.0]
//! y_m = [-20.0, 20.0]
//!
//! [map]                     # how the map given to a policy differs from the ground
//! leave_out = ["boulders"]  # layers that the survey does not have
//! noise_m = 0.045           # standard deviation of its heights, frozen
//! shift_m = [0.2, 0.0, 0.0] # how far it lies off
//! seed = 0
//! ```
//!
//! A height map comes from a file beside the TOML: an ESRI ASCII grid, a GeoTIFF in metres, or a grey
//! PNG of 8 or 16 bits. A GeoTIFF that names its system and no unit is taken if that system is known to be in metres,
//! and refused otherwise: it may be in feet.
//!
//! ```toml
//! [[height_map]]
//! file = "survey.tif"
//! start_m = [658010.0, 6642007.5]   # easting, northing of the start; the middle if left out
//! level_m = 21.3                    # what becomes height zero; the height at the start if left out
//! fill_m = 20.0                     # height of samples without data; without it they are an error
//!
//! [[height_map]]
//! file = "levels.png"
//! spacing_m = 0.25                  # these three for PNG only
//! black_m = 0.0
//! white_m = 1.5
//! ```
//!
//! A file of one layer may say `kind = "ramp"` and the layer's keys without a header; level ground is
//! `kind = "flat"`.
//!
//! What would take minutes is refused: more than 2^30 heights to be worked out by all layers together (a height for
//! each grid point, octave or point under a boulder, and 2^24 for a file), boulders that find room only after ten
//! million draws, and files above 512 MiB.
//!
//! # Beyond the grid
//!
//! The ground goes on at the height of the nearest edge, plus the slope; there is no cliff to fall
//! off. The same holds beyond the edge of a height map.
#![forbid(unsafe_code)]

mod build;
mod canvas;
mod error;
mod extent;
mod file;
mod grid;
mod layers;
mod local_map;
mod map;
mod minima;
mod passes;
mod raster;
mod search;
mod spec;
mod stance;
mod terrain;
mod work;

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
pub use local_map::{LocalMap, MapPose};
pub use map::MapSpec;
pub use minima::{Minima, Nearest};
pub use spec::{Fault, LayerKind, TerrainSpec};
pub use stance::Stance;
pub use terrain::{Plane, Terrain};
