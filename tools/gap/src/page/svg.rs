//! SVG by hand: escaped text, lines, boxes.

use core::fmt::Write as _;

/// Text with nothing in it that a browser would take for markup.
pub(super) fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            c if c.is_control() && c != '\n' => out.push('\u{fffd}'),
            c => out.push(c),
        }
    }
    out
}

/// A drawing under construction.
pub(super) struct Svg {
    body: String,
    size: [f64; 2],
}

/// Where a text stands to its point.
#[derive(Clone, Copy)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

impl Svg {
    pub(super) fn new(width: f64, height: f64) -> Self {
        Self { body: String::new(), size: [width, height] }
    }

    pub(super) fn line(&mut self, from: [f64; 2], to: [f64; 2], colour: &str, width: f64) {
        let _ = write!(
            self.body,
            r#"<line x1="{:.1}" y1="{:.1}" x2="{:.1}" y2="{:.1}" stroke="{colour}" stroke-width="{width}"/>"#,
            from[0], from[1], to[0], to[1]
        );
    }

    pub(super) fn rect(&mut self, at: [f64; 2], size: [f64; 2], fill: &str, outline: &str) {
        let _ = write!(
            self.body,
            r#"<rect x="{:.1}" y="{:.1}" width="{:.1}" height="{:.1}" rx="2" fill="{fill}" stroke="{outline}"/>"#,
            at[0],
            at[1],
            size[0].max(0.0),
            size[1].max(0.0)
        );
    }

    /// A line around something, whatever its colour.
    pub(super) fn ring(&mut self, at: [f64; 2], size: [f64; 2], corner: f64, colour: &str) {
        let _ = write!(
            self.body,
            r#"<rect x="{:.1}" y="{:.1}" width="{:.1}" height="{:.1}" rx="{corner:.1}" fill="none" stroke="{colour}" stroke-width="3"/>"#,
            at[0], at[1], size[0], size[1]
        );
    }

    pub(super) fn circle(&mut self, at: [f64; 2], radius: f64, fill: &str, outline: &str) {
        let _ = write!(
            self.body,
            r#"<circle cx="{:.1}" cy="{:.1}" r="{radius:.1}" fill="{fill}" stroke="{outline}"/>"#,
            at[0], at[1]
        );
    }

    pub(super) fn text(&mut self, at: [f64; 2], text: &str, anchor: Anchor, px: f64, colour: &str) {
        self.turned_text(at, text, anchor, px, colour, 0.0);
    }

    pub(super) fn turned_text(
        &mut self,
        [x, y]: [f64; 2],
        text: &str,
        anchor: Anchor,
        px: f64,
        colour: &str,
        deg: f64,
    ) {
        let anchor = match anchor {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
            Anchor::End => "end",
        };
        let turn = if deg == 0.0 {
            String::new()
        } else {
            format!(r#" transform="rotate({deg} {x:.1} {y:.1})""#)
        };
        let _ = write!(
            self.body,
            r#"<text x="{x:.1}" y="{y:.1}" text-anchor="{anchor}" font-size="{px}" fill="{colour}"{turn}>{}</text>"#,
            escape(text)
        );
    }

    /// A line through points, broken where one is not finite.
    pub(super) fn path(
        &mut self,
        points: impl Iterator<Item = [f64; 2]>,
        colour: &str,
        width: f64,
        dashed: bool,
    ) {
        let mut data = String::new();
        let mut pen_up = true;
        for [x, y] in points {
            if x.is_finite() && y.is_finite() {
                let _ = write!(data, "{}{x:.1} {y:.1}", if pen_up { "M" } else { "L" });
                pen_up = false;
            } else {
                pen_up = true;
            }
        }
        if data.is_empty() {
            return;
        }
        let dash = if dashed { r#" stroke-dasharray="5 3""# } else { "" };
        let _ = write!(
            self.body,
            r#"<path d="{data}" fill="none" stroke="{colour}" stroke-width="{width}" stroke-linejoin="round"{dash}/>"#
        );
    }

    /// The drawing; `title` says what it shows to who cannot see it.
    pub(super) fn finish(self, title: &str) -> String {
        let [width, height] = self.size;
        format!(
            r#"<svg viewBox="0 0 {width:.0} {height:.0}" width="{width:.0}" role="img"><title>{}</title>{}</svg>"#,
            escape(title),
            self.body
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_text_opens_a_tag() {
        assert_eq!(
            escape("<a href=\"x\">&'\u{7}"),
            "&lt;a href=&quot;x&quot;&gt;&amp;&#39;\u{fffd}"
        );
        let mut svg = Svg::new(10.0, 10.0);
        svg.text([0.0, 0.0], "</text><script>", Anchor::Start, 10.0, "#000");
        assert!(!svg.finish("<b>").contains("<script>"));
    }

    #[test]
    fn a_path_breaks_where_nothing_is_known() {
        let mut svg = Svg::new(10.0, 10.0);
        let points = [[0.0, 0.0], [1.0, 1.0], [2.0, f64::NAN], [3.0, 3.0]];
        svg.path(points.into_iter(), "#000", 1.0, false);
        assert!(svg.finish("t").contains("M0.0 0.0L1.0 1.0M3.0 3.0"));
    }
}
