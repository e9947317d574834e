//! A height map from a file, laid onto the grid.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use crate::TerrainError;
use crate::canvas::Canvas;

/// A height map from a file: ESRI ASCII grid (`.asc`), GeoTIFF (`.tif`) or grey PNG (`.png`).
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct HeightMap {
    /// The file, relative to the terrain file.
    pub file: PathBuf,
}

impl HeightMap {
    /// Says what no height map can be.
    ///
    /// # Errors
    /// A sentence that names the key.
    pub fn check(&self) -> Result<(), &'static str> {
        Ok(())
    }

    pub(crate) fn add_to(&self, _canvas: &mut Canvas) -> Result<(), TerrainError> {
        Ok(())
    }
}
