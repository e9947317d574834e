//! Where a ball touches the ground: local minima of the distance from its centre, at most four.
//!
//! The distance to a surface of triangles has a local minimum at a corner if it grows along every
//! edge that leaves it, on an edge if it grows into both triangles beside it, in a triangle if the
//! foot of the perpendicular lies in it. These conditions are exact, and each is a dot product or
//! two. Blocks and cells of the grid that lie too deep for the ball are passed over by their top.

use crate::grid::{BLOCK, SPACING_M};
use crate::{Grid, Terrain};

/// Most contacts of one ball.
const POINTS_MAX: usize = 4;
/// Nearer than this two minima are one, m.
const SAME_POINT_M: f64 = 0.05;
/// Slack of the conditions, m²: on the border between two features, both may hold, never neither.
const SLACK_M2: f64 = 1e-12;

type Vector = [f64; 3];

/// A point of the ground nearest to a ball's centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    /// Where it is, m.
    pub point_m: [f64; 3],
    /// Its distance from the centre, m; negative if the centre is under ground.
    pub distance_m: f64,
}

/// The points of the ground nearest to a ball's centre.
#[derive(Clone, Copy, Debug)]
pub struct Minima {
    points: [Nearest; POINTS_MAX],
    count: usize,
}

impl Minima {
    const NONE: Self = Self {
        points: [Nearest { point_m: [0.0; 3], distance_m: f64::MAX }; POINTS_MAX],
        count: 0,
    };

    /// The points, at most four, in no order that means anything.
    #[must_use]
    pub fn points(&self) -> &[Nearest] {
        &self.points[..self.count]
    }

    /// Keeps the nearest four; of two that all but coincide, the nearer.
    fn insert(&mut self, new: Nearest) {
        for old in &mut self.points[..self.count] {
            let apart = sub(old.point_m, new.point_m);
            if dot(apart, apart) < SAME_POINT_M * SAME_POINT_M {
                if new.distance_m < old.distance_m {
                    *old = new;
                }
                return;
            }
        }
        if self.count < POINTS_MAX {
            self.points[self.count] = new;
            self.count += 1;
        } else if let Some(worst) =
            self.points.iter_mut().max_by(|a, b| a.distance_m.total_cmp(&b.distance_m))
            && new.distance_m < worst.distance_m
        {
            *worst = new;
        }
    }
}

impl Terrain {
    /// The points of the ground nearest to `centre_m`, none further than `reach_m`.
    ///
    /// A centre under ground has one: straight above it.
    #[must_use]
    pub fn nearest(&self, centre_m: [f64; 3], reach_m: f64) -> Minima {
        let mut found = Minima::NONE;
        let [x, y, z] = centre_m;
        match self {
            Self::Flat => {
                if z <= reach_m {
                    found.insert(Nearest { point_m: [x, y, 0.0], distance_m: z });
                }
            }
            Self::Plane(plane) => {
                let nearest = plane.nearest(centre_m);
                if nearest.distance_m <= reach_m {
                    found.insert(nearest);
                }
            }
            Self::Grid(grid) => {
                let ground_m = grid.height_m(x, y);
                if z > ground_m {
                    Search { grid, centre_m, reach_m, found: &mut found }.blocks();
                } else {
                    let point_m = [x, y, ground_m];
                    found.insert(Nearest { point_m, distance_m: z - ground_m });
                }
            }
        }
        found
    }
}

/// One search of a grid around a centre above its ground.
struct Search<'a> {
    grid: &'a Grid,
    centre_m: Vector,
    reach_m: f64,
    found: &'a mut Minima,
}

