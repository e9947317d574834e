//! Where a ball meets the ground, so that its force varies continuously.
//!
//! The ball touches where its distance to the triangles has a local minimum. In a hollow several
//! such minima coexist, and one comes or goes only by meeting the pass that parts it from a nearer
//! one. So each counts by how far it is from its passes: those without a pass to speak of between
//! them share one contact, and one that is about to slide over its pass has no share left. As the
//! ball rolls through a hollow its contact goes from triangle to triangle without a jump, while in a
//! ditch it rests on both sides with a whole tyre each. Minima and passes move without a jump, and
//! so does the force made of them.

use glam::DVec3;

use crate::Terrain;
use crate::terrain::{Grid, Nearest};

/// Most minima of one ball.
pub(super) const TOUCHES_MAX: usize = 12;
/// How far along the ground from its pass a minimum is a whole contact of its own, m (assumed: three
/// quarters of the grid's spacing).
const SETTLED_M: f64 = 0.075;
/// Keeps a share defined where two minima and their pass are one point: about the rounding of how
/// well they are settled.
const LEAST: f64 = 1.0e-14;

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
    /// Looks where a ball at `centre` is no further from the ground than `reach_m`.
    pub(super) fn find(&mut self, terrain: &Terrain, centre: DVec3, reach_m: f64) {
        self.count = 0;
        let Terrain::Grid(grid) = terrain else {
            terrain.each_minimum(centre.to_array(), reach_m, |at| self.insert(centre, &at));
            return;
        };
        // Those a little beyond may have a share of those within.
        let sharing_m = reach_m.hypot(SETTLED_M);
        terrain.each_minimum(centre.to_array(), sharing_m, |at| self.insert(centre, &at));
        if self.count > 1 {
            self.share(grid, centre);
        }
        self.drop_beyond(reach_m);
    }

    pub(super) fn iter(&self) -> impl Iterator<Item = &Touch> {
        self.all[..self.count].iter()
    }

    fn drop_beyond(&mut self, reach_m: f64) {
        let mut kept = 0;
        for i in 0..self.count {
            if self.all[i].distance_m <= reach_m {
                self.all[kept] = self.all[i];
                kept += 1;
            }
        }
        self.count = kept;
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

    /// Shares contacts among minima that no pass parts.
    fn share(&mut self, grid: &Grid, centre: DVec3) {
        let count = self.count;
        let mut settled = [[1.0; TOUCHES_MAX]; TOUCHES_MAX];
        for i in 0..count {
            self.settle(grid, centre, i, &mut settled);
        }
        // Of two, the one that is about to slide over the pass has nothing left.
        let part = |i: usize, j: usize| {
            let (own, other) = (settled[i][j], settled[j][i]);
            (own + LEAST) / (own + other * (1.0 - own) + 2.0 * LEAST)
        };
        let mut stays = [1.0; TOUCHES_MAX];
        for (i, stays) in stays[..count].iter_mut().enumerate() {
            let others = (0..count).filter(|&j| j != i);
            *stays = others.fold(1.0, |least: f64, j| least.min(part(i, j)));
        }
        for i in 0..count {
            let others = (0..count).filter(|&j| j != i);
            let shared: f64 = others.map(|j| stays[j] * (1.0 - settled[i][j])).sum();
            self.all[i].weight = stays[i] / (stays[i] + shared);
        }
    }

    /// How well minimum `i` and each that is nearer than it are settled on their sides of their pass.
    fn settle(
        &self,
        grid: &Grid,
        centre: DVec3,
        i: usize,
        settled: &mut [[f64; TOUCHES_MAX]; TOUCHES_MAX],
    ) {
        let square = |touch: &Touch| touch.distance_m * touch.distance_m;
        let own = self.all[i];
        let limit_m2 = square(&own) + SETTLED_M * SETTLED_M;
        let mut others = [0; TOUCHES_MAX];
        let mut to = [own.nearest(); TOUCHES_MAX];
        let mut count = 0;
        for (j, other) in self.all[..self.count].iter().enumerate() {
            if (other.distance_m, j) < (own.distance_m, i) {
                (others[count], to[count]) = (j, other.nearest());
                count += 1;
            }
        }
        if count == 0 {
            return;
        }
        let mut pass_m2 = [0.0; TOUCHES_MAX];
        grid.passes_m2(centre.to_array(), &own.nearest(), &to[..count], limit_m2, &mut pass_m2);
        for (&j, &pass_m2) in others[..count].iter().zip(&pass_m2) {
            // By the square of the way to the pass, which leaves and comes without a kink.
            let side = |touch: &Touch| {
                ((pass_m2 - square(touch)) / (SETTLED_M * SETTLED_M)).clamp(0.0, 1.0)
            };
            settled[i][j] = side(&own);
            settled[j][i] = side(&self.all[j]);
        }
    }
}

