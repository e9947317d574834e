//! The local minima of the distance from a point to a grid of triangles, exactly and fast.
//!
//! The distance to a surface of triangles has a local minimum at a corner if it grows along every
//! edge that leaves it, on an edge if it grows into both triangles beside it, in a triangle if the
//! foot of the perpendicular lies in it. These conditions are exact, and each is a product or two.
//! Blocks and cells of the grid that lie too deep for the ball are passed over by their top, and of a
//! block all cells but those where the ground is as steep as the line to the centre.

use crate::grid::{BLOCK, PER_M, SPACING_M, floor};
use crate::{Grid, Nearest};

/// Slack of the conditions, m²: on the border between two features, both may hold, never neither.
const SLACK_M2: f64 = 1e-12;

/// Slack of where feet can lie, m: a foot on a border belongs to the cells on both sides.
const SLACK_M: f64 = 1e-9;

/// One search around a centre above the ground; every minimum found goes to `keep`.
pub(crate) struct Search<'a, K> {
    grid: &'a Grid,
    centre_m: [f64; 3],
    reach_m: f64,
    reach_m2: f64,
    keep: K,
}

/// The heights to search in, and where they lie.
struct View<'a> {
    height_m: &'a [f32],
    /// Heights in a row.
    stride: usize,
    /// Its first point from the centre in plan, m.
    first_m: [f64; 2],
    /// The cells to look at: columns and rows from and to.
    cells: [[usize; 2]; 2],
}

/// The corners of a cell from the centre: where its low corner lies, and all heights, m.
#[derive(Clone, Copy)]
struct Cell {
    x: f64,
    y: f64,
    corner: f64,
    right: f64,
    above: f64,
    opposite: f64,
}

impl<'a, K: FnMut(Nearest)> Search<'a, K> {
    pub(crate) fn new(grid: &'a Grid, centre_m: [f64; 3], reach_m: f64, keep: K) -> Self {
        Self { grid, centre_m, reach_m, reach_m2: reach_m * reach_m, keep }
    }

    /// Searches all cells that the ball may touch.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, clippy::cast_possible_wrap)]
    pub(crate) fn run(&mut self) {
        let [x, y, _] = self.centre_m;
        let low = self.grid.cell(x - self.reach_m, y - self.reach_m);
        let high = self.grid.cell(x + self.reach_m, y + self.reach_m);
        // Each cell asks for one more point on every side of it.
        let inside =
            |axis: usize| low[axis] >= 1 && high[axis] + 2 <= self.grid.size()[axis] as i64;
        if inside(0) && inside(1) {
            let [x0, y0] = self.grid.origin_m();
            let view = View {
                height_m: self.grid.heights_m(),
                stride: self.grid.size()[0],
                first_m: [x0 - x, y0 - y],
                cells: [0, 1].map(|axis| [low[axis] as usize, high[axis] as usize]),
            };
            self.blocks(&view);
        } else {
            self.beyond_the_edge(low, high);
        }
    }

