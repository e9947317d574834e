//! Boulders: half ellipsoids set on the ground, strewn at random (paper 3.1).

use std::f64::consts::PI;

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize};

use crate::Extent;
use crate::canvas::Canvas;
use crate::grid::PER_M;

/// Most boulders of one layer.
const COUNT_MAX: u32 = 100_000;
/// How often a boulder is drawn again because it lies on the clear area.
const DRAWS_MAX: u32 = 10_000;
/// Draws for all boulders of a terrain together: a hundred for each of [`COUNT_MAX`], a second's work.
pub(crate) const DRAWS_TOTAL: u32 = 100 * COUNT_MAX;

/// Boulders strewn evenly over the grid, but for a clear area where the machine starts.
///
/// Each boulder is drawn from a stream of its own: more boulders leave the first ones where they are.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Boulders {
    /// Number of boulders; this or the density is given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub count: Option<u32>,
    /// Boulders a square metre, of the grid less the clear area.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub density_per_m2: Option<f64>,
    /// Least and greatest half axis in plan, m; both axes of a boulder are drawn from it.
    pub radius_m: [f64; 2],
    /// Least and greatest height over the ground, m.
    pub height_m: [f64; 2],
    /// Where no boulder reaches; the machine at the start and a metre around it if left out.
    #[serde(default = "start_area", deserialize_with = "both_axes")]
    pub clear: Extent,
    /// Which boulders of all those.
    #[serde(default)]
    pub seed: u64,
}

/// The machine reaches 8 m back from its front axle, 1.5 m ahead of it and 1.5 m to either side.
const fn start_area() -> Extent {
    Extent { x_m: [-9.0, 3.0], y_m: [-3.0, 3.0] }
}

/// An area of which both axes are said: what a grid has where one is left out is not around the start.
fn both_axes<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Extent, D::Error> {
    #[derive(Deserialize)]
    #[serde(deny_unknown_fields)]
    struct Axes {
        x_m: Option<[f64; 2]>,
        y_m: Option<[f64; 2]>,
    }
    match Axes::deserialize(deserializer)? {
        Axes { x_m: Some(x_m), y_m: Some(y_m) } => Ok(Extent { x_m, y_m }),
        _ => Err(D::Error::custom("clear needs both x_m = [from, to] and y_m = [from, to]")),
    }
}

/// One boulder: the upper half of an ellipsoid whose centre is on the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Boulder {
    /// Its centre, m.
    pub centre_m: [f64; 2],
    /// Its half axes in plan, m.
    pub radius_m: [f64; 2],
    /// Its height over the ground, m.
    pub height_m: f64,
    /// Direction of its first half axis: cosine and sine.
    along: [f64; 2],
}

impl Boulder {
    /// Height over the ground at a point, m.
    #[must_use]
    pub fn height_m(&self, x_m: f64, y_m: f64) -> f64 {
        let (x, y) = (x_m - self.centre_m[0], y_m - self.centre_m[1]);
        let [cos, sin] = self.along;
        let (u, v) = (x * cos + y * sin, y * cos - x * sin);
        let share = 1.0 - (u / self.radius_m[0]).powi(2) - (v / self.radius_m[1]).powi(2);
        self.height_m * share.max(0.0).sqrt()
    }

    /// Sixteen points of its rim, counter-clockwise, m.
    #[must_use]
    #[allow(clippy::cast_precision_loss)]
    pub fn outline_m(&self) -> [[f64; 2]; 16] {
        let [cos, sin] = self.along;
        std::array::from_fn(|index| {
            let (up, out) = libm::sincos(PI * index as f64 / 8.0);
            let (u, v) = (out * self.radius_m[0], up * self.radius_m[1]);
            [self.centre_m[0] + u * cos - v * sin, self.centre_m[1] + u * sin + v * cos]
        })
    }

    /// The square around it, whichever way it lies.
    fn bounds(&self) -> Extent {
        let reach_m = self.radius_m[0].max(self.radius_m[1]);
        let [x_m, y_m] = self.centre_m.map(|m| [m - reach_m, m + reach_m]);
        Extent { x_m, y_m }
    }
}

