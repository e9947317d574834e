//! Where a ball meets the ground, so that its force varies continuously.
//!
//! The ball touches where its distance to the triangles has a local minimum. In a hollow several
//! such minima coexist, and one comes or goes only where it sits on an edge between triangles that
//! rise to both sides. So each counts with a weight that vanishes there, and minima near one another
//! share one contact between them. As the ball rolls through a hollow its contact passes from
//! triangle to triangle without a jump, while in a ditch it rests on both sides with a whole tyre each.

use glam::DVec3;

use crate::Terrain;
use crate::terrain::{Grid, Nearest, SPACING_M};

/// Most minima of one ball.
pub(super) const TOUCHES_MAX: usize = 8;
/// Minima nearer to one another than this are partly one, m.
const SHARING_M: f64 = 0.15;
/// A minimum this much further off than the nearest takes no share of another's contact, m: it may
/// leave the search's reach without a jump.
pub(super) const BAND_M: f64 = 0.005;
/// Least ease, so that a lone foot on the bottom of a ditch carries the ball.
const EASE_MIN: f64 = 1.0e-9;

/// A local minimum of the distance.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Touch {
    pub(super) point: DVec3,
    /// Unit, from the point to the ball's centre.
    pub(super) normal: DVec3,
    /// Negative if the centre is under ground.
    pub(super) distance_m: f64,
    /// Share of a whole contact, 0 to 1.
    pub(super) weight: f64,
}

/// The minima of one ball.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Touches {
    all: [Touch; TOUCHES_MAX],
    count: usize,
}

impl Touches {
    /// Where a ball at `centre` is nearer to the ground than `reach_m`. To be continuous, `reach_m`
    /// is more by [`BAND_M`] than where contacts begin to make force.
    pub(super) fn find(terrain: &Terrain, centre: DVec3, reach_m: f64) -> Self {
        let mut found = Self::default();
        terrain.each_minimum(centre.to_array(), reach_m, |nearest| found.insert(centre, &nearest));
        if let (Terrain::Grid(grid), 2..) = (terrain, found.count) {
            found.share(grid);
        }
        found
    }

    pub(super) fn iter(&self) -> impl Iterator<Item = &Touch> {
        self.all[..self.count].iter()
    }

    /// Keeps the nearest.
    fn insert(&mut self, centre: DVec3, nearest: &Nearest) {
        let (point, distance_m) = (DVec3::from(nearest.point_m), nearest.distance_m);
        let away = (centre - point) * distance_m.signum();
        let normal = away.try_normalize().unwrap_or(DVec3::Z);
        let new = Touch { point, normal, distance_m, weight: 1.0 };
        if self.count < TOUCHES_MAX {
            self.all[self.count] = new;
            self.count += 1;
        } else if let Some(worst) =
            self.all.iter_mut().max_by(|a, b| a.distance_m.total_cmp(&b.distance_m))
            && new.distance_m < worst.distance_m
        {
            *worst = new;
        }
    }

    /// Shares contacts among minima that are near one another.
    fn share(&mut self, grid: &Grid) {
        let all = self.all;
        let all = &all[..self.count];
        let nearest_m = all.iter().map(|t| t.distance_m).fold(f64::MAX, f64::min);
        let mut ease = [0.0; TOUCHES_MAX];
        for (ease, touch) in ease.iter_mut().zip(all) {
            *ease = ease_at(grid, touch.point) + EASE_MIN;
        }
        for (i, touch) in self.all[..all.len()].iter_mut().enumerate() {
            let mut sum = ease[i];
            for (j, other) in all.iter().enumerate().filter(|(j, _)| *j != i) {
                let apart = (other.point - touch.point).length_squared();
                let beside = (1.0 - apart / (SHARING_M * SHARING_M)).max(0.0);
                let further = (other.distance_m - touch.distance_m) / BAND_M;
                let claim = (1.0 - further).clamp(0.0, 1.0) * beside;
                sum += ease[j] * claim * claim;
            }
            // The nearest cannot vanish, for a minimum vanishes by sliding to a nearer one.
            let second = ((touch.distance_m - nearest_m) / BAND_M).min(1.0);
            touch.weight = ease[i] / sum * (1.0 - second * (1.0 - ease[i]).max(0.0));
        }
    }
}

/// How far a point of the ground is from where a minimum can vanish: 0 on edges that rise to both
/// sides and on the corners where these end, 1 well inside a triangle, on another edge or on a peak;
/// continuous.
fn ease_at(grid: &Grid, point: DVec3) -> f64 {
    let lattice = Lattice { grid };
    let ([c, r], [s, t]) = lattice.cell(point);
    // Shares of the corners of the point's triangle, and its edges across from them.
    let (share, corners, across) = if s >= t {
        (
            [1.0 - s, s - t, t],
            [[c, r], [c + 1, r], [c + 1, r + 1]],
            [Edge::Along(c + 1, r), Edge::Diagonal(c, r), Edge::Across(c, r)],
        )
    } else {
        (
            [1.0 - t, t - s, s],
            [[c, r], [c, r + 1], [c + 1, r + 1]],
            [Edge::Across(c, r + 1), Edge::Diagonal(c, r), Edge::Along(c, r)],
        )
    };
    let mut ease = 1.0_f64;
    for i in 0..3 {
        if lattice.rises(across[i]) {
            ease = ease.min(3.0 * share[i]);
        }
        if lattice.meets_rise(corners[i]) {
            ease = ease.min(3.0 * (1.0 - share[i]));
        }
    }
    ease.max(0.0)
}