impl Search<'_> {
    #[allow(clippy::cast_possible_wrap)]
    fn blocks(&mut self) {
        let block = BLOCK as i64;
        let [x, y, z] = self.centre_m;
        let [low_c, low_r] = self.grid.cell(x - self.reach_m, y - self.reach_m);
        let [high_c, high_r] = self.grid.cell(x + self.reach_m, y + self.reach_m);
        for block_r in low_r.div_euclid(block)..=high_r.div_euclid(block) {
            for block_c in low_c.div_euclid(block)..=high_c.div_euclid(block) {
                let top_m = self.grid.block_top_m([block_c, block_r]).map_or(z, f64::from);
                let first = [block_c * block, block_r * block];
                if self.reaches(first, BLOCK, top_m) {
                    let columns = first[0].max(low_c)..=(first[0] + block - 1).min(high_c);
                    let rows = first[1].max(low_r)..=(first[1] + block - 1).min(high_r);
                    for row in rows {
                        for column in columns.clone() {
                            self.cell(column, row);
                        }
                    }
                }
            }
        }
    }

    /// Whether the ball can reach into a square of `cells` by `cells` no higher than `top_m`.
    #[allow(clippy::cast_precision_loss)]
    fn reaches(&self, first: [i64; 2], cells: usize, top_m: f64) -> bool {
        let [low_x, low_y] = self.grid.plan_m(first[0], first[1]);
        let side_m = cells as f64 * SPACING_M;
        let gap = |c: f64, low: f64| (low - c).max(c - low - side_m).max(0.0);
        let (dx, dy) = (gap(self.centre_m[0], low_x), gap(self.centre_m[1], low_y));
        let dz = (self.centre_m[2] - top_m).max(0.0);
        dx * dx + dy * dy + dz * dz <= self.reach_m * self.reach_m
    }

    /// Grid point (`column`, `row`) from the centre, m.
    fn from_centre(&self, column: i64, row: i64) -> Vector {
        sub(self.grid.point_m(column, row), self.centre_m)
    }

    /// Looks at one cell: its low corner, the three edges that leave it, its two triangles.
    fn cell(&mut self, column: i64, row: i64) {
        let corner = self.from_centre(column, row);
        let right = self.from_centre(column + 1, row);
        let above = self.from_centre(column, row + 1);
        let opposite = self.from_centre(column + 1, row + 1);
        let top_m = corner[2].max(right[2]).max(above[2].max(opposite[2])) + self.centre_m[2];
        if !self.reaches([column, row], 1, top_m) {
            return;
        }
        self.triangle(corner, right[2] - corner[2], opposite[2] - right[2], |u, v| u >= v);
        self.triangle(corner, opposite[2] - above[2], above[2] - corner[2], |u, v| u <= v);
        self.edge(corner, opposite, || [right, above]);
        let below = self.from_centre(column, row - 1);
        let left = self.from_centre(column - 1, row);
        self.edge(corner, right, || [opposite, below]);
        self.edge(corner, above, || [opposite, left]);
        let behind = self.from_centre(column - 1, row - 1);
        let grows = |end| dot(corner, sub(end, corner)) >= -SLACK_M2;
        if [right, above, opposite, left, below, behind].into_iter().all(grows) {
            self.keep(corner);
        }
    }

    /// A triangle that rises by `rise_x` and `rise_y` m along its cell; `inside` says which half of
    /// the cell it is, of shares of the cell.
    fn triangle(
        &mut self,
        corner: Vector,
        rise_x: f64,
        rise_y: f64,
        inside: impl Fn(f64, f64) -> bool,
    ) {
        let normal = [-rise_x / SPACING_M, -rise_y / SPACING_M, 1.0];
        let above = -dot(corner, normal);
        if above <= 0.0 {
            return;
        }
        let share = above / dot(normal, normal);
        let foot = normal.map(|n| -n * share);
        let (u, v) = ((foot[0] - corner[0]) / SPACING_M, (foot[1] - corner[1]) / SPACING_M);
        let cell = -SLACK_M2..=1.0 + SLACK_M2;
        if cell.contains(&u) && cell.contains(&v) && inside(u, v) {
            self.keep(foot);
        }
    }

    /// An edge from `a` to `b` between two triangles, whose third corners are `beside`.
    fn edge(&mut self, a: Vector, b: Vector, beside: impl Fn() -> [Vector; 2]) {
        let along = sub(b, a);
        let (reached, length_m2) = (-dot(a, along), dot(along, along));
        if !(0.0..=length_m2).contains(&reached) {
            return;
        }
        let share = reached / length_m2;
        let foot = [a[0] + share * along[0], a[1] + share * along[1], a[2] + share * along[2]];
        if beside().into_iter().all(|third| dot(foot, sub(third, foot)) >= -SLACK_M2) {
            self.keep(foot);
        }
    }

    /// Keeps a local minimum, given from the centre, unless it is out of reach or is the underside
    /// of ground that rises beside the ball.
    fn keep(&mut self, foot: Vector) {
        let distance_m = dot(foot, foot).sqrt();
        if distance_m <= self.reach_m && foot[2] < 0.0 {
            let [x, y, z] = self.centre_m;
            let point_m = [x + foot[0], y + foot[1], z + foot[2]];
            self.found.insert(Nearest { point_m, distance_m });
        }
    }
}

fn sub(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
