//! The rectangle that a grid covers.

use serde::{Deserialize, Serialize};

use crate::grid::PER_M;

/// A rectangle of the plane: where a grid lies.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct Extent {
    /// From and to along x, m.
    pub x_m: [f64; 2],
    /// From and to along y, m.
    pub y_m: [f64; 2],
}

impl Default for Extent {
    /// Room for the paper's 25 m of driving, the machine's length behind the start, and turns.
    fn default() -> Self {
        Self { x_m: [-15.0, 45.0], y_m: [-20.0, 20.0] }
    }
}

impl Extent {
    /// Most grid points: 64 MiB of heights.
    pub const POINTS_MAX: usize = 1 << 24;

    /// Says what no grid can lie on.
    ///
    /// # Errors
    /// A sentence that names the key.
    pub fn check(&self) -> Result<(), String> {
        for (key, [from, to]) in [("x_m", self.x_m), ("y_m", self.y_m)] {
            if !(from.abs() <= 1e5 && to.abs() <= 1e5) {
                return Err(format!("{key} must be within 100 km of the start"));
            }
            if to - from < 1.0 {
                return Err(format!("{key} must grow by at least 1 m"));
            }
        }
        let [columns, rows] = self.size();
        if columns * rows > Self::POINTS_MAX {
            return Err(format!(
                "{columns} by {rows} points of 0.1 m are more than {}; make it smaller",
                Self::POINTS_MAX
            ));
        }
        Ok(())
    }

    /// Grid points along x and y.
    pub(crate) fn size(&self) -> [usize; 2] {
        [self.x_m, self.y_m].map(|[from, to]| {
            let steps = (to * PER_M).round() - (from * PER_M).round();
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
            let steps = steps.clamp(1.0, 1e7) as usize;
            steps + 1
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_extent_without_end_is_refused() {
        for (x_m, says) in [
            ([0.0, 1e5], "1000001 by 401 points"),
            ([0.0, f64::NAN], "x_m must be within"),
            ([3.0, 2.0], "x_m must grow"),
        ] {
            let error = Extent { x_m, ..Extent::default() }.check().unwrap_err();
            assert!(error.contains(says), "{error}");
        }
        assert_eq!(Extent::default().check(), Ok(()));
    }
}
