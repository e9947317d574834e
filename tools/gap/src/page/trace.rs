//! One signal over one run: measured and simulated above, the error below.

use super::chart::{Axis, Frame};
use super::colour::{AFTER, BEFORE, INK};
use super::svg::{Anchor, Svg};
use crate::diagnosis::details::Trace;

const WIDTH_PX: f64 = 660.0;
const LEFT_PX: f64 = 58.0;

/// The drawing; `has_after` where there are causes to put in.
#[allow(clippy::cast_precision_loss)]
pub(super) fn draw(trace: &Trace, has_after: bool) -> String {
    let upper = if trace.measured.is_some() { 95.0 } else { 0.0 };
    let lower = 75.0;
    let mut svg = Svg::new(LEFT_PX + WIDTH_PX + 12.0, 24.0 + upper + lower + 40.0);
    let whose = if trace.fit { "fitted on" } else { "held out" };
    let title = format!("{} ({whose})", trace.title);
    svg.text([LEFT_PX, 14.0], &title, Anchor::Start, 11.5, INK);
    let time = Axis { range: [0.0, Trace::at_s(trace.before.len().max(1))], log: false };
    if let Some(measured) = &trace.measured {
        let frame = Frame {
            at: [LEFT_PX, 22.0],
            size: [WIDTH_PX, upper - 10.0],
            x: time,
            y: Axis::linear(range(
                measured.iter().copied().chain(simulated(measured, &trace.before)),
            )),
        };
        frame.draw(&mut svg, None, trace.unit);
        let points = |values: &mut dyn Iterator<Item = f64>| -> Vec<[f64; 2]> {
            values.enumerate().map(|(k, v)| inside(&frame, Trace::at_s(k), v)).collect()
        };
        svg.path(points(&mut measured.iter().copied()).into_iter(), INK, 3.0, false);
        svg.path(points(&mut simulated(measured, &trace.before)).into_iter(), BEFORE, 1.4, false);
        if has_after {
            svg.path(points(&mut simulated(measured, &trace.after)).into_iter(), AFTER, 1.4, true);
        }
    }
    let errors = trace.before.iter().chain(if has_after { &trace.after } else { &trace.before });
    let frame = Frame {
        at: [LEFT_PX, 22.0 + upper],
        size: [WIDTH_PX, lower],
        x: time,
        y: Axis::linear(range(errors.copied().chain([0.0]))),
    };
    let unit = trace.unit.split_once(", ").map_or(trace.unit, |(_, unit)| unit);
    frame.draw(&mut svg, Some("time, s"), &format!("error, {unit}"));
    let error = |values: &[f64]| -> Vec<[f64; 2]> {
        values.iter().enumerate().map(|(k, v)| frame.place(Trace::at_s(k), *v)).collect()
    };
    svg.path(error(&trace.before).into_iter(), BEFORE, 1.4, false);
    if has_after {
        svg.path(error(&trace.after).into_iter(), AFTER, 1.4, true);
    }
    svg.finish(&format!("{title}: measured, simulated before and after, and the error"))
}

/// What the simulator says, from what was measured and its error.
fn simulated<'a>(measured: &'a [f64], error: &'a [f64]) -> impl Iterator<Item = f64> + 'a {
    measured.iter().zip(error).map(|(measured, error)| measured + error)
}

/// A point, or nothing where it would leave its frame.
fn inside(frame: &Frame, x: f64, y: f64) -> [f64; 2] {
    if (0.0..=1.0).contains(&frame.y.share(y)) { frame.place(x, y) } else { [f64::NAN; 2] }
}

fn range(values: impl Iterator<Item = f64>) -> [f64; 2] {
    values
        .filter(|v| v.is_finite())
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], v| [a.min(v), b.max(v)])
}
