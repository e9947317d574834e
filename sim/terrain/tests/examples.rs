//! The terrain files that come with the bench, and the one in the crate's documentation.

use std::path::Path;

use sha2::{Digest, Sha256};
use xt28_terrain::{Terrain, TerrainSpec};

fn spec(name: &str) -> TerrainSpec {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../terrains");
    TerrainSpec::load(&folder.join(name)).unwrap()
}

/// The first 64 bits of a hash of all heights.
fn hash(terrain: &Terrain) -> String {
    let Terrain::Grid(grid) = terrain else { panic!("no grid") };
    let bytes: Vec<u8> = grid.heights_m().iter().flat_map(|h| h.to_le_bytes()).collect();
    Sha256::digest(bytes)[..8].iter().map(|byte| format!("{byte:02x}")).collect()
}

#[test]
fn every_file_loads_and_is_named_here() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../terrains");
    let mut names: Vec<_> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    let known = [
        "forest-unseen-boulders.toml",
        "kerb.toml",
        "lesson-1.toml",
        "lesson-2.toml",
        "slope-10.toml",
        "vibration-course.toml",
    ];
    assert_eq!(names, known);
    for name in known {
        assert!(spec(name).build().unwrap().height_m(2.0, 0.5).is_finite());
    }
}

#[test]
fn the_same_file_is_the_same_ground_bit_for_bit() {
    // Another hash means another ground under every result that was got on the old one.
    let lesson = spec("lesson-2.toml");
    assert_eq!(hash(&lesson.build().unwrap()), "9b33c03478a94feb");
    assert_eq!(hash(&lesson.build().unwrap()), hash(&lesson.clone().build().unwrap()));
    let grounds: Vec<String> =
        (1..=10).map(|seed| hash(&lesson.clone().reseeded(seed).build().unwrap())).collect();
    for (index, ground) in grounds.iter().enumerate() {
        assert!(!grounds[..index].contains(ground));
    }
}

#[test]
fn a_map_lacks_what_the_survey_lacks() {
    let forest = spec("forest-unseen-boulders.toml");
    let ground = forest.build().unwrap();
    let mut exact = forest.clone();
    (exact.map.noise_m, exact.map.shift_m) = (0.0, [0.0; 3]);
    let bare = exact.build_map(&ground).unwrap();
    let boulders: Vec<_> = forest.boulders[0].placed(forest.grid);
    for boulder in &boulders {
        let [x, y] = boulder.centre_m;
        assert!(ground.height_m(x, y) > bare.height_m(x, y) + 0.05, "{boulder:?}");
    }
    // With noise: half of its points lie above, and they spread as asked for.
    let mut noisy = forest.clone();
    (noisy.map.leave_out, noisy.map.shift_m) = (Vec::new(), [0.0, 0.0, 0.5]);
    let map = noisy.build_map(&ground).unwrap();
    assert_eq!(map, noisy.build_map(&ground).unwrap());
    let (Terrain::Grid(map), Terrain::Grid(ground)) = (&map, &ground) else { panic!("no grid") };
    let errors: Vec<f64> =
        map.heights_m().iter().zip(ground.heights_m()).map(|(m, g)| f64::from(m - g)).collect();
    let mean = errors.iter().sum::<f64>() / errors.len() as f64;
    let spread =
        (errors.iter().map(|e| (e - mean).powi(2)).sum::<f64>() / errors.len() as f64).sqrt();
    assert!((mean - 0.5).abs() < 1e-3 && (spread - 0.045).abs() < 5e-4, "{mean} {spread}");
}

#[test]
fn a_map_may_lie_off_the_ground() {
    let text =
        "[slope]\ngrade = 0.1\n[[step]]\nx_m = 5\nheight_m = 0.2\n[map]\nshift_m = [0.5, 0, 0.1]";
    let spec = TerrainSpec::parse(text, Path::new("t.toml")).unwrap();
    let ground = spec.build().unwrap();
    let map = spec.build_map(&ground).unwrap();
    for x in [-20.0, 0.0, 4.0, 5.2, 6.0, 70.0] {
        let expected = ground.height_m(x - 0.5, 0.0) + 0.1;
        assert!((map.height_m(x, 0.0) - expected).abs() < 1e-5, "{x}");
    }
    // An exact map is the ground itself, not a copy.
    let text = "[[step]]\nx_m = 5\nheight_m = 0.2";
    let spec = TerrainSpec::parse(text, Path::new("t.toml")).unwrap();
    let ground = spec.build().unwrap();
    let (Terrain::Grid(ground), Terrain::Grid(map)) = (&ground, &spec.build_map(&ground).unwrap())
    else {
        panic!("no grid")
    };
    assert!(std::sync::Arc::ptr_eq(ground, map));
}

#[test]
fn a_spec_made_in_code_is_checked_when_it_is_built() {
    let mut spec = spec("lesson-1.toml");
    spec.perlin[0].octaves = 99;
    let error = spec.build().unwrap_err().to_string();
    assert_eq!(error, "terrain [perlin]: octaves must be 1 to 8");
}

#[test]
fn the_documentation_shows_a_terrain_that_builds() {
    let text: String = include_str!("../src/lib.rs")
        .lines()
        .skip_while(|line| *line != "//! ```toml")
        .skip(1)
        .take_while(|line| *line != "//! ```")
        .map(|line| line.trim_start_matches("//!").to_owned() + "\n")
        .collect();
    let spec = TerrainSpec::parse(&text, Path::new("doc.toml")).unwrap();
    let ground = spec.build().unwrap();
    assert!((ground.height_m(-14.0, 0.0) - -1.12).abs() < 0.5);
    assert!(spec.build_map(&ground).is_ok());
}
