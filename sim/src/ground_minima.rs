//! Where a ball touches the ground: local minima of the distance from its centre, at most four.
//!
//! The engine's own height field meets each wheel with some 450 triangles. A ball touches ground
//! only where its distance has a local minimum, so we look for those among the grid points below
//! it and refine each on the triangles around.

use rapier3d::math::{Real, Vector};

use crate::Terrain;
use crate::terrain::{Grid, SPACING_M};

/// Most contacts of one wheel.
const CONTACTS_MAX: usize = 4;
/// Nearer than this two minima are one, m.
const SAME_POINT_M: Real = 0.05;

/// A point of the ground nearest to a ball's centre.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Nearest {
    pub(crate) point: Vector,
    pub(crate) distance_m: Real,
}

/// The points of `terrain` nearest to `centre`, none further than `reach_m`, and how many.
pub(crate) fn nearest(
    terrain: &Terrain,
    centre: Vector,
    reach_m: Real,
) -> ([Nearest; CONTACTS_MAX], usize) {
    let mut found = Minima::default();
    match terrain {
        Terrain::Flat => {
            let point = Vector::new(centre.x, centre.y, 0.0);
            found.insert(Nearest { point, distance_m: centre.z }, reach_m);
        }
        Terrain::Grid(grid) => grid_minima(grid, centre, reach_m, &mut found),
    }
    (found.points, found.count)
}

struct Minima {
    points: [Nearest; CONTACTS_MAX],
    count: usize,
}

impl Default for Minima {
    fn default() -> Self {
        let none = Nearest { point: Vector::ZERO, distance_m: Real::MAX };
        Self { points: [none; CONTACTS_MAX], count: 0 }
    }
}

