//! Heights on a 0.1 m grid of triangles, going on beyond the edge without a cliff.

use std::fmt;

/// Spacing of the grid, m (paper 3.1).
pub const SPACING_M: f64 = 0.1;
/// Grid points to a metre. Positions are integers over this, so that 1.9 m is the number 1.9.
pub(crate) const PER_M: f64 = 10.0;
/// Cells along a side of a block whose bounds are kept.
pub(crate) const BLOCK: usize = 8;

/// Heights on a square grid, each cell split from its low corner to its high corner.
///
/// Memory: 4 bytes a point and 20 bytes per 64 cells; 1.04 MB for the default extent of 60 by 40 m.
///
/// Beyond the grid the ground goes on at the height of the nearest point of the edge, plus the
/// slope that lies under everything: a wheel that leaves the grid meets no cliff.
#[derive(Clone, PartialEq)]
pub struct Grid {
    /// The first point, in grid steps from the origin.
    first: [i64; 2],
    columns: usize,
    rows: usize,
    height_m: Vec<f32>,
    /// Rise per metre along x and y beyond the edge.
    beyond: [f64; 2],
    /// Row by row.
    blocks: Vec<Block>,
}

/// Bounds of a block of cells: what a search need not look into.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Block {
    /// The highest point, m.
    pub(crate) top_m: f32,
    /// Least and greatest rise along x of the block's triangles and those that touch it, m/m.
    pub(crate) rise_x: [f32; 2],
    /// The same along y.
    pub(crate) rise_y: [f32; 2],
}

impl Grid {
    /// From heights row by row; `first` is the first point in grid steps from the origin.
    pub(crate) fn new(
        first: [i64; 2],
        [columns, rows]: [usize; 2],
        height_m: Vec<f32>,
        beyond: [f64; 2],
    ) -> Self {
        let blocks = blocks(&height_m, columns, rows);
        Self { first, columns, rows, height_m, beyond, blocks }
    }

    /// Number of grid points along x and along y.
    #[must_use]
    pub const fn size(&self) -> [usize; 2] {
        [self.columns, self.rows]
    }

    /// Position of the first grid point, m.
    #[must_use]
    #[allow(clippy::cast_precision_loss)]
    pub fn origin_m(&self) -> [f64; 2] {
        self.first.map(|steps| steps as f64 / PER_M)
    }

    /// How the ground goes on rising beyond the edge, along x and along y, m/m.
    #[must_use]
    pub const fn beyond(&self) -> [f64; 2] {
        self.beyond
    }

    /// All heights, m, row by row along x; the rows follow one another along y.
    #[must_use]
    pub fn heights_m(&self) -> &[f32] {
        &self.height_m
    }

    /// Height of grid point (`column`, `row`), m.
    ///
    /// # Panics
    /// The point lies beyond [`Self::size`].
    #[must_use]
    pub fn vertex_m(&self, column: usize, row: usize) -> f32 {
        assert!(column < self.columns, "column {column} of {}", self.columns);
        self.height_m[row * self.columns + column]
    }

    /// Where grid point (`column`, `row`) lies in plan, m; also a point beyond the grid.
    #[allow(clippy::cast_precision_loss)]
    pub(crate) fn plan_m(&self, column: i64, row: i64) -> [f64; 2] {
        [(self.first[0] + column) as f64 / PER_M, (self.first[1] + row) as f64 / PER_M]
    }

    /// Height of a grid point that may lie beyond the grid, m.
    #[allow(clippy::cast_possible_truncation, clippy::cast_precision_loss, clippy::cast_sign_loss)]
    #[allow(clippy::cast_possible_wrap)]
    pub(crate) fn height_beyond_m(&self, column: i64, row: i64) -> f32 {
        let clamp = |index: i64, count: usize| index.clamp(0, count as i64 - 1);
        let (c, r) = (clamp(column, self.columns), clamp(row, self.rows));
        let rise = self.beyond[0] * (column - c) as f64 + self.beyond[1] * (row - r) as f64;
        self.height_m[r as usize * self.columns + c as usize] + (rise / PER_M) as f32
    }

