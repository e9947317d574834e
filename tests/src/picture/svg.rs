//! The few SVG elements a picture needs, written as text.

use std::fmt::Write;

/// An SVG document under construction.
pub(super) struct Svg {
    text: String,
}

/// Which end of a text sits at its point.
#[derive(Clone, Copy)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

const STYLE: &str = "text{font-family:'Helvetica Neue',Helvetica,Arial,'DejaVu Sans',sans-serif;\
fill:#222}.title{font-size:31px;font-weight:600}.sub{font-size:17px;fill:#555}\
.head{font-size:18px;font-weight:600}.key{font-size:16px}.tick{font-size:15px;fill:#555}\
.grid{stroke:#e4e4e4;stroke-width:1}.axis{stroke:#999;stroke-width:1.2}\
.curve{fill:none;stroke-width:2;stroke-linejoin:round;stroke-linecap:round}\
.target{stroke-width:1.4;stroke-dasharray:5 4;opacity:.75}\
.event{stroke:#c51b7d;stroke-width:1.5;stroke-dasharray:3 3}";

impl Svg {
    pub(super) fn new(width: f64, height: f64) -> Self {
        let mut svg = Self { text: String::new() };
        svg.put(format_args!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width:.0} {height:.0}\" \
             width=\"{width:.0}\" height=\"{height:.0}\">\n<style>{STYLE}</style>\n"
        ));
        svg.rect([0.0, 0.0], [width, height], "fill=\"#fff\"");
        svg
    }

    pub(super) fn finish(mut self) -> String {
        self.text.push_str("</svg>\n");
        self.text
    }

    pub(super) fn open(&mut self, attributes: &str) {
        self.put(format_args!("<g {attributes}>\n"));
    }

    pub(super) fn close(&mut self) {
        self.text.push_str("</g>\n");
    }

    pub(super) fn rect(&mut self, [x, y]: [f64; 2], [w, h]: [f64; 2], attributes: &str) {
        self.put(format_args!(
            "<rect x=\"{x:.1}\" y=\"{y:.1}\" width=\"{w:.1}\" height=\"{h:.1}\" {attributes}/>\n"
        ));
    }

    pub(super) fn line(&mut self, a: [f64; 2], b: [f64; 2], class: &str) {
        self.put(format_args!(
            "<line x1=\"{:.1}\" y1=\"{:.1}\" x2=\"{:.1}\" y2=\"{:.1}\" class=\"{class}\"/>\n",
            a[0], a[1], b[0], b[1]
        ));
    }

    pub(super) fn circle(&mut self, [x, y]: [f64; 2], radius: f64, attributes: &str) {
        self.put(format_args!(
            "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{radius:.1}\" {attributes}/>\n"
        ));
    }

    pub(super) fn polyline(&mut self, points: &[[f64; 2]], attributes: &str) {
        self.points("polyline", points, attributes);
    }

    pub(super) fn polygon(&mut self, points: &[[f64; 2]], attributes: &str) {
        self.points("polygon", points, attributes);
    }

    pub(super) fn text(&mut self, [x, y]: [f64; 2], class: &str, anchor: Anchor, text: &str) {
        let anchor = match anchor {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
            Anchor::End => "end",
        };
        let text = text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;");
        self.put(format_args!(
            "<text x=\"{x:.1}\" y=\"{y:.1}\" class=\"{class}\" text-anchor=\"{anchor}\">{text}</text>\n"
        ));
    }

    fn points(&mut self, element: &str, points: &[[f64; 2]], attributes: &str) {
        self.put(format_args!("<{element} {attributes} points=\""));
        for [x, y] in points {
            self.put(format_args!("{x:.1},{y:.1} "));
        }
        self.text.push_str("\"/>\n");
    }

    fn put(&mut self, arguments: std::fmt::Arguments<'_>) {
        // Writing to a String does not fail.
        let _ = self.text.write_fmt(arguments);
    }
}

/// The fewest points whose line stays within `tolerance` pixels of `points`, after Ramer (1972) and
/// Douglas and Peucker (1973).
pub(super) fn simplified(points: &[[f64; 2]], tolerance: f64) -> Vec<[f64; 2]> {
    if points.len() < 3 {
        return points.to_vec();
    }
    let mut keep = vec![false; points.len()];
    keep[0] = true;
    keep[points.len() - 1] = true;
    let mut spans = vec![(0, points.len() - 1)];
    while let Some((from, to)) = spans.pop() {
        let farthest = (from + 1..to)
            .map(|index| (distance(points[index], points[from], points[to]), index))
            .max_by(|a, b| a.0.total_cmp(&b.0));
        if let Some((_, index)) = farthest.filter(|(distance, _)| *distance > tolerance) {
            keep[index] = true;
            spans.extend([(from, index), (index, to)]);
        }
    }
    points.iter().zip(keep).filter_map(|(point, keep)| keep.then_some(*point)).collect()
}

/// Distance of `p` from the segment `a` to `b`.
fn distance(p: [f64; 2], a: [f64; 2], b: [f64; 2]) -> f64 {
    let (along, to_p) = ([b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]);
    let length2 = along[0] * along[0] + along[1] * along[1];
    let share = if length2 > 0.0 {
        ((to_p[0] * along[0] + to_p[1] * along[1]) / length2).clamp(0.0, 1.0)
    } else {
        0.0
    };
    (to_p[0] - share * along[0]).hypot(to_p[1] - share * along[1])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_straight_line_needs_two_points_and_a_corner_three() {
        let line: Vec<_> = (0..100).map(|i| [f64::from(i), 2.0 * f64::from(i)]).collect();
        assert_eq!(simplified(&line, 0.1).len(), 2);
        let corner: Vec<_> =
            (0..=100).map(|i: i32| [f64::from(i), f64::from((i - 50).abs())]).collect();
        assert_eq!(simplified(&corner, 0.1), [[0.0, 50.0], [50.0, 0.0], [100.0, 50.0]]);
    }

    #[test]
    fn text_is_escaped() {
        let mut svg = Svg::new(10.0, 10.0);
        svg.text([0.0, 0.0], "key", Anchor::Start, "a < b & c");
        assert!(svg.finish().contains("a &lt; b &amp; c"));
    }
}
