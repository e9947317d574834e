//! Where the vehicle stands when it is set down on its ground.

use xt28_machine::PerWheel;
use xt28_terrain::{Stance, Terrain};

use super::Parts;

impl Parts {
    /// How the vehicle, its arms at `stroke_m`, stands on `terrain` with its front axle over the
    /// origin and heading east: as the ground under its wheels slopes, and no lower than lets its
    /// lowest wheel touch. On level ground it is level.
    #[must_use]
    pub fn stance(&self, terrain: &Terrain, stroke_m: PerWheel<f64>) -> Stance {
        Stance::on(terrain, &self.wheel_centres_m(stroke_m).0, self.radius_m, [0.0; 2], 0.0)
    }

    /// Centre of each wheel in the machine's axes, from its origin, m.
    #[must_use]
    pub fn wheel_centres_m(&self, stroke_m: PerWheel<f64>) -> PerWheel<[f64; 3]> {
        PerWheel::from_fn(|wheel| {
            let arm = &self.arms[wheel];
            let (sin, cos) = (arm.extends * self.arm_angle_rad(stroke_m[wheel])).sin_cos();
            let ([px, py, pz], [x, y, z]) = (arm.pivot_m, arm.to_wheel_m);
            [px + x * cos + z * sin, py + y, pz + z * cos - x * sin]
        })
    }
}

#[cfg(test)]
mod tests {
    use xt28_machine::{Machine, Wheel};
    use xt28_terrain::Plane;

    use super::*;
    use crate::{Effects, REFERENCE_STROKE_M};

    fn parts() -> Parts {
        Parts::new(&Machine::xt28(), &Effects::default())
    }

    #[test]
    fn wheels_go_where_the_linkage_says() {
        let (parts, machine) = (parts(), Machine::xt28());
        let reference = machine.linkage().at_stroke(REFERENCE_STROKE_M);
        for stroke_m in [0.0, 0.17, 0.25, 0.5] {
            let pose = machine.linkage().at_stroke(stroke_m);
            for wheel in Wheel::ALL {
                let [x, y, z] = parts.wheel_centres_m(PerWheel::splat(stroke_m))[wheel];
                let drop_m = machine.wheels.radius_m - z;
                assert!((drop_m - (pose.drop_m - reference.drop_m)).abs() < 1e-9, "{wheel}");
                let reach_m = parts.arms[wheel].extends * (x - parts.arms[wheel].pivot_m[0]);
                assert!((reach_m - pose.reach_m).abs() < 1e-9, "{wheel}");
                assert_eq!(y.abs(), 0.5 * machine.wheels.track_m);
            }
        }
    }

    #[test]
    fn it_stands_level_on_the_level_and_along_a_slope() {
        let (parts, stroke_m) = (parts(), PerWheel::splat(0.17));
        let level = parts.stance(&Terrain::Flat, stroke_m);
        assert_eq!(level.axes, [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
        let lowest = |stance: &Stance, above: &dyn Fn([f64; 3]) -> f64| {
            let centres = parts.wheel_centres_m(stroke_m).map(|centre| above(stance.world(centre)));
            centres.0.into_iter().fold(f64::MAX, f64::min)
        };
        assert!((lowest(&level, &|[_, _, z]| z) - parts.radius_m).abs() < 1e-12);
        let plane = Plane { height_m: 0.4, rise: [0.15, -0.05] };
        let slope = parts.stance(&Terrain::Plane(plane), stroke_m);
        let normal = (1.0 + 0.15_f64.powi(2) + 0.05_f64.powi(2)).sqrt();
        let above = |[x, y, z]: [f64; 3]| (z - plane.at_m(x, y)) / normal;
        assert!((lowest(&slope, &above) - parts.radius_m).abs() < 1e-9);
        assert!((slope.axes[0][2] / slope.axes[0][0] - 0.15).abs() < 1e-9);
    }
}
