//! Axes of a chart: a frame, round ticks, a caption with the unit on each axis.

use super::colour::INK;
use super::svg::{Anchor, Svg};

const GRID: &str = "#e4e4e0";
const FRAME: &str = "#9a9a94";

/// One axis.
#[derive(Clone, Copy, Debug)]
pub(super) struct Axis {
    /// Values at its ends.
    pub(super) range: [f64; 2],
    /// Equal factors instead of equal steps.
    pub(super) log: bool,
}

impl Axis {
    /// From `range`, widened where it has no extent.
    pub(super) fn linear([low, high]: [f64; 2]) -> Self {
        let (low, high) =
            if low.is_finite() && high.is_finite() { (low, high) } else { (0.0, 1.0) };
        let pad = (0.06 * (high - low)).max(1e-6 * (low.abs() + high.abs()) + 1e-9);
        Self { range: [low - pad, high + pad], log: false }
    }

    pub(super) const fn log(range: [f64; 2]) -> Self {
        Self { range, log: true }
    }

    /// Place along the axis, 0 to 1 within it.
    pub(super) fn share(&self, value: f64) -> f64 {
        let [low, high] = self.range;
        if self.log { (value / low).ln() / (high / low).ln() } else { (value - low) / (high - low) }
    }

    /// Round values within it, some five.
    #[allow(clippy::cast_possible_truncation)]
    fn ticks(&self) -> Vec<f64> {
        let [low, high] = self.range;
        if self.log {
            let (from, to) = (low.log10().floor() as i32, high.log10().ceil() as i32);
            let decades = (from..=to).flat_map(|d| [1.0, 2.0, 5.0].map(|m| m * 10_f64.powi(d)));
            let sparse = to - from > 3;
            return decades
                .filter(|v| (low * 0.999..=high * 1.001).contains(v))
                .filter(|v| !sparse || (v.log10() - v.log10().round()).abs() < 1e-9)
                .collect();
        }
        let rough = (high - low) / 5.0;
        let decade = 10_f64.powf(rough.log10().floor());
        let step = [1.0, 2.0, 5.0, 10.0].map(|m| m * decade).into_iter().find(|s| *s >= rough);
        let step = step.unwrap_or(rough);
        let first = (low / step).ceil();
        (0..20_i32).map(|k| (first + f64::from(k)) * step).take_while(|v| *v <= high).collect()
    }
}

/// A frame in a drawing, with its axes.
pub(super) struct Frame {
    pub(super) at: [f64; 2],
    pub(super) size: [f64; 2],
    pub(super) x: Axis,
    pub(super) y: Axis,
}

impl Frame {
    /// Where a point is drawn.
    pub(super) fn place(&self, x: f64, y: f64) -> [f64; 2] {
        let (sx, sy) = (self.x.share(x), self.y.share(y));
        [self.at[0] + sx * self.size[0], self.at[1] + (1.0 - sy) * self.size[1]]
    }

    /// Grid, ticks and captions; with no caption for x, its ticks have no numbers either.
    pub(super) fn draw(&self, svg: &mut Svg, caption_x: Option<&str>, caption_y: &str) {
        let ([left, top], [width, height]) = (self.at, self.size);
        svg.rect(self.at, self.size, "#ffffff", FRAME);
        for value in self.y.ticks() {
            let [_, y] = self.place(self.x.range[0], value);
            svg.line([left, y], [left + width, y], GRID, 1.0);
            svg.text([left - 5.0, y + 3.5], &number(value), Anchor::End, 10.0, INK);
        }
        for value in self.x.ticks() {
            let [x, _] = self.place(value, self.y.range[0]);
            svg.line([x, top], [x, top + height], GRID, 1.0);
            if caption_x.is_some() {
                svg.text([x, top + height + 13.0], &number(value), Anchor::Middle, 10.0, INK);
            }
        }
        if let Some(caption) = caption_x {
            let at = [left + width / 2.0, top + height + 27.0];
            svg.text(at, caption, Anchor::Middle, 10.5, INK);
        }
        let at = [left - 40.0, top + height / 2.0];
        svg.turned_text(at, caption_y, Anchor::Middle, 10.5, INK, -90.0);
    }
}

/// A tick's number, without a tail of rounding.
fn number(value: f64) -> String {
    let rounded = (value * 1e6).round() / 1e6;
    if rounded == 0.0 { "0".to_owned() } else { format!("{rounded}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_within() {
        let axis = Axis { range: [-0.3, 31.0], log: false };
        assert_eq!(axis.ticks(), [0.0, 10.0, 20.0, 30.0]);
        assert_eq!(Axis::log([0.1, 5.0]).ticks(), [0.1, 0.2, 0.5, 1.0, 2.0, 5.0]);
        assert_eq!(number(0.1 + 0.2), "0.3");
    }

    #[test]
    fn an_axis_without_extent_still_has_one() {
        for range in [[1.0, 1.0], [0.0, 0.0], [f64::NAN, 1.0], [f64::INFINITY, f64::NEG_INFINITY]] {
            let axis = Axis::linear(range);
            assert!(axis.range[1] > axis.range[0] && axis.share(0.5).is_finite(), "{range:?}");
        }
    }
}
