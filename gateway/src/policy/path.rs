//! A smooth way from one pose to another, to be driven forward.

use crate::Pose;
use crate::pose::wrap;

/// Distance between neighbouring points, m, about.
const SPACING_M: f64 = 0.05;
/// Straight continuation beyond the goal, m: something to follow for a machine that rolls past it.
const RUN_OUT_M: f64 = 3.0;
/// Tangent lengths tried, as a share of the distance. A third gives an arc where one fits.
const TANGENTS: [f64; 8] = [0.34, 0.30, 0.40, 0.50, 0.65, 0.85, 1.1, 1.5];

/// One point of a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Point {
    pub(super) pose: Pose,
    /// Left > 0, 1/m.
    pub(super) curvature_per_m: f64,
    /// Along the path from its start, m.
    pub(super) along_m: f64,
}

/// A cubic Bézier curve from start to goal, and a straight run-out, as points.
#[derive(Clone, Debug)]
pub(super) struct Path {
    points: Vec<Point>,
    /// From start to goal along the path, m.
    length_m: f64,
}

impl Path {
    /// The flattest of the curves tried; `None` when even that is tighter than `curvature_max_per_m`.
    pub(super) fn plan(start: &Pose, goal: &Pose, curvature_max_per_m: f64) -> Option<Self> {
        TANGENTS
            .iter()
            .map(|tangent| Self::bezier(start, goal, *tangent))
            .min_by(|a, b| a.tightest().total_cmp(&b.tightest()))
            .filter(|path| path.tightest() <= curvature_max_per_m)
    }

    pub(super) const fn length_m(&self) -> f64 {
        self.length_m
    }

    /// The point nearest to `pose`, searched within 2 m ahead of `from_m` so that a path that
    /// crosses itself is followed in order.
    pub(super) fn nearest(&self, pose: &Pose, from_m: f64) -> Point {
        let distance =
            |p: &Point| (p.pose.east_m - pose.east_m).hypot(p.pose.north_m - pose.north_m);
        let window = self
            .points
            .iter()
            .skip_while(|p| p.along_m < from_m - 0.5)
            .take_while(|p| p.along_m < from_m + 2.0);
        let nearest = window.min_by(|a, b| distance(a).total_cmp(&distance(b)));
        *nearest.unwrap_or_else(|| self.at(from_m))
    }

    /// Curvature at `along_m`, 1/m; straight outside the path.
    pub(super) fn curvature_per_m(&self, along_m: f64) -> f64 {
        self.at(along_m).curvature_per_m
    }

    fn at(&self, along_m: f64) -> &Point {
        let index = self.points.partition_point(|p| p.along_m < along_m);
        &self.points[index.min(self.points.len() - 1)]
    }

    fn tightest(&self) -> f64 {
        self.points.iter().map(|p| p.curvature_per_m.abs()).fold(0.0, f64::max)
    }

    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, clippy::cast_precision_loss)]
    fn bezier(start: &Pose, goal: &Pose, tangent: f64) -> Self {
        let span_m = (goal.east_m - start.east_m).hypot(goal.north_m - start.north_m);
        let arm_m = tangent * span_m;
        let ahead = |pose: &Pose, by_m: f64| {
            let (sin, cos) = pose.heading_rad.sin_cos();
            [pose.east_m + by_m * cos, pose.north_m + by_m * sin]
        };
        let control =
            [ahead(start, 0.0), ahead(start, arm_m), ahead(goal, -arm_m), ahead(goal, 0.0)];
        let count = ((1.0 + 2.0 * tangent) * span_m / SPACING_M).ceil().max(1.0) as usize;
        let mut points: Vec<Point> = Vec::with_capacity(count + 64);
        for i in 0..=count {
            let mut point = bezier_point(&control, i as f64 / count as f64);
            if let Some(last) = points.last() {
                let (de, dn) =
                    (point.pose.east_m - last.pose.east_m, point.pose.north_m - last.pose.north_m);
                point.along_m = last.along_m + de.hypot(dn);
            }
            points.push(point);
        }
        // With no span the curve has no tangent of its own.
        points[0].pose.heading_rad = start.heading_rad;
        let length_m = points[count].along_m;
        points[count].pose = *goal;
        let run_out = (RUN_OUT_M / SPACING_M) as usize;
        points.extend((1..=run_out).map(|i| {
            let by_m = i as f64 * SPACING_M;
            let [east_m, north_m] = ahead(goal, by_m);
            let pose = Pose { east_m, north_m, heading_rad: wrap(goal.heading_rad) };
            Point { pose, curvature_per_m: 0.0, along_m: length_m + by_m }
        }));
        Self { points, length_m }
    }
}

/// Position, direction and curvature of a cubic Bézier curve at `t`, 0 to 1.
fn bezier_point(control: &[[f64; 2]; 4], t: f64) -> Point {
    let u = 1.0 - t;
    let blend = |w: [f64; 4], axis: usize| (0..4).map(|i| w[i] * control[i][axis]).sum::<f64>();
    let place = [u * u * u, 3.0 * u * u * t, 3.0 * u * t * t, t * t * t];
    let first = [-3.0 * u * u, 3.0 * u * (u - 2.0 * t), 3.0 * t * (2.0 * u - t), 3.0 * t * t];
    let second = [6.0 * u, 6.0 * (t - 2.0 * u), 6.0 * (u - 2.0 * t), 6.0 * t];
    let [x1, y1] = [blend(first, 0), blend(first, 1)];
    let [x2, y2] = [blend(second, 0), blend(second, 1)];
    let speed = x1.hypot(y1);
    let curvature_per_m = if speed > 0.0 { (x1 * y2 - y1 * x2) / speed.powi(3) } else { 0.0 };
    Point {
        pose: Pose { east_m: blend(place, 0), north_m: blend(place, 1), heading_rad: y1.atan2(x1) },
        curvature_per_m,
        along_m: 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn goal(east_m: f64, north_m: f64, heading_deg: f64) -> Pose {
        Pose { east_m, north_m, heading_rad: heading_deg.to_radians() }
    }

    #[test]
    fn an_arc_comes_out_as_one() {
        let path = Path::plan(&Pose::default(), &goal(24.5, 4.98, 23.0), 0.1).unwrap();
        // 25 m of chord over 23 degrees: radius 62.7 m, length 25.17 m.
        assert!((path.length_m() - 25.17).abs() < 0.02, "{}", path.length_m());
        assert!((path.tightest() - 1.0 / 62.7).abs() < 0.002, "{}", path.tightest());
    }

    #[test]
    fn a_goal_beside_the_machine_is_refused() {
        assert!(Path::plan(&Pose::default(), &goal(0.0, 3.0, 0.0), 0.12).is_none());
    }

    #[test]
    fn the_nearest_point_is_the_nearest() {
        let path = Path::plan(&Pose::default(), &goal(25.0, 0.0, 0.0), 0.1).unwrap();
        let point = path.nearest(&goal(10.0, 0.7, 5.0), 9.0);
        assert!((point.along_m - 10.0).abs() < SPACING_M && point.pose.north_m == 0.0);
        assert!((path.nearest(&goal(26.0, 0.0, 0.0), 25.0).along_m - 26.0).abs() < SPACING_M);
    }
}
