//! Files that lie, and specs with any numbers: refused or built, never a panic, never gigabytes.

use std::alloc::System;
use std::fs;
use std::path::Path;

use proptest::prelude::*;
use stats_alloc::{INSTRUMENTED_SYSTEM, Region, StatsAlloc};
use xt28_terrain::{Extent, HeightMap, LayerKind, Terrain, TerrainSpec};

#[global_allocator]
static ALLOCATOR: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;

/// All that reading a small file may allocate, added up, bytes. A megabyte-sized lie in a header
/// passes; one of a gigabyte does not.
const ALLOCATED_MAX: usize = 256 << 20;

const FILES: [(&str, &[u8]); 4] = [
    ("survey.tif", include_bytes!("gdal/survey.tif")),
    ("survey-lzw-i16.tif", include_bytes!("gdal/survey-lzw-i16.tif")),
    ("survey.asc", include_bytes!("gdal/survey.asc")),
    ("levels.png", include_bytes!("gdal/levels.png")),
];

fn small(name: &str, folder: &Path) -> TerrainSpec {
    let picture = name.ends_with(".png").then_some(1.0);
    let height_map = HeightMap {
        file: folder.join(name),
        start_m: None,
        level_m: Some(0.0),
        fill_m: Some(0.0),
        spacing_m: picture,
        black_m: picture,
        white_m: picture,
    };
    TerrainSpec {
        height_map: vec![height_map],
        grid: Extent { x_m: [-1.0, 1.0], y_m: [-1.0, 1.0] },
        ..TerrainSpec::default()
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn a_slip_in_a_file_costs_a_bounded_amount(
        which in 0..FILES.len(),
        // Most of what a header says is in the first bytes, or, in a TIFF, in the last ones.
        slips in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..5),
        header_only in any::<bool>(),
        cut in prop::option::weighted(0.2, any::<prop::sample::Index>()),
    ) {
        let (name, bytes) = FILES[which];
        let mut bytes = bytes.to_vec();
        for (index, byte) in slips {
            let at = index.index(if header_only { bytes.len().min(400) } else { bytes.len() });
            bytes[at] = byte;
        }
        if let Some(cut) = cut {
            bytes.truncate(cut.index(bytes.len()));
        }
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join(name), bytes).unwrap();
        let spec = small(name, folder.path());
        let region = Region::new(ALLOCATOR);
        let outcome = spec.build();
        let allocated = region.change().bytes_allocated;
        prop_assert!(allocated < ALLOCATED_MAX, "{allocated} bytes");
        if let Err(error) = outcome {
            let error = error.to_string();
            prop_assert!(error.contains(name) && !error.contains('\n'), "{error}");
        }
    }

    #[test]
    fn any_numbers_are_refused_or_built(
        numbers in prop::collection::vec(
            prop_oneof![any::<f64>(), -1.0..10.0_f64, Just(0.0), Just(f64::NAN)], 24,
        ),
        count in prop_oneof![0..50_u32, any::<u32>()],
        seed in any::<u64>(),
    ) {
        let mut numbers = numbers.into_iter();
        let mut n = || numbers.next().unwrap();
        let text = format!(
            "[slope]\ngrade = {:?}\nuphill_deg = {:?}\n\
             [ramp]\nx_m = [1, 2, {:?}, {:?}]\nheight_m = {:?}\ny_min_m = {:?}\ny_max_m = 3\n\
             [step]\nx_m = {:?}\nheight_m = {:?}\nend_x_m = {:?}\n\
             [perlin]\namplitude_m = {:?}\nwavelength_m = {:?}\npersistence = {:?}\nseed = {}\n\
             [bumps]\nheight_m = {:?}\nwavelength_m = {:?}\n\
             [course]\nx_m = {:?}\ncount = {count}\nspacing_m = {:?}\nheight_m = {:?}\n\
             [boulders]\ncount = {count}\nradius_m = [{:?}, 1]\nheight_m = [0, {:?}]\n\
             [map]\nnoise_m = {:?}\nshift_m = [0, {:?}, 0]\n\
             [grid]\nx_m = [-1, 2]\ny_m = [-1, 1]\n",
            n(), n(), n(), n(), n(), n(), n(), n(), n(), n(), n(), n(), seed >> 1, n(), n(), n(),
            n(), n(), n(), n(), n(), n(),
        );
        // TOML has its own word for what is no number.
        let text = text.replace("NaN", "nan");
        let Ok(spec) = TerrainSpec::parse(&text, Path::new("t.toml")) else { return Ok(()) };
        let ground = spec.build().unwrap();
        let map = spec.build_map(&ground).unwrap();
        for terrain in [ground, map] {
            prop_assert!(terrain.height_m(0.3, 0.4).is_finite());
        }
    }
}

#[test]
fn layers_one_by_one_survive_extremes() {
    // The property above seldom has all layers valid at once; here each stands alone at its limits.
    for text in [
        "kind = \"slope\"\ngrade = -1.0\nuphill_deg = -360.0",
        "kind = \"ramp\"\nx_m = [-1e300, 0, 1, 1e300]\nheight_m = -5\ny_min_m = -1e300\ny_max_m = 1e300",
        "kind = \"step\"\nx_m = -1e300\nheight_m = 2",
        "kind = \"perlin\"\namplitude_m = 10\nwavelength_m = 25.6\noctaves = 8\npersistence = 1",
        "kind = \"perlin\"\namplitude_m = 0\nwavelength_m = 0.2\noctaves = 1\nseed = 9223372036854775807",
        "kind = \"bumps\"\nheight_m = 2\nwavelength_m = 0.5",
        "kind = \"course\"\nx_m = 1e300\ncount = 1000",
        "kind = \"boulders\"\ncount = 1000\nradius_m = [20, 20]\nheight_m = [5, 5]",
        "kind = \"boulders\"\ndensity_per_m2 = 10\nradius_m = [0.1, 0.1]\nheight_m = [0, 0]",
    ] {
        let terrain = Terrain::parse(text, Path::new("t.toml")).unwrap();
        for (x, y) in [(0.0, 0.0), (44.9, -19.9), (-1e5, 1e5)] {
            assert!(terrain.height_m(x, y).is_finite(), "{text}");
        }
    }
    assert_eq!(toml::Value::try_from(LayerKind::HeightMap).unwrap().as_str(), Some("height_map"));
}
