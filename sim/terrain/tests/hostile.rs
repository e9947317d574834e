//! Files that lie, and specs with any numbers: refused or built, never a panic, never gigabytes.

use std::alloc::System;
use std::cell::Cell;
use std::fs;
use std::path::Path;

use proptest::prelude::*;
use proptest::test_runner::TestRunner;
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
}

/// Keys of a terrain with all layers, each with the numbers that it may have beside those of the others.
const KEYS: [[f64; 2]; 22] = [
    // slope: grade, uphill_deg
    [-1.0, 1.0],
    [-360.0, 360.0],
    // ramp: x_m of crest and foot, height_m, y_min_m
    [2.1, 5.0],
    [5.1, 9.0],
    [-5.0, 5.0],
    [-5.0, 2.9],
    // step: x_m, height_m, end_x_m
    [-1.0, 1.0],
    [-2.0, 2.0],
    [1.1, 5.0],
    // perlin: amplitude_m, wavelength_m, persistence
    [0.0, 10.0],
    [1.6, 20.0],
    [0.0, 1.0],
    // bumps: height_m, wavelength_m
    [0.0, 2.0],
    [0.5, 10.0],
    // course: x_m, spacing_m, height_m
    [-1.0, 1.0],
    [1.0, 5.0],
    [0.0, 1.0],
    // boulders: radius_m, the least; height_m, the greatest
    [0.1, 1.0],
    [0.0, 5.0],
    // map: noise_m, shift_m along y
    [0.0, 1.0],
    [-100.0, 100.0],
    // grid: y_m, the end
    [1.0, 3.0],
];

/// A terrain of all layers with these numbers for [`KEYS`].
fn all_layers(numbers: [f64; KEYS.len()], count: u32, seed: u64) -> String {
    let text = format!(
        "[slope]\ngrade = #\nuphill_deg = #\n\
         [ramp]\nx_m = [1, 2, #, #]\nheight_m = #\ny_min_m = #\ny_max_m = 3\n\
         [step]\nx_m = #\nheight_m = #\nend_x_m = #\n\
         [perlin]\namplitude_m = #\nwavelength_m = #\npersistence = #\nseed = {}\n\
         [bumps]\nheight_m = #\nwavelength_m = #\n\
         [course]\nx_m = #\ncount = {count}\nspacing_m = #\nheight_m = #\n\
         [boulders]\ncount = {count}\nradius_m = [#, 1]\nheight_m = [0, #]\n\
         clear = {{ x_m = [-1, -0.5], y_m = [-1, -0.5] }}\n\
         [map]\nnoise_m = #\nshift_m = [0, #, 0]\n\
         [grid]\nx_m = [-1, 2]\ny_m = [-1, #]\n",
        seed >> 1,
    );
    let fill = |text: String, number: f64| text.replacen('#', &format!("{number:?}"), 1);
    let text = numbers.into_iter().fold(text, fill);
    // TOML has its own word for what is no number.
    text.replace("NaN", "nan")
}

/// Numbers that go together, but for one or two at times, which may be anything.
fn numbers() -> impl Strategy<Value = [f64; KEYS.len()]> {
    let anything = prop_oneof![any::<f64>(), -1.0..10.0_f64, Just(0.0), Just(f64::NAN)];
    let slips = prop::collection::vec((0..KEYS.len(), anything), 0..3);
    let shares = prop::array::uniform22(0.0..=1.0_f64);
    (shares, slips).prop_map(|(shares, slips)| {
        let mut numbers = shares;
        for (number, [low, high]) in numbers.iter_mut().zip(KEYS) {
            *number = low + *number * (high - low);
        }
        slips.into_iter().for_each(|(key, number)| numbers[key] = number);
        numbers
    })
}

#[test]
fn any_numbers_are_refused_or_built() {
    const CASES: u32 = 400;
    let built = Cell::new(0);
    let counts = prop_oneof![9 => 1..50_u32, 1 => any::<u32>()];
    let strategy = (numbers(), counts, any::<u64>());
    let (cases, source_file) = (CASES, Some(file!()));
    let config = ProptestConfig { cases, source_file, ..ProptestConfig::default() };
    let mut runner = TestRunner::new(config);
    let outcome = runner.run(&strategy, |(numbers, count, seed)| {
        let text = all_layers(numbers, count, seed);
        let spec = match TerrainSpec::parse(&text, Path::new("t.toml")) {
            Ok(spec) => spec,
            Err(error) => {
                let error = error.to_string();
                prop_assert!(error.starts_with("t.toml:") && !error.contains('\n'), "{error}");
                return Ok(());
            }
        };
        let ground = spec.build().unwrap();
        let map = spec.build_map(&ground).unwrap();
        for terrain in [ground, map] {
            for (x_m, y_m) in [(0.3, 0.4), (1.9, -0.9), (-1e5, 1e5)] {
                prop_assert!(terrain.height_m(x_m, y_m).is_finite());
            }
        }
        built.set(built.get() + 1);
        Ok(())
    });
    outcome.unwrap();
    // Without it the property would hold of a crate that refuses everything.
    assert!(built.get() > CASES / 4, "{} of {CASES} were built", built.get());
}

#[test]
fn layers_one_by_one_survive_extremes() {
    // The property above has all layers at once and few numbers at the end of their range; here each stands alone there.
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

/// Few lines that would keep a processor busy for minutes, draw without end, or read a disk full of zeros.
#[test]
fn work_without_end_is_refused_before_it_is_begun() {
    let folder = tempfile::tempdir().unwrap();
    let huge = fs::File::create(folder.path().join("huge.asc")).unwrap();
    huge.set_len((1 << 29) + 1).unwrap();
    fs::create_dir(folder.path().join("folder.asc")).unwrap();
    let boulders = "kind = \"boulders\"\nheight_m = [1, 1]\ncount = 100000\n";
    let perlin = "[[perlin]]\namplitude_m = 1\nwavelength_m = 100\noctaves = 8\n".repeat(100);
    for (text, says) in [
        (format!("{boulders}radius_m = [20, 20]"), "t.toml:1: [boulders]: with this layer"),
        (
            format!(
                "{boulders}radius_m = [0.3, 0.3]\nclear = {{ x_m = [-14.365, 45], y_m = [-20, 20] }}"
            ),
            "[boulders]: clear leaves so little room",
        ),
        (format!("{perlin}[grid]\nx_m = [0, 400]\ny_m = [0, 400]"), "t.toml:33: [perlin]: with"),
        ("kind = \"height_map\"\nfile = \"huge.asc\"".to_owned(), "huge.asc: 536870913 bytes"),
        ("kind = \"height_map\"\nfile = \"folder.asc\"".to_owned(), "folder.asc: it is no plain"),
    ] {
        let error = Terrain::parse(&text, &folder.path().join("t.toml")).unwrap_err().to_string();
        assert!(error.contains(says) && !error.contains('\n'), "{error}");
    }
}
