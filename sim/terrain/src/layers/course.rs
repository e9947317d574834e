//! A vibration course: sills under the left and the right wheels by turns. The layout is assumed.

use serde::{Deserialize, Serialize};

/// Sills across one wheel track after the other.
///
/// ASSUMED: the paper drives a standardised course for forwarders but its text has no measures. The
/// defaults are ours: ten sills 2 m apart, each 0.15 m high, 0.6 m from foot to foot with flanks of
/// 0.2 m, 1 m wide, right side first. Every number is a key, for the day a drawing is at hand.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct Course {
    /// Foot of the first sill, m ahead of the start of the front axle.
    pub x_m: f64,
    /// Number of sills, 1 to 1000.
    pub count: u32,
    /// From the foot of one sill to that of the next, m.
    pub spacing_m: f64,
    /// Height of a sill, m, 0 to 1.
    pub height_m: f64,
    /// From foot to foot along the way, m.
    pub length_m: f64,
    /// Length of each flank, m.
    pub flank_m: f64,
    /// Width of a sill across the way, m.
    pub width_m: f64,
    /// Distance between the middles of left and right sills, m: the machine's track.
    pub track_m: f64,
}

impl Default for Course {
    fn default() -> Self {
        Self {
            x_m: 4.0,
            count: 10,
            spacing_m: 2.0,
            height_m: 0.15,
            length_m: 0.6,
            flank_m: 0.2,
            width_m: 1.0,
            track_m: 2.35,
        }
    }
}

impl Course {
    /// Where each sill lies: from and to along x, right and left edge, m.
    pub fn sills_m(&self) -> impl Iterator<Item = ([f64; 2], [f64; 2])> {
        (0..self.count).map(|index| {
            let foot = self.x_m + f64::from(index) * self.spacing_m;
            let middle = if index % 2 == 0 { -0.5 } else { 0.5 } * self.track_m;
            let half = 0.5 * self.width_m;
            ([foot, foot + self.length_m], [middle - half, middle + half])
        })
    }

    /// Height at a point, m.
    #[must_use]
    pub fn height_m(&self, x_m: f64, y_m: f64) -> f64 {
        let index = ((x_m - self.x_m) / self.spacing_m).floor();
        if !(index >= 0.0 && index < f64::from(self.count)) {
            return 0.0;
        }
        let middle = if index % 2.0 == 0.0 { -0.5 } else { 0.5 } * self.track_m;
        if (y_m - middle).abs() > 0.5 * self.width_m {
            return 0.0;
        }
        let into_m = x_m - self.x_m - index * self.spacing_m;
        let share = (into_m / self.flank_m).min((self.length_m - into_m) / self.flank_m);
        self.height_m * share.clamp(0.0, 1.0)
    }

    /// Says what no course can be.
    ///
    /// # Errors
    /// A sentence that names the key.
    pub fn check(&self) -> Result<(), &'static str> {
        if !self.x_m.is_finite() {
            return Err("x_m must be finite");
        }
        if !(1..=1000).contains(&self.count) {
            return Err("count must be 1 to 1000");
        }
        if !(0.0..=1.0).contains(&self.height_m) {
            return Err("height_m must be 0 to 1 m");
        }
        let positive = |m: f64| m >= 0.1 && m.is_finite();
        if ![self.flank_m, self.width_m, self.track_m].into_iter().all(positive) {
            return Err("flank_m, width_m and track_m must be at least 0.1 m, as the grid is");
        }
        if self.length_m < 2.0 * self.flank_m || self.length_m.is_nan() {
            return Err("length_m must hold both flanks, 2 flank_m");
        }
        if self.spacing_m < self.length_m || !self.spacing_m.is_finite() {
            return Err("spacing_m must be at least length_m");
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sills_lie_under_right_and_left_wheels_by_turns() {
        let course = Course::default();
        assert_eq!(course.check(), Ok(()));
        let (right, left) = (-1.175, 1.175);
        for (x, y, height) in [
            (4.3, right, 0.15),
            (4.3, left, 0.0),
            (6.3, left, 0.15),
            (6.3, right, 0.0),
            (4.1, right, 0.075),
            (4.5, right, 0.075),
            (3.9, right, 0.0),
            (5.0, right, 0.0),
            (22.3, left, 0.15),
            (24.3, right, 0.0),
            (4.3, 0.0, 0.0),
        ] {
            assert!((course.height_m(x, y) - height).abs() < 1e-9, "{x} {y}");
        }
        for ([from, to], [right, left]) in course.sills_m() {
            let middle = [0.5 * (from + to), 0.5 * (right + left)];
            assert_eq!(course.height_m(middle[0], middle[1]), 0.15);
        }
    }
}
