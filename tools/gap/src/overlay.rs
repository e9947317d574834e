//! One picture of a replay: what the log measured and what ours did, over each other.

use std::collections::BTreeMap;
use std::path::Path;

use plotters::coord::Shift;
use plotters::prelude::*;
use xt28_machine::Wheel;

use crate::comparison::sum_of_loads;
use crate::{Channel, GapError, Series};

/// Panels across and down.
const PANELS: (usize, usize) = (2, 6);
const SIZE_PX: (u32, u32) = (1400, 1500);
const LOG_COLOUR: RGBColor = RGBColor(0xB0, 0xB0, 0xB0);
const COLOURS: [RGBColor; 6] = [
    RGBColor(0xD5, 0x5E, 0x00),
    RGBColor(0x00, 0x72, 0xB2),
    RGBColor(0x00, 0x9E, 0x73),
    RGBColor(0xCC, 0x79, 0xA7),
    RGBColor(0xE6, 0x9F, 0x00),
    RGBColor(0x56, 0xB4, 0xE9),
];

/// A panel: what it shows, in which unit, and the curves by name.
struct Panel {
    title: String,
    curves: Vec<(String, Series, Series)>,
}

/// Writes the picture of a replay as SVG: the log grey and wide, ours thin and coloured.
///
/// # Errors
/// [`GapError::Write`].
pub(crate) fn write(
    path: &Path,
    title: &str,
    log: &BTreeMap<Channel, Series>,
    ours: &BTreeMap<Channel, Series>,
    wheel_radius_m: f64,
) -> Result<(), GapError> {
    let refuse = |problem: String| GapError::Write {
        path: path.to_owned(),
        problem: problem.replace('\n', " "),
    };
    let mut svg = String::new();
    draw(&mut svg, title, &panels(log, ours, wheel_radius_m)).map_err(refuse)?;
    std::fs::write(path, svg).map_err(|error| refuse(error.to_string()))
}

fn panels(
    log: &BTreeMap<Channel, Series>,
    ours: &BTreeMap<Channel, Series>,
    radius_m: f64,
) -> Vec<Panel> {
    let curve = |channel: Channel, per_si: f64| {
        let (log, ours) = (log.get(&channel)?, ours.get(&channel)?);
        Some((channel.to_string(), log.scaled(per_si), ours.scaled(per_si)))
    };
    let panel = |title: &str, channels: &[Channel], per_si: f64| Panel {
        title: title.to_owned(),
        curves: channels.iter().filter_map(|&channel| curve(channel, per_si)).collect(),
    };
    let deg = 1.0_f64.to_degrees();
    let wheels = |make: fn(Wheel) -> Channel, right: usize| {
        [0, 2, 4].map(|axle| make(Wheel::ALL[axle + right]))
    };
    let mut panels = Vec::with_capacity(PANELS.0 * PANELS.1);
    for (right, side) in ["right", "left"].into_iter().enumerate() {
        panels.push(panel(&format!("stroke {side}, mm"), &wheels(Channel::Stroke, right), 1e3));
    }
    for (right, side) in ["right", "left"].into_iter().enumerate() {
        panels.push(panel(
            &format!("wheel load {side}, kN"),
            &wheels(Channel::WheelLoad, right),
            1e-3,
        ));
    }
    for (right, side) in ["right", "left"].into_iter().enumerate() {
        let channels = wheels(Channel::WheelSpeed, right);
        panels.push(panel(&format!("wheel speed {side}, m/s"), &channels, radius_m));
    }
    panels.push(panel("roll, deg", &[Channel::Roll], deg));
    panels.push(panel("pitch, deg", &[Channel::Pitch], deg));
    panels.push(panel("joints, deg", &[Channel::FrontJoint, Channel::RearJoint], deg));
    let sums = sum_of_loads(log).zip(sum_of_loads(ours));
    let sums = sums.map(|(a, b)| ("sum".to_owned(), a.scaled(1e-3), b.scaled(1e-3)));
    panels.push(Panel {
        title: "sum of wheel loads, kN".to_owned(),
        curves: sums.into_iter().collect(),
    });
    let pumps = crate::channel::PumpSide::ALL.map(Channel::PumpPressure);
    panels.push(panel("pump pressures, bar", &pumps, 1e-5));
    panels.push(panel("position, m", &[Channel::East, Channel::North], 1.0));
    panels
}

fn draw(svg: &mut String, title: &str, panels: &[Panel]) -> Result<(), String> {
    let say = |error: DrawingAreaErrorKind<_>| error.to_string();
    let root = SVGBackend::with_string(svg, SIZE_PX).into_drawing_area();
    root.fill(&WHITE).map_err(say)?;
    let body = root.titled(title, ("sans-serif", 20)).map_err(say)?;
    for (area, panel) in body.split_evenly((PANELS.1, PANELS.0)).iter().zip(panels) {
        panel.draw(area)?;
    }
    root.present().map_err(say)
}

impl Panel {
    fn draw(&self, area: &DrawingArea<SVGBackend<'_>, Shift>) -> Result<(), String> {
        let (from, to) = self.range();
        let end_s = self.curves.iter().filter_map(|(_, log, _)| log.end_s()).fold(1.0, f64::max);
        let say = |error: DrawingAreaErrorKind<_>| error.to_string();
        let mut chart = ChartBuilder::on(area)
            .caption(&self.title, ("sans-serif", 14))
            .margin(4)
            .x_label_area_size(18)
            .y_label_area_size(44)
            .build_cartesian_2d(0.0..end_s, from..to)
            .map_err(say)?;
        chart
            .configure_mesh()
            .light_line_style(WHITE)
            .x_labels(7)
            .y_labels(5)
            .draw()
            .map_err(say)?;
        for (_, log, _) in &self.curves {
            let line = LineSeries::new(thinned(log), LOG_COLOUR.stroke_width(4));
            chart.draw_series(line).map_err(say)?;
        }
        for ((name, _, ours), colour) in self.curves.iter().zip(COLOURS) {
            let line = LineSeries::new(thinned(ours), colour.stroke_width(1));
            let drawn = chart.draw_series(line).map_err(say)?;
            drawn.label(name).legend(move |(x, y)| PathElement::new([(x, y), (x + 14, y)], colour));
        }
        chart
            .configure_series_labels()
            .background_style(WHITE.mix(0.7))
            .label_font(("sans-serif", 11))
            .draw()
            .map_err(say)
    }

    /// Smallest and largest value, a little apart even where nothing moves.
    fn range(&self) -> (f64, f64) {
        let values = self.curves.iter().flat_map(|(_, log, ours)| log.iter().chain(ours.iter()));
        let (from, to) = values
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(from, to), (_, value)| {
                (from.min(value), to.max(value))
            });
        if from > to {
            return (0.0, 1.0);
        }
        let margin = ((to - from) * 0.05).max(0.05);
        (from - margin, to + margin)
    }
}

/// Every fifth sample: a panel is a few hundred pixels wide.
fn thinned(series: &Series) -> impl Iterator<Item = (f64, f64)> {
    series.iter().step_by(if series.len() > 1500 { 5 } else { 1 })
}
