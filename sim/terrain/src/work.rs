//! How much there is to work out of a terrain, bounded before anything is.

use crate::raster::SAMPLES_MAX;
use crate::{Fault, TerrainSpec};

/// Most heights that are worked out for one terrain, of all its layers together: up to half a minute, of noise.
const HEIGHTS_MAX: u64 = 1 << 30;

impl TerrainSpec {
    /// Says which layer makes it too much. [`Self::grid`] has passed its own check.
    ///
    /// # Errors
    /// That layer's table, and what to make smaller.
    pub(crate) fn check_work(&self) -> Result<(), Fault> {
        let mut heights = 0_u64;
        for (table, index, of_layer) in self.heights() {
            heights = heights.saturating_add(of_layer);
            if heights > HEIGHTS_MAX {
                let [columns, rows] = self.grid.size();
                let problem = format!(
                    "with this layer {heights} heights are to be worked out on {columns} by {rows} grid \
                     points, more than {HEIGHTS_MAX}; fewer layers, fewer or smaller boulders, or a smaller [grid]"
                );
                return Err(Fault { table, index, problem });
            }
        }
        Ok(())
    }

    /// Table, index and heights of each layer: one a grid point, octave or sample, and one for each point that a
    /// boulder may cover. The slope costs nothing beside the others.
    fn heights(&self) -> impl Iterator<Item = (&'static str, usize, u64)> {
        let [columns, rows] = self.grid.size();
        let points = (columns as u64).saturating_mul(rows as u64);
        let even = move |table, count| (0..count).map(move |index| (table, index, points));
        let perlin = self.perlin.iter().enumerate();
        let boulders = self.boulders.iter().enumerate();
        // What a file holds is known once it is open; it is no more than this.
        let files =
            (0..self.height_map.len()).map(move |k| ("height_map", k, points + SAMPLES_MAX));
        even("ramp", self.ramp.len())
            .chain(even("step", self.step.len()))
            .chain(perlin.map(move |(k, layer)| ("perlin", k, u64::from(layer.octaves) * points)))
            .chain(even("bumps", self.bumps.len()))
            .chain(even("course", self.course.len()))
            .chain(
                boulders.map(move |(k, layer)| ("boulders", k, layer.heights(self.grid, points))),
            )
            .chain(files)
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    fn refusal(text: &str) -> String {
        TerrainSpec::parse(text, Path::new("t.toml")).unwrap_err().to_string()
    }

    #[test]
    fn more_boulders_than_can_be_laid_are_refused() {
        let boulders = |count: u32| {
            format!(
                "[[bumps]]\nheight_m = 0.1\nwavelength_m = 3\n[[boulders]]\ncount = {count}\nradius_m = [20, 20]\nheight_m = [1, 1]\n"
            )
        };
        assert!(TerrainSpec::parse(&boulders(6000), Path::new("t.toml")).is_ok());
        let error = refusal(&boulders(100_000));
        assert!(error.starts_with("t.toml:4: [boulders]: with this layer 16"), "{error}");
        assert!(error.contains("601 by 401 grid points") && error.contains("smaller"), "{error}");
    }

    #[test]
    fn layers_on_the_greatest_grid_are_counted_together() {
        let grid = "[grid]\nx_m = [0, 400]\ny_m = [0, 400]\n";
        let layers = |count| "[[step]]\nx_m = 2\nheight_m = 0.1\n".repeat(count) + grid;
        assert!(TerrainSpec::parse(&layers(60), Path::new("t.toml")).is_ok());
        // The first of them that is too much: 67 times 4001 by 4001 are below 2^30, 68 are not.
        let error = refusal(&layers(100));
        assert!(error.starts_with("t.toml:202: [step]: with this layer"), "{error}");
        let perlin = "[[perlin]]\namplitude_m = 1\nwavelength_m = 100\noctaves = 8\n".repeat(9);
        assert!(refusal(&(perlin + grid)).starts_with("t.toml:33: [perlin]: with"));
        let maps = "[[height_map]]\nfile = \"a.tif\"\n".repeat(40);
        assert!(refusal(&(maps + grid)).contains("[height_map]: with this layer"));
    }
}
