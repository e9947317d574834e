//! A height map from a file, laid onto the grid.

use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use crate::TerrainError;
use crate::canvas::Canvas;
use crate::raster::png::Scale;
use crate::raster::{Raster, SAMPLES_MAX, ascii_grid, geotiff, png};

/// A height map from a file: ESRI ASCII grid (`.asc`), GeoTIFF (`.tif`) or grey PNG (`.png`).
///
/// East of the file is ahead of the start, north is to its left. Heights are resampled bilinearly
/// to the 0.1 m grid; beyond the map, the ground goes on at the height of its edge.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct HeightMap {
    /// The file, relative to the terrain file.
    pub file: PathBuf,
    /// Where the machine starts, m east and north in the file's own system (in a picture: from its
    /// lower left pixel); the middle of the map if left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub start_m: Option<[f64; 2]>,
    /// Height in the file that becomes zero, m; that at the start if left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub level_m: Option<f64>,
    /// Height in the file's own system for samples without data, m. Without it, a hole in the
    /// ground that is asked for is an error.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fill_m: Option<f64>,
    /// PNG only: from pixel to pixel, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub spacing_m: Option<f64>,
    /// PNG only: height of black, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub black_m: Option<f64>,
    /// PNG only: height of white, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub white_m: Option<f64>,
}

/// Most bytes of a file: 32 for each of the most samples, more than anyone writes for one in any of the formats.
const BYTES_MAX: u64 = 32 * SAMPLES_MAX;
/// No ground is higher, nor deeper, m: what else a file says is its word for no data.
const HEIGHT_MAX_M: f32 = 9e3;
/// What to do about a height that is none.
const NO_HEIGHT: &str =
    "heights lie within 9 km of zero, and a file's no-data value says what is no height";

/// What a file is, by its ending.
enum Format {
    AsciiGrid,
    GeoTiff,
    Png,
}

impl HeightMap {
    /// Says what no height map can be; does not open the file.
    ///
    /// # Errors
    /// A sentence that names the key.
    pub fn check(&self) -> Result<(), String> {
        let numbers = [self.level_m, self.fill_m, self.spacing_m, self.black_m, self.white_m];
        let start_m = self.start_m.into_iter().flatten();
        if !numbers.into_iter().flatten().chain(start_m).all(f64::is_finite) {
            return Err("every number of a height map must be finite".to_owned());
        }
        let heights = [self.level_m, self.fill_m, self.black_m, self.white_m];
        if let Some(height) =
            heights.into_iter().flatten().find(|height| height.abs() > f64::from(HEIGHT_MAX_M))
        {
            return Err(format!("{height:e} m is no height; {NO_HEIGHT}"));
        }
        let scale = [self.spacing_m, self.black_m, self.white_m];
        match self.format()? {
            Format::Png if self.scale().is_none() => {
                Err("a PNG needs spacing_m (pixel to pixel), black_m and white_m (heights)"
                    .to_owned())
            }
            Format::Png => Ok(()),
            _ if scale.iter().any(Option::is_some) => {
                Err("spacing_m, black_m and white_m are for PNG; this file has its own".to_owned())
            }
            _ => Ok(()),
        }
    }

    fn format(&self) -> Result<Format, String> {
        let ending = self.file.extension().unwrap_or_default().to_string_lossy();
        match ending.to_ascii_lowercase().as_str() {
            "asc" => Ok(Format::AsciiGrid),
            "tif" | "tiff" => Ok(Format::GeoTiff),
            "png" => Ok(Format::Png),
            other => Err(format!("file ends in `.{other}`; height maps are .asc, .tif or .png")),
        }
    }

    fn scale(&self) -> Option<Scale> {
        let (spacing_m, black_m, white_m) = (self.spacing_m?, self.black_m?, self.white_m?);
        Some(Scale { spacing_m, black_m, white_m })
    }

    fn raster(&self, bytes: &[u8]) -> Result<Raster, String> {
        self.check()?;
        let raster = match (self.format()?, self.scale()) {
            (Format::AsciiGrid, _) => ascii_grid::read(bytes),
            (Format::GeoTiff, _) => geotiff::read(bytes),
            (Format::Png, Some(scale)) => png::read(bytes, scale),
            (Format::Png, None) => Err("a PNG needs its scale".to_owned()),
        }?;
        // No sample is no height, but an infinite one is, and a wrong one.
        match raster.height_m.iter().find(|height| height.abs() > HEIGHT_MAX_M) {
            Some(height) => Err(format!("a height of {height:e} m; {NO_HEIGHT}")),
            None => Ok(raster),
        }
    }

    /// Adds its heights to a canvas.
    pub(crate) fn add_to(&self, canvas: &mut Canvas) -> Result<(), TerrainError> {
        let bytes = self.bytes()?;
        self.lay(&bytes, canvas).map_err(|problem| refuse(&self.file, problem))
    }

    /// What the file holds, once its size is known to be one of a height map: a pipe or a device has none.
    fn bytes(&self) -> Result<Vec<u8>, TerrainError> {
        let unread = |source| TerrainError::Read {
            path: self.file.clone(),
            what: "height map",
            remedy: "its path is relative to the file that names it",
            source,
        };
        let meta = std::fs::metadata(&self.file).map_err(unread)?;
        if !meta.is_file() {
            let problem = "it is no plain file; give a height map that is one".to_owned();
            return Err(refuse(&self.file, problem));
        }
        let mut bytes = Vec::new();
        if meta.len() <= BYTES_MAX {
            // It may grow meanwhile.
            let file = File::open(&self.file).map_err(unread)?;
            file.take(BYTES_MAX + 1).read_to_end(&mut bytes).map_err(unread)?;
        }
        let length = meta.len().max(bytes.len() as u64);
        if length > BYTES_MAX {
            return Err(refuse(
                &self.file,
                format!(
                    "{length} bytes are more than {BYTES_MAX}; cut the map to the area driven on"
                ),
            ));
        }
        Ok(bytes)
    }