impl Boulders {
    /// The boulders as they lie in `extent`.
    ///
    /// Fewer than asked for only if the clear area leaves all but no room: of a density those that
    /// fitted, of a count those before the first that did not, and of either those of ten million draws.
    #[must_use]
    pub fn placed(&self, extent: Extent) -> Vec<Boulder> {
        let mut draws_left = DRAWS_TOTAL;
        self.strewn(extent, &mut draws_left)
    }

    /// The boulders that find room in as many draws, which it counts down.
    fn strewn(&self, extent: Extent, draws_left: &mut u32) -> Vec<Boulder> {
        let mut boulders = Vec::new();
        for index in 0..self.number(extent) {
            match self.draw(extent, index, draws_left) {
                Some(boulder) => boulders.push(boulder),
                None if self.count.is_some() || *draws_left == 0 => break,
                None => {}
            }
        }
        boulders
    }

    /// Heights to be worked out for them on a grid of so many points: for each boulder as many as the square around
    /// the greatest has.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    pub(crate) fn heights(&self, extent: Extent, points: u64) -> u64 {
        let across = (2.0 * self.radius_m[1] * PER_M) as u64 + 1;
        let each = points.min(across * across);
        points + u64::from(self.number(extent)) * each
    }

    /// Whether some boulder of this reach fits on the grid beside the clear area.
    fn fits(&self, extent: Extent, reach_m: f64) -> bool {
        let covers = |clear: [f64; 2], grid: [f64; 2]| {
            clear[0] - reach_m <= grid[0] && grid[1] <= clear[1] + reach_m
        };
        !(covers(self.clear.x_m, extent.x_m) && covers(self.clear.y_m, extent.y_m))
    }

    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    fn number(&self, extent: Extent) -> u32 {
        let free_m2 = area_m2(extent.x_m, extent.y_m)
            - area_m2(overlap(self.clear.x_m, extent.x_m), overlap(self.clear.y_m, extent.y_m));
        let by_density = self.density_per_m2.map(|density| (density * free_m2).round() as u32);
        self.count.or(by_density).unwrap_or(0).min(COUNT_MAX)
    }

    fn draw(&self, extent: Extent, index: u32, draws_left: &mut u32) -> Option<Boulder> {
        let mut rng = ChaCha8Rng::seed_from_u64(self.seed);
        rng.set_stream(u64::from(index));
        let mut between = |[low, high]: [f64; 2]| low + (high - low) * rng.random::<f64>();
        let radius_m = [between(self.radius_m), between(self.radius_m)];
        let height_m = between(self.height_m);
        let (sin, cos) = libm::sincos(between([0.0, PI]));
        if !self.fits(extent, radius_m[0].max(radius_m[1])) {
            return None;
        }
        (0..DRAWS_MAX.min(*draws_left))
            .map(|_| {
                *draws_left -= 1;
                let centre_m = [between(extent.x_m), between(extent.y_m)];
                Boulder { centre_m, radius_m, height_m, along: [cos, sin] }
            })
            .find(|boulder| {
                let Extent { x_m, y_m } = boulder.bounds();
                let apart = |a: [f64; 2], b: [f64; 2]| a[1] < b[0] || b[1] < a[0];
                apart(x_m, self.clear.x_m) || apart(y_m, self.clear.y_m)
            })
    }

    /// Adds them to a canvas; where boulders overlap, the higher counts.
    ///
    /// # Errors
    /// A sentence, where fewer than `count` found room, or no draws were left.
    pub(crate) fn add_to(
        &self,
        canvas: &mut Canvas,
        extent: Extent,
        draws_left: &mut u32,
    ) -> Result<(), String> {
        let mut top_m = vec![0.0_f64; canvas.len()];
        let boulders = self.strewn(extent, draws_left);
        let number = self.number(extent);
        if *draws_left == 0 && boulders.len() < number as usize {
            let found = boulders.len();
            return Err(format!(
                "clear leaves so little room that the {DRAWS_TOTAL} draws of a terrain placed {found} of \
                 {number} boulders; give fewer, a smaller clear area or a greater grid"
            ));
        }
        if let Some(count) = self.count.filter(|&count| boulders.len() < count as usize) {
            let found = boulders.len();
            return Err(format!(
                "only {found} of count = {count} boulders find room beside clear; \
                 give fewer or smaller ones, a smaller clear area or a greater grid"
            ));
        }
        for boulder in boulders {
            canvas.add_within(boulder.bounds(), |index, x_m, y_m| {
                let before_m = top_m[index];
                top_m[index] = before_m.max(boulder.height_m(x_m, y_m));
                top_m[index] - before_m
            });
        }
        Ok(())
    }

    /// Says where the clear area leaves no room on the grid for any of a count.
    ///
    /// # Errors
    /// A sentence that names the keys.
    pub(crate) fn check_room(&self, extent: Extent) -> Result<(), &'static str> {
        if self.count.is_some_and(|count| count > 0) && !self.fits(extent, self.radius_m[0]) {
            return Err("clear and radius_m leave no room for any of count on the grid");
        }
        Ok(())
    }

    /// Says what no boulders can be.
    ///
    /// # Errors
    /// A sentence that names the key.
    pub fn check(&self) -> Result<(), &'static str> {
        match (self.count, self.density_per_m2) {
            (Some(_), Some(_)) | (None, None) => {
                return Err("give count or density_per_m2, one of the two");
            }
            (Some(count), None) if count > COUNT_MAX => {
                return Err("count must be at most 100000");
            }
            (None, Some(density)) if !(0.0..=10.0).contains(&density) => {
                return Err("density_per_m2 must be 0 to 10");
            }
            _ => {}
        }
        let between =
            |[low, high]: [f64; 2], from: f64, to: f64| from <= low && low <= high && high <= to;
        if !between(self.radius_m, 0.1, 20.0) {
            return Err("radius_m must be [least, greatest], 0.1 to 20 m");
        }
        if !between(self.height_m, 0.0, 5.0) {
            return Err("height_m must be [least, greatest], 0 to 5 m");
        }
        if ![self.clear.x_m, self.clear.y_m].iter().all(|[from, to]| from <= to) {
            return Err("clear must be x_m = [from, to], y_m = [from, to]");
        }
        Ok(())
    }
}

