//! Gradient noise: ground with natural variation (Perlin, An Image Synthesizer, 1985).

use std::f64::consts::{FRAC_1_SQRT_2, SQRT_2};

use serde::{Deserialize, Serialize};

/// Finest wavelength that the grid can carry, m: two points to a wave.
const WAVELENGTH_MIN_M: f64 = 0.2;

/// Gradient noise in octaves, each of half the wavelength of the one before.
///
/// `amplitude_m` is a bound that is all but never met: the root mean square of one octave is 0.305 of
/// it, of four octaves at persistence 0.5 it is 0.188.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Perlin {
    /// Bound of the height above and below zero, all octaves together, m, 0 to 10.
    pub amplitude_m: f64,
    /// Wavelength of the first octave, m: the side of a cell of its lattice.
    pub wavelength_m: f64,
    /// Number of octaves, 1 to 8.
    #[serde(default = "octaves")]
    pub octaves: u32,
    /// Amplitude of an octave over that of the one before, 0 to 1.
    #[serde(default = "persistence")]
    pub persistence: f64,
    /// Which ground of all those.
    #[serde(default)]
    pub seed: u64,
}

const fn octaves() -> u32 {
    4
}

const fn persistence() -> f64 {
    0.5
}

impl Perlin {
    /// Height at a point, m.
    #[must_use]
    pub fn height_m(&self, x_m: f64, y_m: f64) -> f64 {
        let (mut sum, mut bound, mut weight) = (0.0, 0.0, 1.0);
        let mut wavelength_m = self.wavelength_m;
        for octave in 0..self.octaves {
            let seed = mix(self.seed.wrapping_add(u64::from(octave) << 32));
            // Noise is zero at its lattice points; a shift of each octave keeps them apart.
            let (shift_x, shift_y) = (unit(seed), unit(mix(seed)));
            sum += weight * noise(seed, x_m / wavelength_m + shift_x, y_m / wavelength_m + shift_y);
            bound += weight;
            weight *= self.persistence;
            wavelength_m *= 0.5;
        }
        self.amplitude_m * sum / bound
    }

    /// Says what no such ground can be.
    ///
    /// # Errors
    /// A sentence that names the key.
    pub fn check(&self) -> Result<(), &'static str> {
        if !(0.0..=10.0).contains(&self.amplitude_m) {
            return Err("amplitude_m must be 0 to 10 m");
        }
        if !(1..=8).contains(&self.octaves) {
            return Err("octaves must be 1 to 8");
        }
        if !(0.0..=1.0).contains(&self.persistence) {
            return Err("persistence must be 0 to 1");
        }
        let finest_m = self.wavelength_m / f64::from(1_u32 << (self.octaves - 1));
        if !(WAVELENGTH_MIN_M..=1e4).contains(&finest_m) {
            return Err(
                "wavelength_m must be at least 0.2 m in the last octave, half of it in each: fewer octaves or longer waves",
            );
        }
        Ok(())
    }
}

/// Directions of the gradients: sixteen, evenly round the circle.
const COS_22: f64 = 0.923_879_532_511_286_7;
const SIN_22: f64 = 0.382_683_432_365_089_8;
const DIRECTIONS: [[f64; 2]; 16] = [
    [1.0, 0.0],
    [COS_22, SIN_22],
    [FRAC_1_SQRT_2, FRAC_1_SQRT_2],
    [SIN_22, COS_22],
    [0.0, 1.0],
    [-SIN_22, COS_22],
    [-FRAC_1_SQRT_2, FRAC_1_SQRT_2],
    [-COS_22, SIN_22],
    [-1.0, 0.0],
    [-COS_22, -SIN_22],
    [-FRAC_1_SQRT_2, -FRAC_1_SQRT_2],
    [-SIN_22, -COS_22],
    [0.0, -1.0],
    [SIN_22, -COS_22],
    [FRAC_1_SQRT_2, -FRAC_1_SQRT_2],
    [COS_22, -SIN_22],
];

/// Gradient noise within ±1, smooth to the second derivative, of a lattice with unit cells.
///
/// Four gradients of length one, each at most sqrt(2)/2 from the point at the middle of a cell,
/// weigh together no more than sqrt(2)/2: hence the factor.
#[allow(clippy::cast_possible_truncation)]
fn noise(seed: u64, x: f64, y: f64) -> f64 {
    let (cell_x, cell_y) = (x.floor(), y.floor());
    let (u, v) = (x - cell_x, y - cell_y);
    let corner = |over: i64, up: i64, u: f64, v: f64| {
        let [gx, gy] = gradient(seed, cell_x as i64 + over, cell_y as i64 + up);
        gx * u + gy * v
    };
    let (s, t) = (fade(u), fade(v));
    let low = lerp(corner(0, 0, u, v), corner(1, 0, u - 1.0, v), s);
    let high = lerp(corner(0, 1, u, v - 1.0), corner(1, 1, u - 1.0, v - 1.0), s);
    SQRT_2 * lerp(low, high, t)
}

/// The gradient of a lattice point: a hash of where it is, so the lattice has no end and no period.
#[allow(clippy::cast_sign_loss)]
fn gradient(seed: u64, column: i64, row: i64) -> [f64; 2] {
    let hash = mix(mix(seed ^ column as u64).wrapping_add(row as u64));
    DIRECTIONS[(hash >> 60) as usize]
}

