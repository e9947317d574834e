//! A slope without end under everything else.

use serde::{Deserialize, Serialize};

use crate::Plane;

/// A plane through the origin that rises in one direction, without end.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Slope {
    /// Rise per run, within 1: 0.1 is a slope of 10 %.
    pub grade: f64,
    /// Which way is up: 0 ahead of the start, 90 to its left; deg.
    #[serde(default)]
    pub uphill_deg: f64,
}

impl Slope {
    /// The plane.
    #[must_use]
    pub fn plane(&self) -> Plane {
        let (sin, cos) = libm::sincos(self.uphill_deg.to_radians());
        Plane { height_m: 0.0, rise: [self.grade * cos, self.grade * sin] }
    }

    /// Says what no slope can be.
    ///
    /// # Errors
    /// A sentence that names the key.
    pub fn check(&self) -> Result<(), &'static str> {
        if self.grade.is_nan() || self.grade.abs() > 1.0 {
            return Err("grade is rise per run, within 1: 0.1 is a slope of 10 %");
        }
        if self.uphill_deg.is_nan() || self.uphill_deg.abs() > 360.0 {
            return Err("uphill_deg must be within 360");
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_rises_the_way_it_says() {
        let plane = Slope { grade: 0.1, uphill_deg: 90.0 }.plane();
        assert!((plane.at_m(5.0, 10.0) - 1.0).abs() < 1e-12);
        assert!((plane.at_m(-500.0, -10.0) + 1.0).abs() < 1e-12);
        let [x, y] = Slope { grade: 0.2, uphill_deg: 30.0 }.plane().rise;
        assert!((x.hypot(y) - 0.2).abs() < 1e-12 && (y / x - 1.0 / 3.0_f64.sqrt()).abs() < 1e-12);
    }
}