    /// As inside, on a copy of the heights as they go on beyond the edge.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    fn beyond_the_edge(&mut self, low: [i64; 2], high: [i64; 2]) {
        let (columns, rows) = (low[0] - 1..=high[0] + 1, low[1] - 1..=high[1] + 1);
        let heights: Vec<f32> = rows
            .flat_map(|row| columns.clone().map(move |column| (column, row)))
            .map(|(column, row)| self.grid.height_beyond_m(column, row))
            .collect();
        let [x0, y0] = self.grid.plan_m(low[0] - 1, low[1] - 1);
        let count = [0, 1].map(|axis| (high[axis] - low[axis] + 1) as usize);
        let view = View {
            height_m: &heights,
            stride: count[0] + 2,
            first_m: [x0 - self.centre_m[0], y0 - self.centre_m[1]],
            cells: count.map(|count| [1, count]),
        };
        self.cells(&view, view.cells);
    }

    fn blocks(&mut self, view: &View<'_>) {
        let [columns, rows] = view.cells;
        let side_m = BLOCK as f64 * SPACING_M;
        for row in rows[0] / BLOCK..=rows[1] / BLOCK {
            for column in columns[0] / BLOCK..=columns[1] / BLOCK {
                let [x, y] = view.plan_m(column * BLOCK, row * BLOCK);
                let block = self.grid.block(column, row);
                let under_m = larger(self.centre_m[2] - f64::from(block.top_m), 0.0);
                // The ball cuts this deep a plane in a disc; only cells under the disc matter.
                let disc2 = self.reach_m2 - under_m * under_m;
                if gap2(x, side_m) + gap2(y, side_m) <= disc2 {
                    let disc_m = disc2.sqrt();
                    let below_m = [under_m, self.reach_m];
                    let window = |axis: usize, block: usize, rise: [f32; 2]| {
                        let [low_m, high_m] = feet_m(rise, below_m);
                        let [low, high] = view.cells[axis];
                        let block = [low.max(block * BLOCK), high.min(block * BLOCK + BLOCK - 1)];
                        view.cells_within(axis, block, [larger(low_m, -disc_m), high_m.min(disc_m)])
                    };
                    let columns = window(0, column, block.rise_x);
                    let rows = window(1, row, block.rise_y);
                    if let (Some(columns), Some(rows)) = (columns, rows) {
                        self.cells(view, [columns, rows]);
                    }
                }
            }
        }
    }

    fn cells(&mut self, view: &View<'_>, [columns, rows]: [[usize; 2]; 2]) {
        for row in rows[0]..=rows[1] {
            for column in columns[0]..=columns[1] {
                let cell = view.cell(column, row, self.centre_m[2]);
                let top =
                    larger(larger(cell.corner, cell.right), larger(cell.above, cell.opposite));
                let under2 = if top < 0.0 { top * top } else { 0.0 };
                if gap2(cell.x, SPACING_M) + gap2(cell.y, SPACING_M) + under2 <= self.reach_m2 {
                    self.triangles(cell);
                    self.edges_and_corner(view, cell, row * view.stride + column);
                }
            }
        }
    }

    /// The feet of the perpendiculars on the two triangles of a cell.
    fn triangles(&mut self, cell: Cell) {
        let Cell { x, y, corner, right, above, opposite } = cell;
        let mut triangle = |rise_x: f64, rise_y: f64, low: bool| {
            let (a, b) = (rise_x * PER_M, rise_y * PER_M);
            // Over the plane, and the square of its normal (-a, -b, 1); the foot is
            // (a, b, -1) over / normal2.
            let (over, normal2) = (a * x + b * y - corner, a * a + b * b + 1.0);
            let (slack, side) = (SLACK_M2 * normal2, SPACING_M * normal2);
            let (from, to) = (-slack, side + slack);
            let u = a * over - x * normal2;
            if !(from <= u && u <= to) {
                return;
            }
            let v = b * over - y * normal2;
            let half = if low { v <= u + slack } else { u <= v + slack };
            if over > 0.0 && half && from <= v && v <= to {
                let share = over / normal2;
                self.keep([a * share, b * share, -share]);
            }
        };
        triangle(right - corner, opposite - right, true);
        triangle(opposite - above, above - corner, false);
    }

    /// The three edges that leave the low corner of a cell upward, and the corner itself.
    fn edges_and_corner(&mut self, view: &View<'_>, cell: Cell, index: usize) {
        let Cell { x, y, corner, right, above, opposite } = cell;
        let z = self.centre_m[2];
        let height = |index: usize| f64::from(view.height_m[index]) - z;
        // How the distance (squared, halved) grows per whole edge, at the corner.
        let grows_right = SPACING_M * x + corner * (right - corner);
        let grows_above = SPACING_M * y + corner * (above - corner);
        let grows_opposite = SPACING_M * (x + y) + corner * (opposite - corner);
        if let Some(foot) = on_edge([x, y, corner], [SPACING_M, 0.0, right - corner], grows_right) {
            let below = [x, y - SPACING_M, height(index - view.stride)];
            self.keep_between(foot, [x + SPACING_M, y + SPACING_M, opposite], below);
        }
        if let Some(foot) = on_edge([x, y, corner], [0.0, SPACING_M, above - corner], grows_above) {
            let left = [x - SPACING_M, y, height(index - 1)];
            self.keep_between(foot, [x + SPACING_M, y + SPACING_M, opposite], left);
        }
        let diagonal = [SPACING_M, SPACING_M, opposite - corner];
        if let Some(foot) = on_edge([x, y, corner], diagonal, grows_opposite) {
            self.keep_between(foot, [x + SPACING_M, y, right], [x, y + SPACING_M, above]);
        }
        if grows_right.min(grows_above).min(grows_opposite) >= -SLACK_M2 {
            let left = corner * (height(index - 1) - corner) - SPACING_M * x;
            let below = corner * (height(index - view.stride) - corner) - SPACING_M * y;
            let behind = corner * (height(index - view.stride - 1) - corner) - SPACING_M * (x + y);
            if left.min(below).min(behind) >= -SLACK_M2 {
                self.keep([x, y, corner]);
            }
        }
    }

    /// Keeps the foot on an edge if the distance grows toward the third corners on both sides.
    fn keep_between(&mut self, foot: [f64; 3], one: [f64; 3], other: [f64; 3]) {
        let grows = |third: [f64; 3]| {
            let along: f64 = (0..3).map(|axis| foot[axis] * (third[axis] - foot[axis])).sum();
            along >= -SLACK_M2
        };
        if grows(one) && grows(other) {
            self.keep(foot);
        }
    }

    /// Keeps a local minimum, given from the centre, unless it is out of reach or is the underside
    /// of ground that rises beside the ball.
    fn keep(&mut self, foot: [f64; 3]) {
        let distance_m2: f64 = foot.iter().map(|m| m * m).sum();
        if distance_m2 <= self.reach_m2 && foot[2] < 0.0 {
            let point_m = std::array::from_fn(|axis| self.centre_m[axis] + foot[axis]);
            (self.keep)(Nearest { point_m, distance_m: distance_m2.sqrt() });
        }
    }
}