/// An edge of the grid by its lower end: along y, across it along x, or on a cell's diagonal.
#[derive(Clone, Copy)]
enum Edge {
    Along(i64, i64),
    Across(i64, i64),
    Diagonal(i64, i64),
}

/// A grid as corners and edges.
struct Lattice<'a> {
    grid: &'a Grid,
}

impl Lattice<'_> {
    /// The cell of a point and where in it the point lies, 0 to 1.
    #[allow(clippy::cast_possible_truncation, clippy::cast_precision_loss)]
    fn cell(&self, point: DVec3) -> ([i64; 2], [f64; 2]) {
        let [x0, y0] = self.grid.origin_m();
        let at = [(point.x - x0) / SPACING_M, (point.y - y0) / SPACING_M];
        (at.map(|at| at.floor() as i64), at.map(|at| at - at.floor()))
    }

    /// Whether the ground rises from an edge to both sides: its four points are a parallelogram.
    fn rises(&self, edge: Edge) -> bool {
        let h = |c: i64, r: i64| self.height_m(c, r);
        match edge {
            Edge::Along(c, r) => h(c + 1, r + 1) + h(c - 1, r) > h(c, r) + h(c, r + 1),
            Edge::Across(c, r) => h(c + 1, r + 1) + h(c, r - 1) > h(c, r) + h(c + 1, r),
            Edge::Diagonal(c, r) => h(c + 1, r) + h(c, r + 1) > h(c, r) + h(c + 1, r + 1),
        }
    }

    /// Whether such an edge ends in a corner.
    fn meets_rise(&self, [c, r]: [i64; 2]) -> bool {
        self.rises(Edge::Along(c, r))
            || self.rises(Edge::Along(c, r - 1))
            || self.rises(Edge::Across(c, r))
            || self.rises(Edge::Across(c - 1, r))
            || self.rises(Edge::Diagonal(c, r))
            || self.rises(Edge::Diagonal(c - 1, r - 1))
    }

    /// Beyond the grid the border's: its edges do not matter there.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, clippy::cast_possible_wrap)]
    fn height_m(&self, column: i64, row: i64) -> f64 {
        let [columns, rows] = self.grid.size();
        let column = column.clamp(0, columns as i64 - 1) as usize;
        let row = row.clamp(0, rows as i64 - 1) as usize;
        f64::from(self.grid.heights_m()[row * columns + column])
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use proptest::prelude::*;

    use super::*;
    use crate::terrain::Extent;

    const RADIUS_M: f64 = 0.74;

    fn rough(phase: f64, rough_m: f64) -> Terrain {
        let extent = Extent { x_m: [-2.0, 2.0], y_m: [-2.0, 2.0] };
        Terrain::Grid(Arc::new(Grid::from_fn(extent, |x, y| {
            rough_m
                * ((5.0 * x + phase).sin() * (4.0 * y - phase).cos() + (9.0 * x - 7.0 * y).sin())
        })))
    }

    /// The force that the touches make on a ball with a stiffness of 1.
    fn force(terrain: &Terrain, centre: DVec3) -> DVec3 {
        Touches::find(terrain, centre, RADIUS_M + BAND_M)
            .iter()
            .map(|t| t.normal * (t.weight * (RADIUS_M - t.distance_m).max(0.0)))
            .sum()
    }

    #[test]
    fn level_ground_is_one_whole_contact_wherever_it_is_touched() {
        let terrain = rough(0.0, 0.0);
        for i in 0..1000 {
            let (x, y) = (0.7 * f64::from(i).sin(), 0.6 * f64::from(i * i).cos());
            let up = force(&terrain, DVec3::new(x, y, RADIUS_M - 0.006));
            assert!((up - DVec3::Z * 0.006).length() < 1e-12, "{up}");
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]
        /// Through hollows, over crests and along edges the force has no jump to speak of: its change
        /// over a step shrinks with the step, but for a rare remnant of some hundredths of the force.
        #[test]
        fn the_force_is_continuous(
            phase in 0.0..6.3_f64,
            rough_m in 0.0..0.05_f64,
            x in -0.8..0.8_f64,
            y in -0.8..0.8_f64,
            heading in 0.0..6.3_f64,
        ) {
            let terrain = rough(phase, rough_m);
            let lowest = terrain.rest_m(x, y, RADIUS_M) - 0.01;
            let at = |s: f64| {
                force(&terrain, DVec3::new(x + s * heading.cos(), y + s * heading.sin(), lowest))
            };
            let largest = |steps: u32| {
                let step = 0.1 / f64::from(steps);
                (0..steps).map(|i| {
                    (at(f64::from(i + 1) * step) - at(f64::from(i) * step)).length()
                }).fold(0.0, f64::max)
            };
            let (coarse, fine) = (largest(100), largest(2_000));
            prop_assert!(fine < 0.2 * coarse + 1.0e-3, "{coarse} {fine}");
        }
    }
}
