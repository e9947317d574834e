//! How fast blocks part from the log, before and after: those that the verdict is about, and those that
//! part fastest.

use super::chart::{Axis, Frame};
use super::colour::{AFTER, BEFORE, INK};
use super::svg::{Anchor, Svg};
use crate::diagnosis::Details;
use crate::diagnosis::details::{Curve, HORIZONS_S};

/// Charts, side by side.
const CHARTS: usize = 4;
const CHART: [f64; 2] = [128.0, 110.0];
const STEP_PX: f64 = 186.0;
/// Below this, in floors, there is nothing to see.
const LEAST: f64 = 0.1;

/// The drawing.
#[allow(clippy::cast_precision_loss)]
pub(super) fn draw(details: &Details) -> String {
    let shown: Vec<&Curve> = details.horizons.iter().take(CHARTS).collect();
    let mut svg = Svg::new(STEP_PX * CHARTS as f64, CHART[1] + 60.0);
    let most = shown
        .iter()
        .flat_map(|curve| curve.before.iter().chain(&curve.after))
        .flatten()
        .fold(1.0_f64, |most, gap| most.max(*gap));
    for (k, curve) in shown.iter().enumerate() {
        let frame = Frame {
            at: [52.0 + STEP_PX * k as f64, 22.0],
            size: CHART,
            x: Axis::log([0.08, 6.3]),
            y: Axis::log([LEAST, most * 1.5]),
        };
        frame.draw(&mut svg, Some("horizon, s"), "error, noise floors");
        svg.text([frame.at[0], 14.0], &curve.name, Anchor::Start, 11.5, INK);
        for (values, colour, dashed, drawn) in
            [(&curve.before, BEFORE, false, true), (&curve.after, AFTER, true, details.has_after)]
        {
            if drawn {
                let points = HORIZONS_S.iter().zip(values).map(|(s, gap)| {
                    gap.map_or([f64::NAN; 2], |gap| frame.place(*s, gap.max(LEAST)))
                });
                svg.path(points, colour, 2.0, dashed);
            }
        }
    }
    svg.finish("How far the error of blocks moves within a time")
}
