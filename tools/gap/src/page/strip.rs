//! The gap of every block over the time of every run, as strips of colour: when it parts.

use super::colour::{AFTER, BLANK, INK, of_gap};
use super::svg::{Anchor, Svg};
use crate::diagnosis::Details;
use crate::diagnosis::details::CELL_S;

const NAMES_PX: f64 = 128.0;
const WIDTH_PX: f64 = 740.0;
const BETWEEN_PX: f64 = 6.0;
const ROW_PX: f64 = 11.0;
const HEAD_PX: f64 = 18.0;
const FOOT_PX: f64 = 16.0;

/// The drawing: a row a block, a panel a run, time to the right; a line where causes begin.
#[allow(clippy::cast_precision_loss)]
pub(super) fn draw(details: &Details) -> String {
    let rows = details.strips.len() as f64;
    let mut svg = Svg::new(WIDTH_PX, HEAD_PX + ROW_PX * rows + FOOT_PX);
    let cells: Vec<usize> = (0..details.runs.len())
        .map(|run| details.strips.iter().map(|strip| strip.runs[run].len()).max().unwrap_or(0))
        .collect();
    let gaps_px = BETWEEN_PX * cells.len().saturating_sub(1) as f64;
    let cell_px = (WIDTH_PX - NAMES_PX - gaps_px) / cells.iter().sum::<usize>().max(1) as f64;
    for (row, strip) in details.strips.iter().enumerate() {
        let y = HEAD_PX + ROW_PX * row as f64;
        svg.text([NAMES_PX - 5.0, y + 8.5], &strip.name, Anchor::End, 9.0, INK);
    }
    let mut x = NAMES_PX;
    for (run, n) in cells.into_iter().enumerate() {
        let width = cell_px * n as f64;
        svg.text([x, 12.0], &short(&details.runs[run].name, width), Anchor::Start, 9.0, INK);
        for (row, strip) in details.strips.iter().enumerate() {
            let y = HEAD_PX + ROW_PX * row as f64;
            for (from, to, colour) in stretches(&strip.runs[run]) {
                let at = [x + cell_px * from as f64, y + 0.5];
                svg.rect(at, [cell_px * (to - from) as f64, ROW_PX - 1.0], colour, "none");
            }
        }
        let foot = HEAD_PX + ROW_PX * rows;
        let place = |s: f64| x + cell_px * s / CELL_S;
        // A number that has no room before the next panel is left out.
        for s in (0..n.saturating_sub(2)).step_by(5).map(|k| CELL_S * k as f64) {
            svg.line([place(s), foot], [place(s), foot + 3.0], INK, 0.5);
            svg.text([place(s), foot + 12.0], &format!("{s}"), Anchor::Start, 8.0, INK);
        }
        let since_s = details.runs[run].since_s;
        if since_s > 0.0 && since_s < CELL_S * n as f64 {
            let begins = place(since_s);
            svg.line([begins, HEAD_PX - 2.0], [begins, foot], AFTER, 1.5);
        }
        x += width + BETWEEN_PX;
    }
    svg.finish(
        "Root mean square of each block's residual every two seconds of each run, in noise floors",
    )
}

/// Neighbours of one colour together: from which cell, up to which, and the colour.
fn stretches(cells: &[Option<f64>]) -> Vec<(usize, usize, &'static str)> {
    let colours = cells.iter().map(|gap| gap.map_or(BLANK, |gap| of_gap(gap).0));
    let mut out: Vec<(usize, usize, &'static str)> = Vec::new();
    for (k, colour) in colours.enumerate() {
        match out.last_mut() {
            Some((_, to, same)) if *same == colour => *to = k + 1,
            _ => out.push((k, k + 1, colour)),
        }
    }
    out
}

/// As much of a run's name as stands above its panel.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
fn short(name: &str, width_px: f64) -> String {
    const LETTER_PX: f64 = 4.8;
    let stem = name.split('.').next().unwrap_or(name);
    stem.chars().take((width_px / LETTER_PX) as usize).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbours_of_one_colour_are_drawn_as_one() {
        let cells = [None, None, Some(0.5), Some(1.0), Some(60.0)];
        let drawn = stretches(&cells);
        let spans: Vec<_> = drawn.iter().map(|(from, to, _)| (*from, *to)).collect();
        assert_eq!(spans, [(0, 2), (2, 4), (4, 5)]);
        assert_eq!(drawn[0].2, BLANK);
    }

    #[test]
    fn a_name_stays_above_its_panel() {
        assert_eq!(short("run-2-s_turn.log.gz", 96.0), "run-2-s_turn");
        assert_eq!(short("run-2-s_turn.log.gz", 24.0), "run-2");
    }
}