impl Minima {
    /// Keeps the nearest four; of two that all but coincide, the nearer.
    fn insert(&mut self, new: Nearest, reach_m: Real) {
        if new.distance_m > reach_m {
            return;
        }
        for old in &mut self.points[..self.count] {
            if (old.point - new.point).length() < SAME_POINT_M {
                if new.distance_m < old.distance_m {
                    *old = new;
                }
                return;
            }
        }
        if self.count < CONTACTS_MAX {
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

#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, clippy::cast_precision_loss)]
fn grid_minima(grid: &Grid, centre: Vector, reach_m: Real, found: &mut Minima) {
    let spacing = SPACING_M as Real;
    let [columns, rows] = grid.size();
    let [x0, y0] = grid.origin_m().map(|m| m as Real);
    let span = |c: Real, o: Real, n: usize| {
        let low = ((c - reach_m - o) / spacing).floor().max(1.0) as usize;
        let high = ((c + reach_m - o) / spacing).ceil().max(0.0) as usize;
        (low, high.min(n.saturating_sub(2)))
    };
    let (c_low, c_high) = span(centre.x, x0, columns);
    let (r_low, r_high) = span(centre.y, y0, rows);
    let beyond = |c: Real, o: Real, n: usize| c < o || c > o + (n - 1) as Real * spacing;
    if beyond(centre.x, x0, columns) || beyond(centre.y, y0, rows) {
        let point = Vector::new(centre.x, centre.y, 0.0);
        found.insert(Nearest { point, distance_m: centre.z }, reach_m);
        return;
    }
    let vertex = |c: usize, r: usize| {
        Vector::new(x0 + c as Real * spacing, y0 + r as Real * spacing, grid.vertex_m(c, r))
    };
    let squared = |c: usize, r: usize| (vertex(c, r) - centre).length_squared();
    for r in r_low..=r_high {
        for c in c_low..=c_high {
            let own = squared(c, r);
            if own > (reach_m + spacing) * (reach_m + spacing) {
                continue;
            }
            // A tie goes to the later point, so exactly one of equals survives.
            let lowest = own <= squared(c - 1, r)
                && own < squared(c + 1, r)
                && own <= squared(c, r - 1)
                && own < squared(c, r + 1)
                && own <= squared(c - 1, r - 1)
                && own < squared(c + 1, r + 1);
            if lowest {
                found.insert(refine(&vertex, c, r, centre), reach_m);
            }
        }
    }
}

/// Nearest point on the six triangles that share grid point (`c`, `r`).
fn refine(vertex: &impl Fn(usize, usize) -> Vector, c: usize, r: usize, centre: Vector) -> Nearest {
    let ring = [(c + 1, r), (c + 1, r + 1), (c, r + 1), (c - 1, r), (c - 1, r - 1), (c, r - 1)];
    let apex = vertex(c, r);
    let mut best = Nearest { point: apex, distance_m: Real::MAX };
    for i in 0..6 {
        let (a, b) = (ring[i], ring[(i + 1) % 6]);
        let (a, b) = (vertex(a.0, a.1), vertex(b.0, b.1));
        let point = nearest_on_triangle(centre, apex, a, b);
        let above = (centre - point).dot((a - apex).cross(b - apex)) >= 0.0;
        let distance = (centre - point).length();
        let distance_m = if above { distance } else { -distance };
        if distance_m < best.distance_m {
            best = Nearest { point, distance_m };
        }
    }
    best
}

/// Nearest point of triangle `a b c` to `p`, by Voronoi regions (Ericson, Real-Time Collision
/// Detection, section 5.1.5).
fn nearest_on_triangle(p: Vector, a: Vector, b: Vector, c: Vector) -> Vector {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let (d1, d2) = (ab.dot(ap), ac.dot(ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return a;
    }
    let bp = p - b;
    let (d3, d4) = (ab.dot(bp), ac.dot(bp));
    if d3 >= 0.0 && d4 <= d3 {
        return b;
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return a + ab * (d1 / (d1 - d3));
    }
    let cp = p - c;
    let (d5, d6) = (ab.dot(cp), ac.dot(cp));
    if d6 >= 0.0 && d5 <= d6 {
        return c;
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return a + ac * (d2 / (d2 - d6));
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 {
        return b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
    }
    let denominator = 1.0 / (va + vb + vc);
    a + ab * (vb * denominator) + ac * (vc * denominator)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// The distance to the grid by looking at every triangle.
    fn by_brute_force(grid: &Grid, centre: Vector) -> Real {
        let [columns, rows] = grid.size();
        let [x0, y0] = grid.origin_m().map(|m| m as Real);
        let vertex = |c: usize, r: usize| {
            let (x, y) = (c as Real * SPACING_M as Real, r as Real * SPACING_M as Real);
            Vector::new(x0 + x, y0 + y, grid.vertex_m(c, r))
        };
        let mut best = Real::MAX;
        for r in 0..rows - 1 {
            for c in 0..columns - 1 {
                let (a, d) = (vertex(c, r), vertex(c + 1, r + 1));
                for b in [vertex(c + 1, r), vertex(c, r + 1)] {
                    best = best.min((centre - nearest_on_triangle(centre, a, b, d)).length());
                }
            }
        }
        best
    }

    proptest! {
        #[test]
        fn the_nearest_point_is_found_on_rough_ground(
            phase in 0.0..6.3_f64,
            rough_m in 0.0..0.15_f64,
            x in -0.4..0.4_f32,
            y in -0.4..0.4_f32,
        ) {
            let grid = Grid::from_fn([-1.5, -1.5], [1.5, 1.5], |x, y| {
                rough_m * ((3.0 * x + phase).sin() * (4.0 * y - phase).cos())
            });
            let centre = Vector::new(x, y, 0.74 + 0.1);
            let mut found = Minima::default();
            grid_minima(&grid, centre, 1.0, &mut found);
            let nearest = found.points[..found.count].iter().map(|n| n.distance_m);
            let nearest = nearest.fold(Real::MAX, Real::min);
            prop_assert!(found.count >= 1);
            prop_assert!((nearest - by_brute_force(&grid, centre)).abs() < 2e-3);
        }
    }

    #[test]
    fn flat_grid_and_plane_agree() {
        let grid = Grid::from_fn([-2.0, -2.0], [2.0, 2.0], |_, _| 0.0);
        for centre in [Vector::new(0.03, 0.07, 0.7), Vector::new(-0.5, 0.25, 0.74)] {
            let mut found = Minima::default();
            grid_minima(&grid, centre, 0.8, &mut found);
            assert_eq!(found.count, 1);
            assert!((found.points[0].distance_m - centre.z).abs() < 1e-6);
        }
    }
}
