//! The lowest pass between two local minima of the distance from a point to a grid of triangles.
//!
//! Of all paths on the ground from one minimum to another, take the one whose furthest point is
//! nearest to the centre: that point is their pass. The distance is convex on each triangle, so a
//! path does best to cross an edge at the edge's own nearest point and is lower in between. Passes
//! are therefore exactly those of a graph, triangles joined by edges, each as far as its nearest
//! point; a flood over it finds them. A pass never lies nearer than a minimum it leads from, and
//! moves no further than the centre does (the stability of persistence: Cohen-Steiner, Edelsbrunner
//! and Harer, Stability of Persistence Diagrams, 2007).

use arrayvec::ArrayVec;

use crate::grid::SPACING_M;
use crate::{Grid, Nearest};

/// Cells along a side of the window that a flood stays in: 1.6 m, more than any ball of the vehicle.
const WINDOW: i16 = 16;
/// Most edges that a flood has yet to cross.
const OPEN_MAX: usize = 64;

/// A triangle: its cell in the window and whether it is the one above the cell's diagonal.
#[derive(Clone, Copy, PartialEq, Eq)]
struct Face {
    column: i16,
    row: i16,
    upper: bool,
}

/// An edge at the shore of the flood: the square of its distance, m², and what lies beyond.
#[derive(Clone, Copy)]
struct Shore {
    pass_m2: f64,
    beyond: Face,
}

impl Grid {
    /// Squares of the distances from `centre_m` of the lowest passes from one of its minima to others,
    /// m², into `pass_m2`; infinite where there is none nearer than the root of `limit_m2`.
    pub fn passes_m2(
        &self,
        centre_m: [f64; 3],
        from: &Nearest,
        to: &[Nearest],
        limit_m2: f64,
        pass_m2: &mut [f64],
    ) {
        let mut flood = Flood::new(self, centre_m, from, limit_m2);
        let mut missing = to.len();
        pass_m2[..missing].fill(f64::INFINITY);
        let mut level_m2 = from.distance_m * from.distance_m;
        while missing > 0 {
            let Some(Shore { pass_m2: at_m2, beyond }) = flood.lowest() else { return };
            if !flood.wet(beyond) {
                continue;
            }
            level_m2 = level_m2.max(at_m2);
            for (pass_m2, to) in pass_m2.iter_mut().zip(to) {
                if *pass_m2 == f64::INFINITY && flood.face(to) == beyond {
                    *pass_m2 = level_m2;
                    missing -= 1;
                }
            }
            flood.enter(beyond);
        }
    }
}

/// Ground under water that rises from one triangle.
struct Flood<'a> {
    grid: &'a Grid,
    centre_m: [f64; 3],
    limit_m2: f64,
    /// The window's first cell, and where its low corner lies from the centre in plan, m.
    first: [i64; 2],
    first_m: [f64; 2],
    /// Index of the height of that corner, where the grid has the whole window.
    inside: Option<usize>,
    /// Triangles in the window that are wet or about to be, a bit each.
    seen: [u64; 2 * WINDOW as usize * WINDOW as usize / 64],
    open: ArrayVec<Shore, OPEN_MAX>,
}

impl<'a> Flood<'a> {
    fn new(grid: &'a Grid, centre_m: [f64; 3], source: &Nearest, limit_m2: f64) -> Self {
        let [x, y, _] = source.point_m;
        let first = grid.cell(x, y).map(|cell| cell - i64::from(WINDOW / 2));
        let [x0, y0] = grid.plan_m(first[0], first[1]);
        let mut flood = Self {
            grid,
            centre_m,
            limit_m2,
            first,
            first_m: [x0 - centre_m[0], y0 - centre_m[1]],
            inside: grid.inside(first, WINDOW as usize + 2),
            seen: [0; 2 * WINDOW as usize * WINDOW as usize / 64],
            open: ArrayVec::new(),
        };
        let beyond = flood.face(source);
        flood.open.push(Shore { pass_m2: 0.0, beyond });
        flood
    }

    /// The triangle of a point of the ground.
    #[allow(clippy::cast_possible_truncation)]
    fn face(&self, at: &Nearest) -> Face {
        let [x, y, _] = at.point_m;
        let [column, row] = self.grid.cell(x, y);
        let [x0, y0] = self.grid.plan_m(column, row);
        let in_window = |cell: i64, first: i64| (cell - first).clamp(-1, i64::from(WINDOW)) as i16;
        Face {
            column: in_window(column, self.first[0]),
            row: in_window(row, self.first[1]),
            upper: y - y0 > x - x0,
        }
    }

    /// Takes the lowest place to go on at.
    fn lowest(&mut self) -> Option<Shore> {
        let mut at = 0;
        for (i, shore) in self.open.iter().enumerate() {
            if shore.pass_m2 < self.open[at].pass_m2 {
                at = i;
            }
        }
        self.open.swap_pop(at)
    }