/// The square of how far zero lies from the stretch of `side` from `low` on.
fn gap2(low: f64, side: f64) -> f64 {
    let gap = larger(larger(low, -low - side), 0.0);
    gap * gap
}

/// The larger of two finite numbers: one instruction, where `f64::max` minds NaN as well.
fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// How far aside of the centre a minimum on triangles with this rise along an axis can lie, m, if it
/// lies `below_m` (from and to) below: the line to it leans as some of the triangles that it is on.
#[inline]
fn feet_m(rise: [f32; 2], below_m: [f64; 2]) -> [f64; 2] {
    let [low, high] = rise.map(f64::from);
    let [near, far] = below_m;
    let least = low * if low < 0.0 { far } else { near };
    let most = high * if high < 0.0 { near } else { far };
    [least - SLACK_M, most + SLACK_M]
}

/// The foot of the perpendicular on an edge from `corner` along `along`, if it lies within; `grows`
/// is their product.
#[inline]
fn on_edge(corner: [f64; 3], along: [f64; 3], grows: f64) -> Option<[f64; 3]> {
    if grows > 0.0 {
        return None;
    }
    let length_m2 = along.iter().map(|m| m * m).sum();
    if -grows > length_m2 {
        return None;
    }
    let share = -grows / length_m2;
    Some(std::array::from_fn(|axis| corner[axis] + share * along[axis]))
}

impl View<'_> {
    /// Where a point lies from the centre, m.
    #[allow(clippy::cast_precision_loss)]
    fn plan_m(&self, column: usize, row: usize) -> [f64; 2] {
        let [x0, y0] = self.first_m;
        [x0 + column as f64 * SPACING_M, y0 + row as f64 * SPACING_M]
    }

    /// Those of the cells `from` to `to` along an axis that have a part in a stretch from the centre.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, clippy::cast_possible_wrap)]
    #[inline]
    fn cells_within(&self, axis: usize, [from, to]: [usize; 2], m: [f64; 2]) -> Option<[usize; 2]> {
        let at = |m: f64| floor((m - self.first_m[axis]) * PER_M);
        let (low, high) = (at(m[0]).max(from as i64), at(m[1]).min(to as i64));
        (low <= high).then_some([low as usize, high as usize])
    }

    #[inline]
    fn cell(&self, column: usize, row: usize, z: f64) -> Cell {
        let [x, y] = self.plan_m(column, row);
        let index = row * self.stride + column;
        let low = &self.height_m[index..index + 2];
        let high = &self.height_m[index + self.stride..index + self.stride + 2];
        let [corner, right, above, opposite] =
            [low[0], low[1], high[0], high[1]].map(|height| f64::from(height) - z);
        Cell { x, y, corner, right, above, opposite }
    }
}
