//! Heights while layers are being added to them; a grid once they all are.

use crate::Extent;
use crate::grid::{Grid, PER_M};

/// Heights on the grid points of an extent, in double precision until the last layer is on.
pub(crate) struct Canvas {
    /// The first point, in grid steps from the origin.
    first: [i64; 2],
    columns: usize,
    rows: usize,
    height_m: Vec<f64>,
}

impl Canvas {
    /// Level ground at height zero.
    #[allow(clippy::cast_possible_truncation)]
    pub(crate) fn new(extent: Extent) -> Self {
        assert_eq!(extent.check(), Ok(()), "no grid can lie there");
        let [columns, rows] = extent.size();
        let first = [extent.x_m[0], extent.y_m[0]].map(|m| (m * PER_M).round() as i64);
        Self { first, columns, rows, height_m: vec![0.0; columns * rows] }
    }

    /// Adds a height to every point.
    pub(crate) fn add(&mut self, mut height_m: impl FnMut(f64, f64) -> f64) {
        let columns = self.columns;
        for row in 0..self.rows {
            let y_m = position(self.first[1], row);
            for column in 0..columns {
                let x_m = position(self.first[0], column);
                self.height_m[row * columns + column] += height_m(x_m, y_m);
            }
        }
    }

    /// Calls `change` with index, x and y of each point within a rectangle, to add what it returns.
    pub(crate) fn add_within(
        &mut self,
        within: Extent,
        mut change: impl FnMut(usize, f64, f64) -> f64,
    ) {
        let columns = span(within.x_m, self.first[0], self.columns);
        for row in span(within.y_m, self.first[1], self.rows) {
            let y_m = position(self.first[1], row);
            for column in columns.clone() {
                let index = row * self.columns + column;
                self.height_m[index] += change(index, position(self.first[0], column), y_m);
            }
        }
    }

    /// Number of points.
    pub(crate) fn len(&self) -> usize {
        self.height_m.len()
    }

    /// The grid, going on beyond its edge with a rise of `beyond` (along x, along y; m/m). A height
    /// that is not finite becomes 0.
    pub(crate) fn into_grid(self, beyond: [f64; 2]) -> Grid {
        #[allow(clippy::cast_possible_truncation)]
        let heights = self.height_m.iter().map(|h| if h.is_finite() { *h as f32 } else { 0.0 });
        Grid::new(self.first, [self.columns, self.rows], heights.collect(), beyond)
    }
}

impl Grid {
    /// A grid over `extent`, sampled from a function; a height that is not finite becomes 0.
    ///
    /// # Panics
    /// [`Extent::check`] refuses the extent.
    #[must_use]
    pub fn from_fn(extent: Extent, height_m: impl Fn(f64, f64) -> f64) -> Self {
        Self::on_slope(extent, [0.0; 2], height_m)
    }

    /// As [`Self::from_fn`], on ground that goes on rising by `beyond` (along x, along y; m/m)
    /// outside the extent. The function gives whole heights, the slope included.
    ///
    /// # Panics
    /// [`Extent::check`] refuses the extent.
    #[must_use]
    pub fn on_slope(extent: Extent, beyond: [f64; 2], height_m: impl Fn(f64, f64) -> f64) -> Self {
        let mut canvas = Canvas::new(extent);
        canvas.add(height_m);
        canvas.into_grid(beyond)
    }
}

/// Position of a column or row, m: the decimal number nearest to it, as people write it.
#[allow(clippy::cast_precision_loss)]
fn position(first: i64, index: usize) -> f64 {
    (first as f64 + index as f64) / PER_M
}

/// The columns or rows whose positions lie in `[from, to]`.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, clippy::cast_precision_loss)]
fn span([from, to]: [f64; 2], first: i64, count: usize) -> std::ops::Range<usize> {
    let low = (from * PER_M - first as f64).ceil().max(0.0) as usize;
    let high = (to * PER_M - first as f64).floor() + 1.0;
    low..(high.max(0.0) as usize).min(count)
}
