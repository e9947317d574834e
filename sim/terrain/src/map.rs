//! The map that a policy is given: the ground as someone surveyed it, which is not the ground.

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, Normal};
use serde::{Deserialize, Serialize};

use crate::spec::LayerKind;

/// How a map differs from the ground. By default not at all.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct MapSpec {
    /// Layers that the survey does not have, such as obstacles put there after it.
    pub leave_out: Vec<LayerKind>,
    /// Standard deviation of the map's heights at its grid points, m, 0 to 1; independent, and the
    /// same at every look. The paper finds 0.045 on a car park (4.4).
    pub noise_m: f64,
    /// How far the map lies off the ground along x, y, z, m, each within ±100.
    pub shift_m: [f64; 3],
    /// Which noise of all those.
    pub seed: u64,
}

impl MapSpec {
    /// Whether the map shows the ground as it is.
    #[must_use]
    pub fn is_exact(&self) -> bool {
        self.leave_out.is_empty() && self.noise_m == 0.0 && self.shift_m == [0.0; 3]
    }

    /// Says what no map can be.
    ///
    /// # Errors
    /// A sentence that names the key.
    pub fn check(&self) -> Result<(), &'static str> {
        if !(0.0..=1.0).contains(&self.noise_m) {
            return Err("noise_m must be 0 to 1 m");
        }
        if !self.shift_m.iter().all(|m| m.abs() <= 100.0) {
            return Err("shift_m must be [x, y, z], each within 100 m");
        }
        Ok(())
    }

    /// Independent noise, one number a call, m.
    pub(crate) fn noise_m(&self) -> impl FnMut() -> f64 {
        let mut rng = ChaCha8Rng::seed_from_u64(self.seed);
        let normal = Normal::new(0.0, self.noise_m).ok();
        move || normal.map_or(0.0, |normal| normal.sample(&mut rng))
    }
}
