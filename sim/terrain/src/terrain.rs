//! Ground that the wheels stand on: a plane without end, or a grid of triangles.

use std::sync::Arc;

use crate::{Grid, Nearest, Ramp};

/// Ground that the wheels stand on. Cheap to clone and to send to threads: heights are shared.
///
/// World axes: x east (the machine's heading at the start), y north, z up; the front axle starts
/// above the origin.
#[derive(Clone, Debug, PartialEq)]
pub enum Terrain {
    /// Level at height zero, without end.
    Flat,
    /// A plane without end.
    Plane(Plane),
    /// Triangles on a grid, going on beyond its edge at the height of the edge.
    Grid(Arc<Grid>),
}

/// A plane, by its height above the origin and how it rises.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Plane {
    /// Height above the origin, m.
    pub height_m: f64,
    /// Rise per metre along x and along y.
    pub rise: [f64; 2],
}

impl Plane {
    /// Height at a point, m.
    #[must_use]
    pub fn at_m(&self, x_m: f64, y_m: f64) -> f64 {
        self.height_m + self.rise[0] * x_m + self.rise[1] * y_m
    }

    /// The point of the plane nearest to `centre_m`.
    pub(crate) fn nearest(&self, [x, y, z]: [f64; 3]) -> Nearest {
        let normal = [-self.rise[0], -self.rise[1], 1.0];
        let length2 = normal.iter().map(|n| n * n).sum::<f64>();
        let above = z - self.at_m(x, y);
        let share = above / length2;
        let point_m = [x - normal[0] * share, y - normal[1] * share, z - share];
        Nearest { point_m, distance_m: above / length2.sqrt() }
    }

    /// The plane of least squared height error through points; level if they do not span one.
    ///
    /// What to lay a machine on: points are its wheels' places and the heights of ground there.
    #[must_use]
    #[allow(clippy::cast_precision_loss)]
    pub fn through(points_m: &[[f64; 3]]) -> Self {
        let Some(first) = points_m.first() else {
            return Self::default();
        };
        // From the first point on, so that equal heights make exactly level ground.
        let count = points_m.len() as f64;
        let mean = |axis: usize| {
            first[axis] + points_m.iter().map(|p| p[axis] - first[axis]).sum::<f64>() / count
        };
        let [x, y, z] = [mean(0), mean(1), mean(2)];
        let moment = |a: usize, b: usize| {
            let centre = [x, y, z];
            points_m.iter().map(|p| (p[a] - centre[a]) * (p[b] - centre[b])).sum::<f64>()
        };
        let (xx, xy, yy) = (moment(0, 0), moment(0, 1), moment(1, 1));
        let (xz, yz) = (moment(0, 2), moment(1, 2));
        let determinant = xx * yy - xy * xy;
        let rise = if determinant.abs() > 1e-9 {
            [(xz * yy - yz * xy) / determinant, (yz * xx - xz * xy) / determinant]
        } else {
            [0.0; 2]
        };
        Self { height_m: z - rise[0] * x - rise[1] * y, rise }
    }
}

impl Terrain {
    /// Level ground with one ramp.
    #[must_use]
    pub fn ramp(ramp: &Ramp) -> Self {
        Self::Grid(Arc::new(Grid::from_fn(crate::Extent::default(), |x, y| ramp.height_m(x, y))))
    }

    /// Height at a point, m.
    #[must_use]
    pub fn height_m(&self, x_m: f64, y_m: f64) -> f64 {
        match self {
            Self::Flat => 0.0,
            Self::Plane(plane) => plane.at_m(x_m, y_m),
            Self::Grid(grid) => grid.height_m(x_m, y_m),
        }
    }

    /// Height at which the centre of a ball over a point rests on the ground, m.
    ///
    /// Lowered from above, the ball halts at the first point that it touches, which on rough ground
    /// is seldom the one below its centre.
    #[must_use]
    pub fn rest_m(&self, x_m: f64, y_m: f64, radius_m: f64) -> f64 {
        if let Self::Plane(plane) = self {
            let [a, b] = plane.rise;
            return plane.at_m(x_m, y_m) + radius_m * (1.0 + a * a + b * b).sqrt();
        }
        let mut z_m = self.height_m(x_m, y_m) + radius_m;
        // Each pass lifts the ball clear of what it cuts deepest. Ground within a radius is finite,
        // so this ends; by far most ground needs three passes.
        for _ in 0..64 {
            let minima = self.nearest([x_m, y_m, z_m], radius_m);
            let lift = |nearest: &Nearest| {
                let [px, py, pz] = nearest.point_m;
                let plan2 = (px - x_m).powi(2) + (py - y_m).powi(2);
                pz + (radius_m * radius_m - plan2).max(0.0).sqrt() - z_m
            };
            let lift_m = minima.points().iter().map(lift).fold(0.0, f64::max);
            if lift_m < 1e-7 {
                break;
            }
            z_m += lift_m;
        }
        z_m
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Extent;

    #[test]
    fn a_terrain_is_shared_between_threads_not_copied() {
        fn shared<T: Send + Sync + Clone>() {}
        shared::<Terrain>();
        assert!(size_of::<Terrain>() <= 32);
    }

    #[test]
    fn a_plane_lies_through_points_that_lie_on_it() {
        let plane = Plane { height_m: 0.3, rise: [0.1, -0.05] };
        let points = [[0.0, 1.0], [0.0, -1.0], [-4.0, 1.0], [-4.0, -1.0]];
        let found = Plane::through(&points.map(|[x, y]| [x, y, plane.at_m(x, y)]));
        assert!((found.height_m - 0.3).abs() < 1e-12);
        assert!((found.rise[0] - 0.1).abs() < 1e-12 && (found.rise[1] + 0.05).abs() < 1e-12);
        assert_eq!(Plane::through(&[[1.0, 1.0, 2.0]]), Plane { height_m: 2.0, rise: [0.0; 2] });
        assert_eq!(Plane::through(&[]), Plane::default());
    }

    #[test]
    fn a_ball_rests_where_it_first_touches() {
        let radius = 0.74;
        let plane = Plane { height_m: 0.0, rise: [0.2, 0.0] };
        let on_plane = radius * 1.04_f64.sqrt();
        assert!((Terrain::Plane(plane).rest_m(0.0, 0.0, radius) - on_plane).abs() < 1e-6);
        let grid = Grid::on_slope(Extent::default(), plane.rise, |x, y| plane.at_m(x, y));
        let rest_m = Terrain::Grid(Arc::new(grid)).rest_m(0.03, 0.0, radius);
        assert!((rest_m - on_plane - 0.006).abs() < 1e-6);
        // A kerb of 0.15 m, its upper edge 0.3 m before the centre.
        let kerb = Grid::from_fn(Extent::default(), |x, _| if x >= 0.3 { 0.15 } else { 0.0 });
        let rest_m = Terrain::Grid(Arc::new(kerb)).rest_m(0.0, 0.05, radius);
        assert!((rest_m - (0.15 + (radius * radius - 0.09).sqrt())).abs() < 1e-6, "{rest_m}");
    }
}