/// A number in [0, 1) from the upper bits of a hash.
#[allow(clippy::cast_precision_loss)]
fn unit(hash: u64) -> f64 {
    (hash >> 11) as f64 / (1_u64 << 53) as f64
}

/// 64 bits well mixed (the finaliser of SplitMix64; Steele et al., 2014).
const fn mix(bits: u64) -> u64 {
    let bits = bits.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    bits ^ (bits >> 31)
}

/// Zero first and second derivative at both ends (Perlin, Improving Noise, 2002).
fn fade(t: f64) -> f64 {
    t * t * t * (t * (t * 6.0 - 15.0) + 10.0)
}

fn lerp(a: f64, b: f64, t: f64) -> f64 {
    a + t * (b - a)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const FOREST: Perlin =
        Perlin { amplitude_m: 0.5, wavelength_m: 8.0, octaves: 4, persistence: 0.5, seed: 7 };

    proptest! {
        #[test]
        fn it_stays_within_its_bound_and_has_no_steps(
            x in -1e4..1e4_f64, y in -1e4..1e4_f64, turn in 0.0..6.3_f64,
            seed in any::<u64>(), octaves in 1..=5_u32,
        ) {
            let ground = Perlin { seed, octaves, ..FOREST };
            let height = ground.height_m(x, y);
            prop_assert!(height.abs() <= FOREST.amplitude_m);
            let d = 1e-6;
            let change = ground.height_m(x + d * turn.cos(), y + d * turn.sin()) - height;
            // No octave rises more than 4 of its amplitudes in one of its wavelengths.
            let slope = 4.0 * f64::from(octaves) * FOREST.amplitude_m / FOREST.wavelength_m;
            prop_assert!(change.abs() <= slope * d, "{change}");
        }
    }

    /// Mean and root mean square over 160 by 160 m.
    fn statistics(ground: &Perlin) -> [f64; 2] {
        let at = |i: i32| f64::from(i) * 0.5 + 0.13;
        let heights: Vec<f64> = (0..320)
            .flat_map(|i| (0..320).map(move |j| (i, j)))
            .map(|(i, j)| ground.height_m(at(i), at(j)))
            .collect();
        let count = heights.len() as f64;
        let mean = heights.iter().sum::<f64>() / count;
        [mean, (heights.iter().map(|h| h * h).sum::<f64>() / count).sqrt()]
    }

    #[test]
    fn its_mean_is_zero_and_its_spread_is_that_of_independent_gradients() {
        // The variance of one octave: four independent unit gradients, each over its distance
        // (u, v), by its weight f(u) f(v), over the cell; times the squared factor.
        let steps = 1000;
        let mean = |f: &dyn Fn(f64) -> f64| {
            (0..steps).map(|i| f((f64::from(i) + 0.5) / f64::from(steps))).sum::<f64>()
                / f64::from(steps)
        };
        let weight2 = |u: f64| (1.0 - fade(u)).powi(2);
        let octave2 = 8.0 * mean(&|u| weight2(u) * u * u) * mean(&weight2);
        let shares = [1.0, 0.5, 0.25, 0.125];
        let sum: f64 = shares.iter().sum();
        let expected = (octave2 * shares.iter().map(|s| s * s).sum::<f64>()).sqrt() / sum;
        for seed in 0..5 {
            let [mean, rms] = statistics(&Perlin { seed, ..FOREST });
            // 400 cells of the first octave: the mean of that many is a twentieth of the spread.
            assert!(mean.abs() < 0.15 * rms, "seed {seed}: mean {mean:.4} of rms {rms:.4}");
            let share = rms / FOREST.amplitude_m;
            assert!((share / expected - 1.0).abs() < 0.1, "seed {seed}: {share:.3} {expected:.3}");
        }
    }

    #[test]
    fn another_seed_is_another_ground() {
        let other = Perlin { seed: 8, ..FOREST };
        let differ = (0..100).filter(|&i| {
            let x = f64::from(i) * 0.7;
            (FOREST.height_m(x, 1.0) - other.height_m(x, 1.0)).abs() > 0.01
        });
        assert!(differ.count() > 80);
        // Neither are two octaves the same ground in two sizes.
        let once = Perlin { octaves: 1, ..FOREST };
        let twice = Perlin { octaves: 2, persistence: 1.0, ..FOREST };
        let second = |x: f64, y: f64| 2.0 * twice.height_m(x, y) - once.height_m(x, y);
        assert!((0..50).any(|i| {
            let x = f64::from(i) * 0.3;
            (second(0.5 * x, 0.0) - once.height_m(x, 0.0)).abs() > 0.05
        }));
    }

    #[test]
    fn waves_that_the_grid_cannot_carry_are_refused() {
        assert_eq!(FOREST.check(), Ok(()));
        let fine = Perlin { wavelength_m: 1.0, ..FOREST };
        assert!(fine.check().unwrap_err().contains("fewer octaves or longer waves"));
        assert!(Perlin { octaves: 0, ..FOREST }.check().is_err());
        assert!(Perlin { amplitude_m: f64::NAN, ..FOREST }.check().is_err());
    }
}
