//! Height maps that GDAL 3.10 wrote: every format as the world's own tool writes it.
//!
//! `survey.tif` (32-bit floats in tiles, deflate, predictor 3, EPSG:3006) and `survey.asc` hold
//! `20 + c/8 - r/16 + (c r mod 5)/32` at column c and row r from the north-west, 40 by 30 samples of
//! 0.5 m, the last without data. `survey-lzw-i16.tif` holds `c - 2 r`, `levels.png` `1000 c + 7 r`.

use std::path::Path;

use xt28_terrain::{Terrain, TerrainError};

fn load(text: &str) -> Result<Terrain, TerrainError> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/gdal");
    Terrain::parse(&format!("kind = \"height_map\"\n{text}"), &folder.join("terrain.toml"))
}

/// The ground at the middle of every sample; `start` is that of the machine from the outer corner in
/// the south-west, m.
fn check(terrain: &Terrain, start: [f64; 2], height: impl Fn(u32, u32) -> f64, within: f64) {
    for column in 0..40 {
        for row in 0..30 {
            // The middle of a pixel of 0.5 m, from the outer corner in the south-west.
            let east = 0.5 * f64::from(column) + 0.25;
            let north = 0.5 * f64::from(29 - row) + 0.25;
            let found = terrain.height_m(east - start[0], north - start[1]);
            let expected = height(column, row);
            assert!((found - expected).abs() < within, "{column} {row}: {found} {expected}");
        }
    }
}

fn surveyed(column: u32, row: u32) -> f64 {
    let (c, r) = (f64::from(column), f64::from(row));
    let height = 20.0 + c / 8.0 - r / 16.0 + f64::from(column * row % 5) / 32.0;
    if (column, row) == (39, 29) { 20.0 } else { height }
}

#[test]
fn tiff_and_ascii_grid_of_one_survey_are_one_ground() {
    let keys = "start_m = [658005.05, 6642005.05]\nlevel_m = 0\nfill_m = 20.0";
    let tiff = load(&format!("file = \"survey.tif\"\n{keys}")).unwrap();
    let ascii = load(&format!("file = \"survey.asc\"\n{keys}")).unwrap();
    assert_eq!(tiff, ascii);
    check(&tiff, [5.05, 5.05], surveyed, 1e-5);
    // Without level_m the start is at zero.
    let level = load("file = \"survey.tif\"\nfill_m = 20.0").unwrap();
    assert!(level.height_m(0.0, 0.0).abs() < 1e-6);
}

#[test]
fn integers_packed_another_way_are_read() {
    let terrain =
        load("file = \"survey-lzw-i16.tif\"\nstart_m = [658005.05, 6642005.05]\nlevel_m = 0")
            .unwrap();
    check(&terrain, [5.05, 5.05], |c, r| f64::from(c) - 2.0 * f64::from(r), 1e-5);
}

#[test]
fn grey_levels_become_heights() {
    let keys = "spacing_m = 0.5\nblack_m = 0\nwhite_m = 65.535\nstart_m = [4.8, 4.8]\nlevel_m = 0";
    let terrain = load(&format!("file = \"levels.png\"\n{keys}")).unwrap();
    // A picture counts from the middle of its lower left pixel, 0.25 m inside the corner.
    check(&terrain, [5.05, 5.05], |c, r| f64::from(1000 * c + 7 * r) / 1000.0, 1e-5);
}

#[test]
fn a_hole_and_degrees_are_refused_by_file() {
    let hole = load("file = \"survey.tif\"").unwrap_err().to_string();
    assert!(hole.contains("survey.tif: no data under") && hole.contains("fill_m"), "{hole}");
    let degrees = load("file = \"degrees.tif\"").unwrap_err().to_string();
    assert!(degrees.contains("degrees.tif: it lies in degrees"), "{degrees}");
    let none = load("file = \"none.tif\"").unwrap_err().to_string();
    assert!(none.contains("none.tif: cannot read the height map"), "{none}");
}
