//! Soft limits at the stroke ends: a valve stays closed in the direction that leaves the range.

/// Strokes that the valves may move within, whole mm as the position sensors give them.
///
/// The public firmware has 20 and 460 mm (facts 3.6); the paper's range is the whole cylinder.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct StrokeLimit {
    min_mm: f64,
    max_mm: f64,
}

impl StrokeLimit {
    /// From 0 to `stroke_max_m`.
    pub(crate) const fn up_to(stroke_max_m: f64) -> Self {
        Self { min_mm: 0.0, max_mm: stroke_max_m * 1e3 }
    }

    /// `opening` (+ extends), or 0 where it would push an arm at `stroke_mm` past an end.
    pub(crate) fn hold(&self, opening: f64, stroke_mm: f64) -> f64 {
        let outward = (opening < 0.0 && stroke_mm <= self.min_mm)
            || (opening > 0.0 && stroke_mm >= self.max_mm);
        if outward { 0.0 } else { opening }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_end_blocks_outward_and_lets_inward() {
        let limit = StrokeLimit::up_to(0.5);
        assert_eq!(limit.hold(-0.3, 0.0), 0.0);
        assert_eq!(limit.hold(0.3, 0.0), 0.3);
        assert_eq!(limit.hold(-0.3, 1.0), -0.3);
        assert_eq!(limit.hold(0.3, 499.0), 0.3);
        assert_eq!(limit.hold(0.3, 500.0), 0.0);
        assert_eq!(limit.hold(-0.3, 509.0), -0.3);
    }
}
