//! What stands in the way, seen from above: ramps, steps, sills, boulders.

use xt28_sim::TerrainSpec;
use xt28_sim::terrain::Ramp;

use super::palette;
use super::svg::{Anchor, Svg};

/// Draws the obstacles of `spec` that lie between the corners of the plan, m.
pub(super) fn draw(
    spec: &TerrainSpec,
    [low_m, high_m]: [[f64; 2]; 2],
    svg: &mut Svg,
    at: &impl Fn([f64; 2]) -> [f64; 2],
) {
    for ramp in &spec.ramp {
        draw_ramp(ramp, svg, at);
    }
    let mut block = |[from, to]: [f64; 2], [right, left]: [f64; 2]| {
        let (from, to) = (from.max(low_m[0]), to.min(high_m[0]));
        let (right, left) = (right.max(low_m[1]), left.min(high_m[1]));
        if from < to && right < left {
            let corners = [[from, right], [to, right], [to, left], [from, left]];
            svg.polygon(&corners.map(at), &style(0.6));
        }
    };
    for step in &spec.step {
        let y_m = [step.y_min_m.unwrap_or(f64::MIN), step.y_max_m.unwrap_or(f64::MAX)];
        block([step.x_m, step.end_x_m.unwrap_or(f64::MAX)], y_m);
    }
    for (x_m, y_m) in spec.course.iter().flat_map(|course| course.sills_m()) {
        block(x_m, y_m);
    }
    for boulder in spec.boulders.iter().flat_map(|boulders| boulders.placed(spec.grid)) {
        let outline = boulder.outline_m();
        let inside = |[x, y]: &[f64; 2]| {
            (low_m[0]..=high_m[0]).contains(x) && (low_m[1]..=high_m[1]).contains(y)
        };
        if outline.iter().all(inside) {
            svg.polygon(&outline.map(at), &style(0.8));
        }
    }
}

fn draw_ramp(ramp: &Ramp, svg: &mut Svg, at: &impl Fn([f64; 2]) -> [f64; 2]) {
    let [foot, crest, end, out] = ramp.x_m;
    for (from, to, opacity) in [(foot, out, 0.6), (crest, end, 1.0)] {
        let corners = [
            at([from, ramp.y_min_m]),
            at([to, ramp.y_min_m]),
            at([to, ramp.y_max_m]),
            at([from, ramp.y_max_m]),
        ];
        svg.polygon(&corners, &style(opacity));
    }
    let label = format!("ramp {} m", ramp.height_m);
    let [x, y] = at([(crest + end) / 2.0, ramp.y_min_m]);
    svg.text([x, y + 18.0], "tick", Anchor::Middle, &label);
}

fn style(opacity: f64) -> String {
    format!("fill=\"{}\" opacity=\"{opacity}\"", palette::GROUND)
}
