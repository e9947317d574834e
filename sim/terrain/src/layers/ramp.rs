//! A ramp in a lane along x: under one side of the machine, or under both.

use serde::{Deserialize, Serialize};

/// A ramp in a lane along x: up between the first two stations, level, down between the last two.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Ramp {
    /// Stations, m from the start of the front axle: foot, crest, crest, foot.
    pub x_m: [f64; 4],
    /// Height between the two crests, m, within ±5.
    pub height_m: f64,
    /// Right edge of the lane, m (y is left).
    pub y_min_m: f64,
    /// Left edge of the lane, m.
    pub y_max_m: f64,
}

impl Ramp {
    /// Height at a point, m.
    #[must_use]
    pub fn height_m(&self, x_m: f64, y_m: f64) -> f64 {
        if y_m < self.y_min_m || y_m > self.y_max_m {
            return 0.0;
        }
        let [foot, crest, end, out] = self.x_m;
        let share = if x_m < crest {
            (x_m - foot) / (crest - foot)
        } else if x_m > end {
            (out - x_m) / (out - end)
        } else {
            1.0
        };
        self.height_m * share.clamp(0.0, 1.0)
    }

    /// Says what no ramp can be.
    ///
    /// # Errors
    /// A sentence that names the key.
    pub fn check(&self) -> Result<(), &'static str> {
        let numbers = [self.height_m, self.y_min_m, self.y_max_m];
        if !self.x_m.iter().chain(&numbers).all(|n| n.is_finite()) {
            return Err("every number of a ramp must be finite");
        }
        if !self.x_m.is_sorted_by(|a, b| a < b) {
            return Err("x_m must grow: foot, crest, crest, foot");
        }
        if self.y_min_m >= self.y_max_m {
            return Err("y_min_m must be below y_max_m");
        }
        if self.height_m.abs() > 5.0 {
            return Err("height_m must be within 5 m");
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Terrain;

    #[test]
    fn a_ramp_rises_in_its_lane_and_nowhere_else() {
        let ramp = Ramp { x_m: [4.0, 7.0, 8.5, 11.5], height_m: 0.3, y_min_m: -1.9, y_max_m: -0.5 };
        let terrain = Terrain::ramp(&ramp);
        assert!((terrain.height_m(5.5, -1.175) - 0.15).abs() < 1e-6);
        assert!((terrain.height_m(7.7, -1.175) - 0.3).abs() < 1e-6);
        assert_eq!(terrain.height_m(7.7, 1.175), 0.0);
        assert_eq!(terrain.height_m(3.9, -1.175), 0.0);
        assert!((terrain.height_m(10.0, -0.5) - 0.15).abs() < 1e-6);
    }
}
