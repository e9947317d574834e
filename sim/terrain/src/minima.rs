//! Where a ball touches the ground: local minima of the distance from its centre, at most four.
//!
//! The engine's own height fields meet each wheel with hundreds of triangles. A ball touches ground
//! only where its distance has a local minimum, so we look for those and for nothing else.

use crate::Terrain;
use crate::search::Search;

/// Most contacts of one ball.
const POINTS_MAX: usize = 4;
/// A centre further from the origin than this, along any axis, is no place, m.
const FAR_M: f64 = 1e6;
/// The largest ball that is asked about, m: bounds the cells of one search.
const REACH_MAX_M: f64 = 100.0;
/// Nearer than this two minima are one, m.
const SAME_POINT_M: f64 = 0.05;
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
    pub(crate) fn insert(&mut self, new: Nearest) {
        for old in &mut self.points[..self.count] {
            let [x, y, z] = std::array::from_fn(|axis| old.point_m[axis] - new.point_m[axis]);
            if x * x + y * y + z * z < SAME_POINT_M * SAME_POINT_M {
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
    /// A centre under ground has one: straight above it. A centre that is not within 1000 km of the
    /// origin has none, as one that is no number; a reach counts up to 100 m.
    #[must_use]
    pub fn nearest(&self, centre_m: [f64; 3], reach_m: f64) -> Minima {
        let mut found = Minima::NONE;
        self.each_minimum(centre_m, reach_m, |nearest| found.insert(nearest));
        found
    }

    /// Calls `keep` with every local minimum of the distance from `centre_m` to the ground that is no
    /// further than `reach_m`, however near to one another. A minimum on the border of two triangles
    /// may come twice.
    pub fn each_minimum(&self, centre_m: [f64; 3], reach_m: f64, mut keep: impl FnMut(Nearest)) {
        let [x, y, z] = centre_m;
        if !centre_m.iter().all(|m| m.abs() <= FAR_M) {
            return;
        }
        let reach_m = reach_m.min(REACH_MAX_M);
        match self {
            Self::Flat => {
                if z <= reach_m {
                    keep(Nearest { point_m: [x, y, 0.0], distance_m: z });
                }
            }
            Self::Plane(plane) => {
                let nearest = plane.nearest(centre_m);
                if nearest.distance_m <= reach_m {
                    keep(nearest);
                }
            }
            Self::Grid(grid) => {
                let ground_m = grid.height_m(x, y);
                if z > ground_m && reach_m >= 0.0 {
                    Search::new(grid, centre_m, reach_m, keep).run();
                } else if z - ground_m <= reach_m {
                    let point_m = [x, y, ground_m];
                    keep(Nearest { point_m, distance_m: z - ground_m });
                }
            }
        }
    }
}
