//! Quantities over time in one frame, with grid, ticks and a key.

use super::scale::Scale;
use super::svg::{Anchor, Svg, simplified};
use crate::Series;
use crate::finding::significant;

/// One quantity over time.
pub(super) struct Curve<'a> {
    pub(super) name: &'a str,
    pub(super) colour: &'a str,
    /// Seconds and value; a value that is not finite breaks the line.
    pub(super) points: Vec<[f64; 2]>,
    pub(super) dashed: bool,
}

impl<'a> Curve<'a> {
    pub(super) fn of<T>(
        series: &Series<T>,
        name: &'a str,
        colour: &'a str,
        value: impl Fn(&T) -> f64,
    ) -> Self {
        let points = series.samples().iter().map(|s| [s.at_s, value(&s.value)]).collect();
        Self { name, colour, points, dashed: false }
    }

    pub(super) fn dashed(self) -> Self {
        Self { dashed: true, ..self }
    }
}

/// A frame with curves over the run's time.
pub(super) struct Chart<'a> {
    pub(super) title: &'a str,
    pub(super) duration_s: f64,
    /// The least range the value axis covers, so that noise does not fill a calm chart.
    pub(super) least: [f64; 2],
    pub(super) curves: Vec<Curve<'a>>,
    /// When something befell the bench.
    pub(super) events_s: Vec<f64>,
}

const LEFT: f64 = 54.0;
const TOP: f64 = 40.0;
const BOTTOM: f64 = 30.0;

/// Time over the width of a chart at `x`.
pub(super) fn time_scale(duration_s: f64, x: f64, width: f64) -> Scale {
    Scale { from: 0.0, to: duration_s, pixel_from: x + LEFT, pixel_to: x + width - 8.0 }
}

impl Chart<'_> {
    pub(super) fn draw(&self, svg: &mut Svg, [x, y]: [f64; 2], [width, height]: [f64; 2]) {
        let time = time_scale(self.duration_s, x, width);
        let [low, high] = self.range();
        let value =
            Scale { from: low, to: high, pixel_from: y + height - BOTTOM, pixel_to: y + TOP };
        self.frame(svg, [x, y], &time, &value);
        for at_s in &self.events_s {
            let at = time.pixel(*at_s);
            svg.line([at, value.pixel_from], [at, value.pixel_to], "event");
        }
        for curve in &self.curves {
            let class = if curve.dashed { "curve target" } else { "curve" };
            let style = format!("class=\"{class}\" stroke=\"{}\"", curve.colour);
            for line in curve.points.split(|[_, v]| !v.is_finite()) {
                let pixels: Vec<_> =
                    line.iter().map(|[t, v]| [time.pixel(*t), value.pixel(*v)]).collect();
                if pixels.len() > 1 {
                    svg.polyline(&simplified(&pixels, 0.4), &style);
                }
            }
        }
    }

    /// The value range: all finite values and the least range, with a little air.
    fn range(&self) -> [f64; 2] {
        let values = self.curves.iter().flat_map(|c| c.points.iter().map(|[_, v]| *v));
        let (low, high) = values
            .filter(|v| v.is_finite())
            .fold((self.least[0], self.least[1]), |(low, high), v| (low.min(v), high.max(v)));
        let air = (high - low) * 0.04;
        [low - air, high + air]
    }

    fn frame(&self, svg: &mut Svg, [x, y]: [f64; 2], time: &Scale, value: &Scale) {
        svg.text([x, y + 18.0], "head", Anchor::Start, self.title);
        let room = value.pixel_from - value.pixel_to;
        for tick in value.ticks((room / 36.0).max(3.0)) {
            let at = value.pixel(tick);
            svg.line([time.pixel_from, at], [time.pixel_to, at], "grid");
            svg.text([x + LEFT - 8.0, at + 5.0], "tick", Anchor::End, &significant(tick));
        }
        for tick in time.ticks(7.0) {
            let at = time.pixel(tick);
            svg.line([at, value.pixel_from], [at, value.pixel_to], "grid");
            let label = significant(tick) + if tick == 0.0 { " s" } else { "" };
            svg.text([at, value.pixel_from + 20.0], "tick", Anchor::Middle, &label);
        }
        let [low, high] = [value.pixel_from, value.pixel_to];
        svg.line([time.pixel_from, low], [time.pixel_to, low], "axis");
        svg.line([time.pixel_from, low], [time.pixel_from, high], "axis");
        let mut key_x = time.pixel_to;
        for curve in self.curves.iter().rev().filter(|curve| !curve.name.is_empty()) {
            svg.text([key_x, y + 18.0], "key", Anchor::End, curve.name);
            #[allow(clippy::cast_precision_loss)]
            let name_width = 8.4 * curve.name.chars().count() as f64; // of the key's font
            key_x -= name_width + 10.0;
            let style = format!("class=\"curve\" stroke=\"{}\"", curve.colour);
            svg.polyline(&[[key_x - 22.0, y + 12.5], [key_x, y + 12.5]], &style);
            key_x -= 38.0;
        }
    }
}
