//! The local map as the machine reads it: heights of a global map, each with noise of its own.

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use xt28_machine::Machine;
use xt28_terrain::{LocalMap, MapPose, Terrain};

/// Cuts the local map out of a global one, with the noise of the machine file (paper 4.4).
#[derive(Clone, Debug)]
pub struct HeightMapReader {
    map: LocalMap,
    noise_m: f64,
    random: Option<ChaCha8Rng>,
}

impl HeightMapReader {
    /// A reader of `map` whose noise is drawn from `seed`, or that is exact without a seed.
    #[must_use]
    pub fn new(machine: &Machine, map: LocalMap, seed: Option<u64>) -> Self {
        let noise_m = machine.sensors.height_map_m;
        Self { map, noise_m, random: seed.map(ChaCha8Rng::seed_from_u64) }
    }

    /// The heights of `terrain` around `pose`, m above it, in the order of [`LocalMap::points_m`]; they
    /// replace what `heights_m` held.
    pub fn read(&mut self, terrain: &Terrain, pose: &MapPose, heights_m: &mut Vec<f32>) {
        match &mut self.random {
            Some(random) => self.map.read_noisy(terrain, pose, self.noise_m, random, heights_m),
            None => self.map.read(terrain, pose, heights_m),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heights_are_as_noisy_as_the_machine_file_has_them() {
        let mut machine = Machine::xt28();
        for noise_m in [machine.sensors.height_map_m, 0.2, 0.0] {
            machine.sensors.height_map_m = noise_m;
            let mut reader = HeightMapReader::new(&machine, LocalMap::default(), Some(5));
            let (mut all, mut heights_m) = (Vec::new(), Vec::new());
            for _ in 0..20 {
                reader.read(&Terrain::Flat, &MapPose::default(), &mut heights_m);
                all.extend(heights_m.iter().map(|&height_m| f64::from(height_m)));
            }
            let spread_m = (all.iter().map(|h| h * h).sum::<f64>() / all.len() as f64).sqrt();
            assert!((spread_m - noise_m).abs() <= 0.03 * noise_m, "{spread_m}, not {noise_m}");
        }
        let mut exact = HeightMapReader::new(&machine, LocalMap::default(), None);
        let mut heights_m = Vec::new();
        exact.read(&Terrain::Flat, &MapPose::default(), &mut heights_m);
        assert!(heights_m.iter().all(|&height_m| height_m == 0.0));
    }
}