fn area_m2(x_m: [f64; 2], y_m: [f64; 2]) -> f64 {
    (x_m[1] - x_m[0]) * (y_m[1] - y_m[0])
}

/// What two stretches share; without length if nothing.
fn overlap(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    let from = a[0].max(b[0]);
    [from, a[1].min(b[1]).max(from)]
}

#[cfg(test)]
mod tests {
    use super::*;

    const FOREST: Boulders = Boulders {
        count: Some(200),
        density_per_m2: None,
        radius_m: [0.3, 0.9],
        height_m: [0.1, 0.4],
        clear: start_area(),
        seed: 3,
    };

    fn grid(boulders: &Boulders) -> crate::Grid {
        let mut canvas = Canvas::new(Extent::default());
        boulders.add_to(&mut canvas, Extent::default(), &mut DRAWS_TOTAL.clone()).unwrap();
        canvas.into_grid([0.0; 2])
    }

    #[test]
    fn heights_are_those_of_the_highest_ellipsoid() {
        let boulders = FOREST.placed(Extent::default());
        assert_eq!(boulders.len(), 200);
        let grid = grid(&FOREST);
        let ([columns, rows], [x0, y0]) = (grid.size(), grid.origin_m());
        let mut raised = 0;
        for row in (0..rows).step_by(3) {
            for column in (0..columns).step_by(3) {
                let (x, y) = (x0 + column as f64 * 0.1, y0 + row as f64 * 0.1);
                let top = boulders.iter().map(|b| b.height_m(x, y)).fold(0.0, f64::max);
                let height = f64::from(grid.vertex_m(column, row));
                // A rim is as steep as a wall; there, 1e-12 m of position is 1e-6 m of height.
                assert!((height - top).abs() < 2e-6, "{x} {y}: {height} {top}");
                raised += usize::from(top > 0.0);
            }
        }
        assert!(raised > 1000, "{raised}");
    }