    /// Adds the edges of a triangle to the shore.
    fn enter(&mut self, face: Face) {
        let Face { column: c, row: r, upper } = face;
        let (low, high) = (self.corner(c, r), self.corner(c + 1, r + 1));
        let third = if upper { self.corner(c, r + 1) } else { self.corner(c + 1, r) };
        let beside = |column: i16, row: i16| Face { column, row, upper: !upper };
        let (from_low, from_high) = if upper {
            (beside(c - 1, r), beside(c, r + 1))
        } else {
            (beside(c, r - 1), beside(c + 1, r))
        };
        self.meet([low, high], beside(c, r));
        self.meet([low, third], from_low);
        self.meet([third, high], from_high);
    }

    /// Marks a triangle of the window; false if it was or lies outside.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    fn wet(&mut self, Face { column, row, upper }: Face) -> bool {
        if !(0..WINDOW).contains(&column) || !(0..WINDOW).contains(&row) {
            return false;
        }
        let index = (2 * (row * WINDOW + column) + i16::from(upper)) as usize;
        let (word, bit) = (&mut self.seen[index / 64], 1 << (index % 64));
        let dry = *word & bit == 0;
        *word |= bit;
        dry
    }

    /// Adds an edge to the shore if it is near enough to matter.
    fn meet(&mut self, [a, b]: [[f64; 3]; 2], beyond: Face) {
        let along = [b[0] - a[0], b[1] - a[1], b[2] - a[2]];
        let share = (-dot(a, along) / dot(along, along)).clamp(0.0, 1.0);
        let nearest = [0, 1, 2].map(|axis| a[axis] + share * along[axis]);
        let pass_m2 = dot(nearest, nearest);
        if pass_m2 < self.limit_m2 {
            // No ball of the vehicle has a shore as long as that; an edge beyond is left out.
            let _ = self.open.try_push(Shore { pass_m2, beyond });
        }
    }

    /// A corner from the centre, m.
    #[inline]
    #[allow(clippy::cast_sign_loss)]
    fn corner(&self, column: i16, row: i16) -> [f64; 3] {
        let height_m = match self.inside {
            Some(low) => {
                self.grid.heights_m()[low + row as usize * self.grid.size()[0] + column as usize]
            }
            None => {
                let [c, r] = self.first;
                self.grid.height_beyond_m(c + i64::from(column), r + i64::from(row))
            }
        };
        let plan_m = |axis: usize, steps: i16| self.first_m[axis] + f64::from(steps) * SPACING_M;
        [plan_m(0, column), plan_m(1, row), f64::from(height_m) - self.centre_m[2]]
    }
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Extent, Terrain};

    /// A ditch along y with its bottom at x = 0 between sides of one in two.
    fn ditch() -> Grid {
        let extent = Extent { x_m: [-2.0, 2.0], y_m: [-2.0, 2.0] };
        Grid::from_fn(extent, |x, _| 0.5 * x.abs())
    }

    fn passes(grid: &Grid, centre_m: [f64; 3], limit_m2: f64) -> Vec<f64> {
        let terrain = Terrain::Grid(std::sync::Arc::new(grid.clone()));
        let mut minima = Vec::new();
        terrain.each_minimum(centre_m, 1.0, |nearest| minima.push(nearest));
        assert_eq!(minima.len(), 2, "one on each side");
        let mut pass_m2 = [0.0; 2];
        grid.passes_m2(centre_m, &minima[0], &minima, limit_m2, &mut pass_m2);
        assert!((pass_m2[0] - minima[0].distance_m.powi(2)).abs() < 1e-12, "to itself");
        pass_m2[1..].to_vec()
    }

    #[test]
    fn the_pass_of_a_ditch_is_its_bottom() {
        for centre_m in [[0.0, 0.03, 0.8], [0.1, 0.03, 0.8], [-0.2, -0.31, 0.7]] {
            let [x, _, z] = centre_m;
            let pass_m2 = passes(&ditch(), centre_m, 1.0);
            assert!((pass_m2[0] - (x * x + z * z)).abs() < 1e-12, "{pass_m2:?}");
        }
    }

    #[test]
    fn a_pass_beyond_the_limit_is_none() {
        assert_eq!(passes(&ditch(), [0.0, 0.03, 0.8], 0.63), [f64::INFINITY]);
    }

    #[test]
    fn a_pass_may_lie_aside_of_the_straight_way() {
        // A ridge between two sides, with a gap 0.4 m along it.
        let extent = Extent { x_m: [-2.0, 2.0], y_m: [-2.0, 2.0] };
        let grid = Grid::from_fn(extent, |x, y| {
            let wall = x.abs() < 0.05 && (y - 0.4).abs() > 0.05;
            if wall { -0.2 } else { 0.3 * x.abs() }
        });
        let centre_m = [0.0, 0.0, 0.75];
        let from = Nearest { point_m: [-0.21, 0.01, 0.06], distance_m: 0.71 };
        let to = Nearest { point_m: [0.21, 0.01, 0.06], distance_m: 0.71 };
        let mut pass_m2 = [0.0];
        grid.passes_m2(centre_m, &from, &[to], 2.0, &mut pass_m2);
        // Over the gap: 0.4 m along and 0.75 m down.
        assert!((pass_m2[0] - (0.4_f64.powi(2) + 0.75_f64.powi(2))).abs() < 1e-6, "{pass_m2:?}");
    }
}
