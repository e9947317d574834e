//! The ground: a height for every point, as a plane or a 0.1 m grid of triangles.

use std::sync::Arc;

use serde::Deserialize;

/// Spacing of the grid, m (paper 3.1).
pub(crate) const SPACING_M: f64 = 0.1;
/// The grid reaches this far beyond the origin on every side but forward, m.
const BEHIND_M: f64 = 15.0;
/// The grid reaches this far forward, m.
const AHEAD_M: f64 = 45.0;

/// Ground that the wheels stand on. Cheap to clone: the heights are shared.
#[derive(Clone, Debug)]
pub enum Terrain {
    /// Level at height zero, without end.
    Flat,
    /// Triangles on a grid; level at height zero beyond it.
    Grid(Arc<Grid>),
}

/// Heights on a square grid, each cell split from its low corner to its high corner.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    origin_m: [f64; 2],
    columns: usize,
    rows: usize,
    height_m: Vec<f32>,
}

/// A ramp in a lane along x: up between the first two stations, level, down between the last two.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Ramp {
    /// Stations, m from the start of the front axle: foot, crest, crest, foot.
    pub x_m: [f64; 4],
    /// Height between the two crests, m.
    pub height_m: f64,
    /// Right edge of the lane, m (y is left).
    pub y_min_m: f64,
    /// Left edge of the lane, m.
    pub y_max_m: f64,
}

impl Ramp {
    /// Height at a point, m.
    #[must_use]
    pub fn height_m(&self, x_m: f64, y_m: f64) -> f64 {
        if y_m < self.y_min_m || y_m > self.y_max_m {
            return 0.0;
        }
        let [foot, crest, end, out] = self.x_m;
        let share = if x_m < crest {
            (x_m - foot) / (crest - foot)
        } else if x_m > end {
            (out - x_m) / (out - end)
        } else {
            1.0
        };
        self.height_m * share.clamp(0.0, 1.0)
    }
}

impl Terrain {
    /// Level ground with one ramp.
    #[must_use]
    pub fn ramp(ramp: &Ramp) -> Self {
        let half_m = 20.0;
        Self::Grid(Arc::new(Grid::from_fn([-BEHIND_M, -half_m], [AHEAD_M, half_m], |x, y| {
            ramp.height_m(x, y)
        })))
    }

    /// Height at a point, m.
    #[must_use]
    pub fn height_m(&self, x_m: f64, y_m: f64) -> f64 {
        match self {
            Self::Flat => 0.0,
            Self::Grid(grid) => grid.height_m(x_m, y_m),
        }
    }
}

impl Grid {
    /// A grid over a rectangle, sampled from a function.
    #[must_use]
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, clippy::cast_precision_loss)]
    pub fn from_fn(from_m: [f64; 2], to_m: [f64; 2], height_m: impl Fn(f64, f64) -> f64) -> Self {
        let count = |axis: usize| ((to_m[axis] - from_m[axis]) / SPACING_M).round() as usize + 1;
        let (columns, rows) = (count(0), count(1));
        let mut heights = Vec::with_capacity(columns * rows);
        for row in 0..rows {
            for column in 0..columns {
                let x = from_m[0] + column as f64 * SPACING_M;
                let y = from_m[1] + row as f64 * SPACING_M;
                heights.push(height_m(x, y) as f32);
            }
        }
        Self { origin_m: from_m, columns, rows, height_m: heights }
    }

    /// Number of grid points along x and along y.
    #[must_use]
    pub const fn size(&self) -> [usize; 2] {
        [self.columns, self.rows]
    }

    /// Position of the first grid point, m.
    #[must_use]
    pub const fn origin_m(&self) -> [f64; 2] {
        self.origin_m
    }

    /// Height of grid point (`column`, `row`), m.
    #[must_use]
    pub fn vertex_m(&self, column: usize, row: usize) -> f32 {
        self.height_m[row * self.columns + column]
    }

    /// Height on the triangle under a point, m; zero beyond the grid.
    #[must_use]
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    pub fn height_m(&self, x_m: f64, y_m: f64) -> f64 {
        let u = (x_m - self.origin_m[0]) / SPACING_M;
        let v = (y_m - self.origin_m[1]) / SPACING_M;
        if !(u >= 0.0 && v >= 0.0) {
            return 0.0;
        }
        let (column, row) = (u as usize, v as usize);
        if column + 1 >= self.columns || row + 1 >= self.rows {
            return 0.0;
        }
        let (u, v) = (u.fract(), v.fract());
        let h = |c: usize, r: usize| f64::from(self.vertex_m(column + c, row + r));
        if u >= v {
            h(0, 0) + u * (h(1, 0) - h(0, 0)) + v * (h(1, 1) - h(1, 0))
        } else {
            h(0, 0) + v * (h(0, 1) - h(0, 0)) + u * (h(1, 1) - h(0, 1))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn field_ramp() -> Ramp {
        Ramp { x_m: [4.0, 7.0, 8.5, 11.5], height_m: 0.3, y_min_m: -1.9, y_max_m: -0.5 }
    }

    #[test]
    fn a_ramp_rises_in_its_lane_and_nowhere_else() {
        let terrain = Terrain::ramp(&field_ramp());
        assert!((terrain.height_m(5.5, -1.175) - 0.15).abs() < 1e-6);
        assert!((terrain.height_m(7.7, -1.175) - 0.3).abs() < 1e-6);
        assert_eq!(terrain.height_m(7.7, 1.175), 0.0);
        assert_eq!(terrain.height_m(3.9, -1.175), 0.0);
        assert_eq!(terrain.height_m(1e9, f64::NAN), 0.0);
    }

    #[test]
    fn triangles_interpolate_a_plane_exactly() {
        let grid = Grid::from_fn([0.0, 0.0], [2.0, 2.0], |x, y| 0.5 * x - 0.25 * y);
        for (x, y) in [(0.33, 0.71), (1.99, 0.01), (0.5, 0.5), (1.25, 1.75)] {
            assert!((grid.height_m(x, y) - (0.5 * x - 0.25 * y)).abs() < 1e-6);
        }
    }
}