    fn lay(&self, bytes: &[u8], canvas: &mut Canvas) -> Result<(), String> {
        let raster = self.raster(bytes)?;
        let [x_m, y_m] = raster.covers_m();
        let middle = [0.5 * (x_m[0] + x_m[1]), 0.5 * (y_m[0] + y_m[1])];
        let [east, north] = self.start_m.unwrap_or(middle);
        if !(x_m[0]..=x_m[1]).contains(&east) || !(y_m[0]..=y_m[1]).contains(&north) {
            return Err(format!(
                "start_m = [{east}, {north}] lies outside: the map covers {} to {} east, {} to {} north",
                x_m[0], x_m[1], y_m[0], y_m[1]
            ));
        }
        let height = |x: f64, y: f64| {
            let height = raster.height_m(x, y);
            self.fill_m.filter(|_| height.is_nan()).unwrap_or(height)
        };
        let level_m = self.level_m.unwrap_or_else(|| height(east, north));
        let mut holes = 0_usize;
        let mut first_hole = None;
        canvas.add(|x, y| {
            let height = height(east + x, north + y);
            if height.is_nan() {
                holes += 1;
                first_hole.get_or_insert([east + x, north + y]);
            }
            height - level_m
        });
        let Some([x, y]) = first_hole else {
            return if level_m.is_nan() {
                Err("no data at the start; set level_m".to_owned())
            } else {
                Ok(())
            };
        };
        Err(format!(
            "no data under {holes} of {} grid points, the first at {x:.1} east, {y:.1} north; \
             close the holes (`gdal_fillnodata.py`), move [grid], or set fill_m",
            canvas.len()
        ))
    }
}

fn refuse(path: &Path, problem: String) -> TerrainError {
    TerrainError::HeightMap { path: path.to_owned(), problem }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Extent;

    const GRID: &str = "ncols 3\nnrows 3\nxllcenter 100\nyllcenter 200\ncellsize 2\n\
        nodata_value -1\n54 54 54\n52 52 52\n50 50 -1\n";

    fn map() -> HeightMap {
        HeightMap {
            file: PathBuf::from("map.asc"),
            start_m: None,
            level_m: None,
            fill_m: None,
            spacing_m: None,
            black_m: None,
            white_m: None,
        }
    }

    fn lay(map: &HeightMap, extent: Extent) -> Result<crate::Grid, String> {
        let mut canvas = Canvas::new(extent);
        map.lay(GRID.as_bytes(), &mut canvas)?;
        Ok(canvas.into_grid([0.0; 2]))
    }

    const NORTH: Extent = Extent { x_m: [-2.0, 2.0], y_m: [0.0, 5.0] };

    #[test]
    fn the_start_is_at_height_zero_and_edges_go_on() {
        let grid = lay(&map(), NORTH).unwrap();
        for (y, height) in [(0.0, 0.0), (1.0, 1.0), (2.0, 2.0), (4.5, 2.0)] {
            assert!((grid.height_m(0.7, y) - height).abs() < 1e-6, "{y}");
        }
        let level = HeightMap { level_m: Some(51.0), start_m: Some([100.0, 203.0]), ..map() };
        assert!((lay(&level, NORTH).unwrap().height_m(0.0, 0.0) - 2.0).abs() < 1e-6);
    }

    #[test]
    fn holes_are_loud_unless_filled() {
        let whole = Extent { x_m: [-2.0, 2.0], y_m: [-2.0, 2.0] };
        let error = lay(&map(), whole).unwrap_err();
        // Grid points south-east of the middle, but for the lines on which samples are whole.
        assert!(error.starts_with("no data under 400 of 1681 grid points"), "{error}");
        assert!(error.contains("fill_m"), "{error}");
        let filled = lay(&HeightMap { fill_m: Some(50.0), ..map() }, whole).unwrap();
        assert!((filled.height_m(2.0, -2.0) + 2.0).abs() < 1e-6);
        let astray = HeightMap { start_m: Some([99.0, 201.0]), ..map() };
        assert!(lay(&astray, NORTH).unwrap_err().contains("covers 100 to 104 east"));
    }

    #[test]
    fn what_no_ground_is_high_is_refused() {
        for level_m in [1e12, -1e30, 1e300] {
            let error = HeightMap { level_m: Some(level_m), ..map() }.check().unwrap_err();
            assert!(error.contains("is no height"), "{error}");
        }
        for wrong in ["1e39", "-9999.5", "1e300"] {
            let grid = GRID.replace("54 54 54", &format!("54 {wrong} 54"));
            let error = map().raster(grid.as_bytes()).unwrap_err();
            assert!(error.starts_with("a height of ") && error.contains("no-data"), "{error}");
        }
    }

    #[test]
    fn a_scale_is_for_pictures_alone() {
        assert!(map().check().is_ok());
        assert!(HeightMap { black_m: Some(0.0), ..map() }.check().unwrap_err().contains("PNG"));
        let picture = HeightMap { file: "map.png".into(), ..map() };
        assert!(picture.check().unwrap_err().contains("needs spacing_m"));
        let other = HeightMap { file: "map.xyz".into(), ..map() };
        assert!(other.check().unwrap_err().contains(".asc, .tif or .png"));
    }
}
