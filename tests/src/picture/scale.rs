//! From quantities to pixels, with ticks at round numbers.

/// A linear map from a quantity's range to pixels.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scale {
    pub(super) from: f64,
    pub(super) to: f64,
    pub(super) pixel_from: f64,
    pub(super) pixel_to: f64,
}

impl Scale {
    /// The pixel of `value`.
    pub(super) fn pixel(&self, value: f64) -> f64 {
        let share = (value - self.from) / (self.to - self.from);
        self.pixel_from + share * (self.pixel_to - self.pixel_from)
    }

    /// Round numbers in range, about `count` of them.
    pub(super) fn ticks(&self, count: f64) -> Vec<f64> {
        let step = round_step((self.to - self.from) / count);
        #[allow(clippy::cast_possible_truncation)] // a picture has few ticks
        let (first, last) =
            ((self.from / step - 1e-9).ceil() as i64, (self.to / step + 1e-9).floor() as i64);
        #[allow(clippy::cast_precision_loss)]
        (first..=last).map(|n| n as f64 * step).collect()
    }
}

/// The smallest of 1, 2, 2.5, 5 times a power of ten that is at least `raw`.
pub(super) fn round_step(raw: f64) -> f64 {
    let power = 10f64.powf(raw.max(1e-9).log10().floor());
    [1.0, 2.0, 2.5, 5.0, 10.0]
        .into_iter()
        .map(|factor| factor * power)
        .find(|step| *step >= raw * (1.0 - 1e-9))
        .unwrap_or(10.0 * power)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_inside() {
        let scale = Scale { from: -0.3, to: 31.0, pixel_from: 0.0, pixel_to: 313.0 };
        assert_eq!(scale.ticks(6.0), [0.0, 10.0, 20.0, 30.0]);
        assert!((scale.pixel(31.0) - 313.0).abs() < 1e-9);
        assert!((round_step(0.21) - 0.25).abs() < 1e-12);
        assert!((round_step(0.1) - 0.1).abs() < 1e-12);
    }
}
