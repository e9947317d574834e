//! The local map: what a policy sees of the ground around the machine, turned with its heading.

use rand::Rng;
use rand_distr::{Distribution, StandardNormal};

use crate::Terrain;

/// Where the machine stands, for the map.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MapPose {
    /// East, north and up of the machine's reference point, m; heights are relative to the last.
    pub position_m: [f64; 3],
    /// Heading, counter-clockwise from east, rad.
    pub heading_rad: f64,
}

/// A rectangle of heights around the machine: 30 by 20 over 15 by 10 m (paper 5.2).
///
/// The paper says neither where in the rectangle the machine is nor whether points lie on its rim.
/// ASSUMED: the machine is in the middle, or `ahead_m` behind it, and each point in the middle of a
/// cell of 0.5 m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LocalMap {
    /// Points along the heading.
    pub along: usize,
    /// Points across it.
    pub across: usize,
    /// Length along the heading, m.
    pub length_m: f64,
    /// Width across it, m.
    pub width_m: f64,
    /// From the machine's reference point to the middle of the map, m, forward > 0.
    pub ahead_m: f64,
}

impl Default for LocalMap {
    fn default() -> Self {
        Self { along: 30, across: 20, length_m: 15.0, width_m: 10.0, ahead_m: 0.0 }
    }
}

impl LocalMap {
    /// Number of heights.
    #[must_use]
    pub const fn len(&self) -> usize {
        self.along * self.across
    }

    /// Whether it has no points.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Where its points lie, m: from the rear row to the front one, in each from right to left.
    pub fn points_m(&self, pose: &MapPose) -> impl Iterator<Item = [f64; 2]> + use<> {
        let Self { along, across, length_m, width_m, ahead_m } = *self;
        let [x, y, _] = pose.position_m;
        let (sin, cos) = libm::sincos(pose.heading_rad);
        (0..along).flat_map(move |row| {
            let forward = ahead_m + middle(row, along, length_m);
            (0..across).map(move |column| {
                let left = middle(column, across, width_m);
                [x + forward * cos - left * sin, y + forward * sin + left * cos]
            })
        })
    }

    /// The heights of `map`, m above the machine's reference point, in the order of
    /// [`Self::points_m`]; they replace what `heights_m` held.
    pub fn read(&self, map: &Terrain, pose: &MapPose, heights_m: &mut Vec<f32>) {
        heights_m.clear();
        #[allow(clippy::cast_possible_truncation)]
        let relative = |[x, y]: [f64; 2]| (map.height_m(x, y) - pose.position_m[2]) as f32;
        heights_m.extend(self.points_m(pose).map(relative));
    }

    /// As [`Self::read`], each height with noise of its own, of standard deviation `noise_m`.
    pub fn read_noisy(
        &self,
        map: &Terrain,
        pose: &MapPose,
        noise_m: f64,
        rng: &mut impl Rng,
        heights_m: &mut Vec<f32>,
    ) {
        self.read(map, pose, heights_m);
        for height_m in heights_m {
            let normal: f64 = StandardNormal.sample(rng);
            #[allow(clippy::cast_possible_truncation)]
            let noise = (noise_m * normal) as f32;
            *height_m += noise;
        }
    }
}

/// The middle of part `index` of `count` equal parts of a length, from the middle of the whole, m.
#[allow(clippy::cast_precision_loss)]
fn middle(index: usize, count: usize, length_m: f64) -> f64 {
    length_m * ((index as f64 + 0.5) / count as f64 - 0.5)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use proptest::prelude::*;
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;

    use super::*;
    use crate::Plane;

    /// Rises ahead (east) and to the left (north).
    const PLANE: Plane = Plane { height_m: 1.0, rise: [0.1, 0.01] };

    fn heights(pose: &MapPose) -> Vec<f32> {
        let mut heights = Vec::new();
        LocalMap::default().read(&Terrain::Plane(PLANE), pose, &mut heights);
        heights
    }

    #[test]
    fn rows_go_forward_and_columns_go_left() {
        let heights = heights(&MapPose { position_m: [2.0, 0.0, 1.2], heading_rad: 0.0 });
        assert_eq!(heights.len(), 600);
        let close = |found: f32, height: f64| (f64::from(found) - height).abs() < 1e-6;
        // The rear right corner: 7.25 m behind and 4.75 m to the right.
        assert!(close(heights[0], -0.725 - 0.0475));
        assert!(close(heights[19], -0.725 + 0.0475));
        assert!(close(heights[580], 0.725 - 0.0475));
        assert!(close(heights[599], 0.725 + 0.0475));
    }

    #[test]
    fn the_map_turns_with_the_machine_and_may_lie_ahead_of_it() {
        // Heading north, ahead is +y and left is -x.
        let north = MapPose { heading_rad: FRAC_PI_2, ..MapPose::default() };
        let turned = heights(&north);
        assert!((f64::from(turned[599]) - (1.0 - 0.475 + 0.0725)).abs() < 1e-6);
        let ahead = LocalMap { ahead_m: 5.0, ..LocalMap::default() };
        let [x, y] = ahead.points_m(&north).next().unwrap();
        assert!((x - 4.75).abs() < 1e-9 && (y + 2.25).abs() < 1e-9, "{x} {y}");
    }

    #[test]
    fn noise_is_that_of_its_seed_and_as_large_as_asked_for() {
        const NOISE_M: f64 = 0.045;
        let read = |seed| {
            let mut rng = ChaCha8Rng::seed_from_u64(seed);
            let mut heights = Vec::new();
            LocalMap::default().read_noisy(
                &Terrain::Flat,
                &MapPose::default(),
                NOISE_M,
                &mut rng,
                &mut heights,
            );
            heights
        };
        assert_eq!(read(1), read(1));
        assert_ne!(read(1), read(2));
        let all: Vec<f64> = (0..20).flat_map(read).map(f64::from).collect();
        let count = all.len() as f64;
        let mean = all.iter().sum::<f64>() / count;
        let spread = (all.iter().map(|h| (h - mean).powi(2)).sum::<f64>() / count).sqrt();
        assert!(mean.abs() < 0.002, "{mean}");
        assert!((spread / NOISE_M - 1.0).abs() < 0.03, "{spread}");
    }

    proptest! {
        #[test]
        fn every_height_is_that_of_its_point(
            x in -50.0..50.0_f64, y in -50.0..50.0_f64, z in -2.0..2.0_f64, heading_rad in -7.0..7.0_f64,
        ) {
            let pose = MapPose { position_m: [x, y, z], heading_rad };
            for (height, [x, y]) in heights(&pose).into_iter().zip(LocalMap::default().points_m(&pose)) {
                prop_assert!((f64::from(height) - (PLANE.at_m(x, y) - z)).abs() < 1e-5);
                let from = (x - pose.position_m[0]).hypot(y - pose.position_m[1]);
                prop_assert!(from < 7.25_f64.hypot(4.75) + 1e-9);
            }
        }
    }
}
