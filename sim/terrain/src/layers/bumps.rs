//! A field of even bumps, like the bottom of an egg carton.

use std::f64::consts::TAU;

use serde::{Deserialize, Serialize};

/// Even bumps over the whole plane: a trough at the origin, a crest half a wavelength ahead.
///
/// The height is `height_m / 2 (1 - cos(2 pi x / wavelength) cos(2 pi y / wavelength))`; it needs no
/// seed, and its steepest slope is `pi height_m / wavelength_m`.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Bumps {
    /// Crest over trough, m, 0 to 2.
    pub height_m: f64,
    /// From crest to crest along x and along y, m, at least 0.5.
    pub wavelength_m: f64,
}

impl Bumps {
    /// Height at a point, m.
    #[must_use]
    pub fn height_m(&self, x_m: f64, y_m: f64) -> f64 {
        let wave = |m: f64| libm::cos(TAU * m / self.wavelength_m);
        0.5 * self.height_m * (1.0 - wave(x_m) * wave(y_m))
    }

    /// Says what no field of bumps can be.
    ///
    /// # Errors
    /// A sentence that names the key.
    pub fn check(&self) -> Result<(), &'static str> {
        if !(0.0..=2.0).contains(&self.height_m) {
            return Err("height_m must be 0 to 2 m");
        }
        if !(0.5..=1000.0).contains(&self.wavelength_m) {
            return Err("wavelength_m must be 0.5 to 1000 m: the grid has a point every 0.1 m");
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn troughs_and_crests_alternate() {
        let bumps = Bumps { height_m: 0.2, wavelength_m: 3.0 };
        assert_eq!(bumps.height_m(0.0, 0.0), 0.0);
        for (x, y, height) in [(1.5, 0.0, 0.2), (0.0, -1.5, 0.2), (1.5, 1.5, 0.0), (3.0, 6.0, 0.0)]
        {
            assert!((bumps.height_m(x, y) - height).abs() < 1e-12, "{x} {y}");
        }
    }
}
