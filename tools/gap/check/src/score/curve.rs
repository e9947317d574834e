//! The reliability curve as a picture: what was stated against what came out.

use plotters::prelude::*;

use super::Bin;
use crate::CheckError;

const SIZE_PX: (u32, u32) = (560, 560);
const IDEAL: RGBColor = RGBColor(0xB0, 0xB0, 0xB0);
const SEEN: RGBColor = RGBColor(0x00, 0x72, 0xB2);

/// An SVG of `bins`: each a point with its 95 % interval, and the line on which all should lie.
///
/// # Errors
/// [`CheckError::Picture`].
pub fn curve(bins: &[Bin]) -> Result<String, CheckError> {
    let mut svg = String::new();
    draw(&mut svg, bins).map_err(|problem| CheckError::Picture(problem.replace('\n', " ")))?;
    Ok(svg)
}

fn draw(svg: &mut String, bins: &[Bin]) -> Result<(), String> {
    let say = |error: DrawingAreaErrorKind<_>| error.to_string();
    let root = SVGBackend::with_string(svg, SIZE_PX).into_drawing_area();
    root.fill(&WHITE).map_err(say)?;
    let mut chart = ChartBuilder::on(&root)
        .caption("stated probability and what came out", ("sans-serif", 18))
        .margin(12)
        .x_label_area_size(40)
        .y_label_area_size(48)
        .build_cartesian_2d(0.0..1.0, 0.0..1.0)
        .map_err(say)?;
    let said = "probability stated";
    let mesh = &mut chart.configure_mesh();
    mesh.light_line_style(WHITE).x_desc(said).y_desc("share that was true").draw().map_err(say)?;
    let ideal = LineSeries::new([(0.0, 0.0), (1.0, 1.0)], IDEAL.stroke_width(3));
    chart.draw_series(ideal).map_err(say)?;
    let interval = |bin: &Bin| {
        let [low, high] = bin.interval;
        PathElement::new([(bin.stated, low), (bin.stated, high)], SEEN.stroke_width(1))
    };
    chart.draw_series(bins.iter().map(interval)).map_err(say)?;
    let points = bins.iter().map(|bin| (bin.stated, bin.true_share));
    chart.draw_series(LineSeries::new(points.clone(), SEEN.stroke_width(2))).map_err(say)?;
    chart.draw_series(points.map(|at| Circle::new(at, 4, SEEN.filled()))).map_err(say)?;
    root.present().map_err(say)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_bin_is_a_point_and_none_is_none() {
        let bin = |stated| Bin { stated, true_share: 0.5, interval: [0.2, 0.8], count: 8 };
        let svg = curve(&[bin(0.3), bin(0.7), bin(0.9)]).unwrap();
        assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"));
        assert_eq!(svg.matches("<circle").count(), 3);
        assert_eq!(curve(&[]).unwrap().matches("<circle").count(), 0);
    }
}
