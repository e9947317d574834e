//! From layers to ground: all heights added up on the grid, once.

use std::sync::Arc;

use crate::canvas::Canvas;
use crate::layers::boulders::DRAWS_TOTAL;
use crate::{Fault, Plane, Slope, Terrain, TerrainError, TerrainSpec};

impl TerrainSpec {
    /// The ground.
    ///
    /// # Errors
    /// [`TerrainError::Read`] or [`TerrainError::HeightMap`] for a file that it names,
    /// [`TerrainError::Layer`] for what [`Self::check`] refuses, and for boulders that find no room.
    pub fn build(&self) -> Result<Terrain, TerrainError> {
        self.check()?;
        let plane = self.slope.as_ref().map(Slope::plane);
        if self.is_plane() {
            return Ok(plane.map_or(Terrain::Flat, Terrain::Plane));
        }
        let mut canvas = Canvas::new(self.grid);
        let plane = plane.unwrap_or_default();
        canvas.add(|x, y| {
            plane.at_m(x, y)
                + sum(&self.ramp, |ramp| ramp.height_m(x, y))
                + sum(&self.step, |step| step.height_m(x, y))
                + sum(&self.perlin, |perlin| perlin.height_m(x, y))
                + sum(&self.bumps, |bumps| bumps.height_m(x, y))
                + sum(&self.course, |course| course.height_m(x, y))
        });
        let mut draws_left = DRAWS_TOTAL;
        for (index, boulders) in self.boulders.iter().enumerate() {
            let added = boulders.add_to(&mut canvas, self.grid, &mut draws_left);
            added.map_err(|problem| Fault { table: "boulders", index, problem })?;
        }
        for height_map in &self.height_map {
            height_map.add_to(&mut canvas)?;
        }
        Ok(Terrain::Grid(Arc::new(canvas.into_grid(plane.rise))))
    }

    /// The map of `ground`, this spec's own, that a policy is given.
    ///
    /// # Errors
    /// As [`Self::build`].
    pub fn build_map(&self, ground: &Terrain) -> Result<Terrain, TerrainError> {
        self.check()?;
        let map = &self.map;
        if map.is_exact() {
            return Ok(ground.clone());
        }
        let surveyed = if map.leave_out.is_empty() {
            ground.clone()
        } else {
            self.clone().without(&map.leave_out).build()?
        };
        let [dx, dy, dz] = map.shift_m;
        if map.noise_m == 0.0 && map.shift_m == [0.0; 3] {
            return Ok(surveyed);
        }
        let beyond = match &surveyed {
            Terrain::Flat => [0.0; 2],
            Terrain::Plane(Plane { rise, .. }) => *rise,
            Terrain::Grid(grid) => grid.beyond(),
        };
        let mut noise_m = map.noise_m();
        let mut canvas = Canvas::new(self.grid);
        canvas.add(|x, y| surveyed.height_m(x - dx, y - dy) + dz + noise_m());
        Ok(Terrain::Grid(Arc::new(canvas.into_grid(beyond))))
    }
}

fn sum<T>(layers: &[T], height_m: impl Fn(&T) -> f64) -> f64 {
    layers.iter().map(height_m).sum()
}