    /// The column and row of the cell that a point lies in, counted on beyond the grid.
    #[allow(clippy::cast_possible_truncation)]
    pub(crate) fn cell(&self, x_m: f64, y_m: f64) -> [i64; 2] {
        let index = |m: f64, first: i64| floor(m * PER_M).saturating_sub(first);
        [index(x_m, self.first[0]), index(y_m, self.first[1])]
    }

    /// Index of the height of point `first` if the grid has it and `points` from there on along x and y.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, clippy::cast_possible_wrap)]
    pub(crate) fn inside(&self, first: [i64; 2], points: usize) -> Option<usize> {
        let [column, row] = first;
        let within = |first: i64, count: usize| first >= 0 && first + points as i64 <= count as i64;
        (within(column, self.columns) && within(row, self.rows))
            .then(|| row as usize * self.columns + column as usize)
    }

    /// The bounds of a block of cells.
    pub(crate) fn block(&self, column: usize, row: usize) -> &Block {
        &self.blocks[row * count(self.columns) + column]
    }

    /// Height on the triangle under a point, m. Never a cliff beyond the grid; 0 for a NaN on level
    /// ground.
    #[must_use]
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, clippy::cast_precision_loss)]
    pub fn height_m(&self, x_m: f64, y_m: f64) -> f64 {
        // Past its last point the grid ends; a NaN counts as its first one.
        let last = [self.columns - 1, self.rows - 1].map(|n| n as f64);
        let u = x_m * PER_M - self.first[0] as f64;
        let v = y_m * PER_M - self.first[1] as f64;
        let (on_u, on_v) = (u.max(0.0).min(last[0]), v.max(0.0).min(last[1]));
        let column = (on_u as usize).min(self.columns - 2);
        let row = (on_v as usize).min(self.rows - 2);
        let (s, t) = (on_u - column as f64, on_v - row as f64);
        let low = row * self.columns + column;
        let high = low + self.columns;
        let h = |index: usize| f64::from(self.height_m[index]);
        let (corner, opposite) = (h(low), h(high + 1));
        let on_grid = if s >= t {
            let beside = h(low + 1);
            corner + s * (beside - corner) + t * (opposite - beside)
        } else {
            let above = h(high);
            corner + t * (above - corner) + s * (opposite - above)
        };
        if self.beyond == [0.0; 2] {
            return on_grid;
        }
        on_grid + (self.beyond[0] * (u - on_u) + self.beyond[1] * (v - on_v)) / PER_M
    }
}

/// Where it lies; a quarter of a million heights tell nobody anything.
impl fmt::Debug for Grid {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Grid")
            .field("origin_m", &self.origin_m())
            .field("size", &self.size())
            .field("beyond", &self.beyond)
            .finish_non_exhaustive()
    }
}

/// The integer at or below a number; a few instructions where `f64::floor` is a call.
#[inline]
#[allow(clippy::cast_possible_truncation, clippy::cast_precision_loss)]
pub(crate) fn floor(x: f64) -> i64 {
    let towards_zero = x as i64;
    if (towards_zero as f64) > x { towards_zero.saturating_sub(1) } else { towards_zero }
}

/// Blocks along a side of `points` grid points; the last may lack cells.
const fn count(points: usize) -> usize {
    (points - 1).div_ceil(BLOCK)
}

/// The bounds of each block of cells.
fn blocks(height_m: &[f32], columns: usize, rows: usize) -> Vec<Block> {
    let mut all = Vec::with_capacity(count(columns) * count(rows));
    for row in (0..rows - 1).step_by(BLOCK) {
        for column in (0..columns - 1).step_by(BLOCK) {
            // With the cells around it, for a minimum on its border leans on those as well.
            let within = |low: usize, points: usize| {
                low.saturating_sub(1)..(low + BLOCK + 1).min(points - 1)
            };
            all.push(bounds(height_m, columns, [within(column, columns), within(row, rows)]));
        }
    }
    all
}

