//! What a terrain is made of: each layer adds its heights to the others'.

pub(crate) mod boulders;
pub(crate) mod bumps;
pub(crate) mod course;
pub(crate) mod height_map;
pub(crate) mod perlin;
pub(crate) mod ramp;
pub(crate) mod slope;
pub(crate) mod step;