    #[test]
    fn an_ellipsoid_is_one() {
        let boulder = Boulder {
            centre_m: [1.0, 2.0],
            radius_m: [0.8, 0.4],
            height_m: 0.3,
            along: [0.6, 0.8],
        };
        assert_eq!(boulder.height_m(1.0, 2.0), 0.3);
        // Half-way out along either axis: 0.3 sqrt(3/4).
        for (x, y) in [(1.24, 2.32), (0.84, 2.12)] {
            assert!((boulder.height_m(x, y) - 0.3 * 0.75_f64.sqrt()).abs() < 1e-12);
        }
        assert_eq!(boulder.height_m(1.0 + 0.49, 2.0 + 0.65), 0.0);
        for [x, y] in boulder.outline_m() {
            // On the rim, where the height goes with the root of the distance from it.
            assert!(boulder.height_m(x, y) < 1e-7);
            assert!(boulder.height_m(0.1 + 0.9 * x, 0.2 + 0.9 * y) > 0.12);
        }
    }

    #[test]
    fn the_start_stays_clear_and_more_boulders_move_none() {
        let few = FOREST.placed(Extent::default());
        let many = Boulders { count: Some(300), ..FOREST }.placed(Extent::default());
        assert_eq!(few[..], many[..200]);
        let grid = grid(&Boulders { count: Some(2000), ..FOREST });
        for step in 0..=60 {
            for across in [-3.0, -1.0, 0.0, 2.0, 3.0] {
                assert_eq!(grid.height_m(-9.0 + 0.2 * f64::from(step), across), 0.0);
            }
        }
        let other = Boulders { seed: 4, ..FOREST }.placed(Extent::default());
        assert!(few.iter().zip(&other).all(|(a, b)| a != b));
    }

    #[test]
    fn a_density_counts_the_free_area() {
        let strewn = Boulders { count: None, density_per_m2: Some(0.1), ..FOREST };
        // 60 by 40 m less the 12 by 6 m of the start.
        assert_eq!(strewn.placed(Extent::default()).len(), 233);
        // No room at all: none, and it ends.
        let all = Boulders { clear: Extent { x_m: [-99.0, 99.0], y_m: [-99.0, 99.0] }, ..FOREST };
        assert_eq!(Boulders { count: Some(5), ..all }.placed(Extent::default()), []);
        let (count, density_per_m2) = (None, Some(0.1));
        assert_eq!(Boulders { count, density_per_m2, ..all }.placed(Extent::default()), []);
        let twice = Boulders { density_per_m2: Some(0.1), ..FOREST };
        assert_eq!(twice.check(), Err("give count or density_per_m2, one of the two"));
    }

    #[test]
    fn a_count_without_room_is_refused_at_once() {
        let grid = Extent::default();
        let strip = |beside_m: f64| Boulders {
            count: Some(COUNT_MAX),
            clear: Extent { x_m: [grid.x_m[0] + beside_m, grid.x_m[1]], y_m: grid.y_m },
            ..FOREST
        };
        // Not even the smallest of 0.3 m fits; then the smallest do and the others do not; then all do.
        let spec = |beside_m| crate::TerrainSpec {
            boulders: vec![strip(beside_m)],
            ..crate::TerrainSpec::default()
        };
        let fault = spec(0.2).check().unwrap_err().to_string();
        assert!(fault.contains("[boulders]: clear and radius_m leave no room"), "{fault}");
        assert!(spec(0.5).check().is_ok());
        let error = spec(0.5).build().unwrap_err().to_string();
        assert!(
            error.contains("[boulders]: only ") && error.contains("of count = 100000"),
            "{error}"
        );
        assert_eq!(Boulders { count: Some(50), ..strip(5.0) }.placed(grid).len(), 50);
        // All fit, but each only in one draw of some two hundred.
        let slit = Boulders { radius_m: [0.3, 0.3], ..strip(0.635) };
        let spec = crate::TerrainSpec { boulders: vec![slit], ..crate::TerrainSpec::default() };
        let error = spec.build().unwrap_err().to_string();
        assert!(error.contains("[boulders]: clear leaves so little room"), "{error}");
        assert!(error.contains("of 100000 boulders"), "{error}");
    }
}