fn bounds(height_m: &[f32], stride: usize, [columns, rows]: [core::ops::Range<usize>; 2]) -> Block {
    let widen = |[low, high]: &mut [f32; 2], rise_m: f32| {
        // A little more than the rise, for rounding.
        let rise = rise_m * PER_M as f32;
        let slack = 1.0e-5 * (1.0 + rise.abs());
        (*low, *high) = (low.min(rise - slack), high.max(rise + slack));
    };
    let nothing = [f32::MAX, f32::MIN];
    let mut block = Block { top_m: f32::MIN, rise_x: nothing, rise_y: nothing };
    for row in rows {
        for column in columns.clone() {
            let low = row * stride + column;
            let [corner, right] = [height_m[low], height_m[low + 1]];
            let [above, opposite] = [height_m[low + stride], height_m[low + stride + 1]];
            for height in [corner, right, above, opposite] {
                block.top_m = block.top_m.max(height);
            }
            for rise_m in [right - corner, opposite - above] {
                widen(&mut block.rise_x, rise_m);
            }
            for rise_m in [above - corner, opposite - right] {
                widen(&mut block.rise_y, rise_m);
            }
        }
    }
    block
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::Extent;

    const SMALL: Extent = Extent { x_m: [-1.0, 2.0], y_m: [-0.5, 1.5] };

    proptest! {
        #[test]
        fn a_plane_is_exact_on_triangles_and_beyond_them(
            a in -0.5..0.5_f64, b in -0.5..0.5_f64, c in -1.0..1.0_f64,
            x in -9.0..9.0_f64, y in -9.0..9.0_f64,
        ) {
            let plane = |x: f64, y: f64| a * x + b * y + c;
            let grid = Grid::on_slope(SMALL, [a, b], plane);
            prop_assert!((grid.height_m(x, y) - plane(x, y)).abs() < 1e-6);
        }

        #[test]
        fn the_ground_has_no_cliff_anywhere(
            x in -4.0..4.0_f64, y in -4.0..4.0_f64, turn in 0.0..6.3_f64,
        ) {
            let grid = Grid::on_slope(SMALL, [0.1, -0.2], |x, y| (3.0 * x).sin() * (2.0 * y).cos());
            let (dx, dy) = (1e-4 * turn.cos(), 1e-4 * turn.sin());
            let change = grid.height_m(x + dx, y + dy) - grid.height_m(x, y);
            // The steepest triangle of this ground rises less than 4 m/m.
            prop_assert!(change.abs() < 4e-4, "{change}");
        }
    }

    #[test]
    fn positions_are_the_decimal_numbers_people_write() {
        let extent = Extent { x_m: [-15.0, 45.0], y_m: [-20.0, 20.0] };
        let lane = Grid::from_fn(extent, |_, y| if (-1.9..=-0.5).contains(&y) { 1.0 } else { 0.0 });
        for (y, height) in [(-1.9, 1.0), (-0.5, 1.0), (-2.0, 0.0), (-0.4, 0.0)] {
            assert!((lane.height_m(3.0, y) - height).abs() < 1e-9, "{y}");
        }
        assert_eq!(lane.size(), [601, 401]);
        assert_eq!(lane.origin_m(), [-15.0, -20.0]);
    }

    #[test]
    fn beyond_the_edge_lies_the_edge_and_no_number_breaks_it() {
        let grid = Grid::from_fn(SMALL, |x, _| x);
        assert!((grid.height_m(1e9, 0.0) - 2.0).abs() < 1e-6);
        assert!((grid.height_m(f64::NEG_INFINITY, 7.0) + 1.0).abs() < 1e-6);
        assert!(grid.height_m(f64::NAN, f64::NAN).is_finite());
        assert_eq!(Grid::from_fn(SMALL, |_, _| f64::NAN).height_m(0.0, 0.0), 0.0);
    }
}
