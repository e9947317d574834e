//! A step or kerb across the way.

use serde::{Deserialize, Serialize};

/// Ground that is higher (or lower) from a line across the way onward.
///
/// The grid gives every face a width: it rises from the last grid point before `x_m` to the first
/// one at or after it, 0.1 m, so a kerb of 0.15 m has a face of 56 degrees.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Step {
    /// Where it begins, m ahead of the start of the front axle.
    pub x_m: f64,
    /// Its height, m, within ±2; negative is down.
    pub height_m: f64,
    /// Where it ends; without it, it never does.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub end_x_m: Option<f64>,
    /// Its right edge, m; without it, it has none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub y_min_m: Option<f64>,
    /// Its left edge, m; without it, it has none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub y_max_m: Option<f64>,
}

impl Step {
    fn ends(&self) -> [f64; 4] {
        let (low, high) = (f64::NEG_INFINITY, f64::INFINITY);
        [
            self.x_m,
            self.end_x_m.unwrap_or(high),
            self.y_min_m.unwrap_or(low),
            self.y_max_m.unwrap_or(high),
        ]
    }

    /// Height at a point, m.
    #[must_use]
    pub fn height_m(&self, x_m: f64, y_m: f64) -> f64 {
        let [from, to, right, left] = self.ends();
        let on = (from..=to).contains(&x_m) && (right..=left).contains(&y_m);
        if on { self.height_m } else { 0.0 }
    }

    /// Says what no step can be.
    ///
    /// # Errors
    /// A sentence that names the key.
    pub fn check(&self) -> Result<(), &'static str> {
        let [from, to, right, left] = self.ends();
        if self.height_m.is_nan() || self.height_m.abs() > 2.0 {
            return Err("height_m must be within 2 m");
        }
        if !from.is_finite() || from >= to || to.is_nan() {
            return Err("x_m must be a number, and below end_x_m");
        }
        if right.is_nan() || left.is_nan() || right >= left {
            return Err("y_min_m must be below y_max_m");
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_kerb_stands_where_it_is_put() {
        let kerb = Step { x_m: 6.0, height_m: 0.15, end_x_m: None, y_min_m: None, y_max_m: None };
        assert_eq!(kerb.height_m(5.9, 3.0), 0.0);
        assert_eq!(kerb.height_m(6.0, 3.0), 0.15);
        assert_eq!(kerb.height_m(1e6, -1e6), 0.15);
        let sill = Step { end_x_m: Some(6.4), y_max_m: Some(0.0), ..kerb };
        assert_eq!([sill.height_m(6.4, 0.0), sill.height_m(6.5, 0.0)], [0.15, 0.0]);
        assert_eq!(sill.height_m(6.2, 0.1), 0.0);
        assert_eq!(sill.check(), Ok(()));
        assert!(Step { end_x_m: Some(5.0), ..sill.clone() }.check().is_err());
        assert!(Step { height_m: f64::NAN, ..sill }.check().is_err());
    }
}