impl Touch {
    const fn nearest(&self) -> Nearest {
        Nearest { point_m: self.point.to_array(), distance_m: self.distance_m }
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
        let mut touches = Touches::default();
        touches.find(terrain, centre, RADIUS_M);
        touches.iter().map(|t| t.normal * (t.weight * (RADIUS_M - t.distance_m).max(0.0))).sum()
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

    /// The largest change of force over a step of `step_m`, along 0.1 m, and where it begins.
    fn largest_change(
        at: &impl Fn(f64) -> DVec3,
        from_m: f64,
        step_m: f64,
        steps: u32,
    ) -> (f64, f64) {
        let (mut largest, mut before) = ((0.0, from_m), at(from_m));
        for i in 1..=steps {
            let s_m = from_m + f64::from(i) * step_m;
            let after = at(s_m);
            let change = (after - before).length();
            if change > largest.0 {
                largest = (change, s_m - step_m);
            }
            before = after;
        }
        largest
    }

    /// Rolls a ball 0.1 m over rough ground, 1 cm deep at the start, and looks ever closer where its
    /// force changes most: what is left of the change over 0.05 nm.
    fn jump_m([phase, rough_m, x, y, heading]: [f64; 5]) -> f64 {
        let terrain = rough(phase, rough_m);
        let height = terrain.rest_m(x, y, RADIUS_M) - 0.01;
        let at = |s: f64| {
            force(&terrain, DVec3::new(x + s * heading.cos(), y + s * heading.sin(), height))
        };
        let mut step_m = 0.1 / 2_000.0;
        let (mut change_m, mut from_m) = largest_change(&at, 0.0, step_m, 2_000);
        for _ in 0..3 {
            step_m /= 100.0;
            (change_m, from_m) = largest_change(&at, from_m, step_m, 100);
        }
        change_m
    }

    /// Found by the search below: minima that slid further than their shares were handed over, and two
    /// that met within micrometres of a corner.
    #[test]
    fn what_once_jumped_is_continuous() {
        for case in [
            [
                4.891759595907326,
                0.019046848342354792,
                -0.22758385051501787,
                -0.16749443771211564,
                3.255753182506286,
            ],
            [
                0.0,
                0.013440233849817596,
                -0.2646118094068932,
                -0.13898373598020908,
                3.0205130694721367,
            ],
            [
                0.9787448130728538,
                0.014365529628193327,
                0.7439541488837491,
                0.2916814312665073,
                4.3864064511307905,
            ],
            [
                1.8897106160334682,
                0.004855382793697727,
                0.6011621197509533,
                0.03778999266914777,
                3.9103844476673597,
            ],
        ] {
            assert!(jump_m(case) < 1e-7, "{case:?}: {} m", jump_m(case));
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::default())]
        /// Through hollows, over crests and along edges the force has no jump.
        #[test]
        fn the_force_is_continuous(
            phase in 0.0..6.3_f64,
            rough_m in 0.0..0.05_f64,
            x in -0.8..0.8_f64,
            y in -0.8..0.8_f64,
            heading in 0.0..6.3_f64,
        ) {
            let jump_m = jump_m([phase, rough_m, x, y, heading]);
            prop_assert!(jump_m < 1e-7, "{jump_m} m");
        }
    }
}
