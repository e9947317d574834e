//! How a machine is set down on the ground: laid on the slope under it, lifted clear of every bump.

use crate::{Plane, Terrain};

/// Where a machine stands: its origin, and its axes in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stance {
    /// The machine's origin, m.
    pub position_m: [f64; 3],
    /// Its axes in the world, one a row: forward, left, up.
    pub axes: [[f64; 3]; 3],
}

impl Stance {
    /// A machine with round wheels of `radius_m` at `wheels_m` (centres from its origin, in its own
    /// axes), its origin over `at_m`, heading `heading_rad` counter-clockwise from x.
    ///
    /// Its up is the normal of the plane through the ground under its wheels. It hangs as low as it
    /// can without a wheel in the ground: at least one touches, the others are over it or touch.
    #[must_use]
    pub fn on(
        terrain: &Terrain,
        wheels_m: &[[f64; 3]],
        radius_m: f64,
        at_m: [f64; 2],
        heading_rad: f64,
    ) -> Self {
        let [x, y] = at_m;
        let mut stance = Self { position_m: [x, y, 0.0], axes: axes([0.0; 2], heading_rad) };
        // On a slope wheels come to stand over other ground than on the level; that settles at once.
        for _ in 0..3 {
            let under: Vec<[f64; 3]> = wheels_m
                .iter()
                .map(|wheel| stance.world(*wheel))
                .map(|[x, y, _]| [x, y, terrain.rest_m(x, y, radius_m)])
                .collect();
            stance.axes = axes(Plane::through(&under).rise, heading_rad);
        }
        stance.position_m[2] = wheels_m
            .iter()
            .map(|wheel| stance.world(*wheel))
            .map(|[x, y, z]| terrain.rest_m(x, y, radius_m) - z)
            .fold(f64::MIN, f64::max);
        stance
    }

    /// A point of the machine in the world, m.
    #[must_use]
    pub fn world(&self, point_m: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|i| {
            let turned = (0..3).map(|axis| self.axes[axis][i] * point_m[axis]).sum::<f64>();
            self.position_m[i] + turned
        })
    }
}

/// The axes of a machine that lies on a plane, its forward above `heading_rad`.
fn axes(rise: [f64; 2], heading_rad: f64) -> [[f64; 3]; 3] {
    let (sin, cos) = libm::sincos(heading_rad);
    let unit = |v: [f64; 3]| {
        let length = v.iter().map(|n| n * n).sum::<f64>().sqrt();
        v.map(|n| n / length)
    };
    let up = unit([-rise[0], -rise[1], 1.0]);
    let forward = unit([cos, sin, rise[0] * cos + rise[1] * sin]);
    let left = [
        up[1] * forward[2] - up[2] * forward[1],
        up[2] * forward[0] - up[0] * forward[2],
        up[0] * forward[1] - up[1] * forward[0],
    ];
    [forward, left, up]
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use proptest::prelude::*;

    use super::*;
    use crate::Slope;

    const RADIUS_M: f64 = 0.74;

    fn wheels(drop_m: f64) -> [[f64; 3]; 6] {
        let row = |x: f64| [[x, -1.175, RADIUS_M - drop_m], [x, 1.175, RADIUS_M - drop_m]];
        let [a, b, c] = [row(0.0), row(-3.7), row(-6.05)];
        [a[0], a[1], b[0], b[1], c[0], c[1]]
    }

    fn clearance_m(terrain: &Terrain, stance: &Stance) -> Vec<f64> {
        let over = |wheel: &[f64; 3]| {
            let centre = stance.world(*wheel);
            let minima = terrain.nearest(centre, 10.0);
            minima.points().iter().map(|p| p.distance_m).fold(f64::MAX, f64::min) - RADIUS_M
        };
        wheels(0.1).iter().map(over).collect()
    }

    #[test]
    fn on_the_level_it_is_level_to_the_last_bit() {
        let stance = Stance::on(&Terrain::Flat, &wheels(0.1), RADIUS_M, [2.0, 3.0], 0.0);
        assert_eq!(stance.axes, [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
        assert!((stance.position_m[2] - 0.1).abs() < 1e-15);
        assert_eq!(stance.position_m[..2], [2.0, 3.0]);
    }

    proptest! {
        #[test]
        fn on_a_slope_every_wheel_touches(
            grade in -0.4..0.4_f64, uphill_deg in 0.0..360.0_f64, heading_rad in -7.0..7.0_f64,
            x in -30.0..30.0_f64, y in -30.0..30.0_f64,
        ) {
            let terrain = Terrain::Plane(Slope { grade, uphill_deg }.plane());
            let stance = Stance::on(&terrain, &wheels(0.1), RADIUS_M, [x, y], heading_rad);
            for clear in clearance_m(&terrain, &stance) {
                prop_assert!(clear.abs() < 1e-9, "{clear}");
            }
            let [forward, left, _] = stance.axes;
            // Its heading is what was asked for, its left is to the left.
            prop_assert!((forward[1].atan2(forward[0]) - heading_rad).sin().abs() < 1e-9);
            prop_assert!(forward[0] * left[1] - forward[1] * left[0] > 0.5);
        }
    }

    #[test]
    fn on_rough_ground_one_wheel_touches_and_none_cuts_in() {
        let text = "[perlin]\namplitude_m = 0.8\nwavelength_m = 6\n\
            [boulders]\ndensity_per_m2 = 0.1\nradius_m = [0.3, 0.8]\nheight_m = [0.1, 0.3]";
        let terrain = Terrain::parse(text, Path::new("t.toml")).unwrap();
        for step in 0..40 {
            let turn = 0.7 * f64::from(step);
            let at = [15.0 * turn.cos(), 15.0 * turn.sin()];
            let stance = Stance::on(&terrain, &wheels(0.1), RADIUS_M, at, turn);
            let clear = clearance_m(&terrain, &stance).into_iter().fold(f64::MAX, f64::min);
            assert!(clear.abs() < 1e-6, "{at:?}: {clear}");
        }
    }
}
