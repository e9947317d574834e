//! The gap of every block in every regime, as a map of colours with its numbers.

use super::colour::{BLANK, INK, of_gap};
use super::svg::{Anchor, Svg};
use crate::diagnosis::Details;
use crate::diagnosis::details::{OF_ARM, REGIMES};

const NAMES_PX: f64 = 150.0;
const CELL: [f64; 2] = [45.0, 19.0];
const HEAD_PX: f64 = 46.0;

/// The drawing: a row a block, a column a regime, and one for everything.
#[allow(clippy::cast_precision_loss)]
pub(super) fn draw(details: &Details) -> String {
    let columns = REGIMES.len() + 1;
    let height = HEAD_PX + CELL[1] * details.map.len() as f64 + 4.0;
    let mut svg = Svg::new(NAMES_PX + CELL[0] * columns as f64 + 10.0, height);
    let x_of = |column: usize| {
        NAMES_PX
            + CELL[0] * column as f64
            + if column > OF_ARM { 5.0 } else { 0.0 }
            + if column > 0 { 5.0 } else { 0.0 }
    };
    let middle = |from: usize, to: usize| 0.5 * (x_of(from) + x_of(to) + CELL[0]);
    svg.text([middle(1, OF_ARM), 13.0], "this arm", Anchor::Middle, 10.5, INK);
    svg.text([middle(OF_ARM + 1, columns - 1), 13.0], "the machine", Anchor::Middle, 10.5, INK);
    for (column, name) in std::iter::once("all").chain(REGIMES).enumerate() {
        let middle = x_of(column) + CELL[0] / 2.0;
        for (word, line) in two_lines(name).into_iter().zip([28.0, 39.0]) {
            svg.text([middle, line], word, Anchor::Middle, 10.0, INK);
        }
    }
    for (k, row) in details.map.iter().enumerate() {
        let y = HEAD_PX + CELL[1] * k as f64;
        svg.text([NAMES_PX - 6.0, y + 13.5], &row.name, Anchor::End, 10.5, INK);
        for (column, gap) in std::iter::once(&row.all).chain(&row.cells).enumerate() {
            let (fill, ink) = gap.map_or((BLANK, INK), of_gap);
            svg.rect([x_of(column) + 1.0, y + 1.0], [CELL[0] - 2.0, CELL[1] - 2.0], fill, "none");
            if let Some(gap) = gap {
                let at = [x_of(column) + CELL[0] / 2.0, y + 13.0];
                svg.text(at, &few_digits(*gap), Anchor::Middle, 10.0, ink);
            }
        }
    }
    svg.finish("Root mean square of each block's residual in each regime, in noise floors")
}

fn two_lines(name: &str) -> Vec<&str> {
    name.split_once(' ').map_or_else(|| vec!["", name], |(a, b)| vec![a, b])
}

fn few_digits(gap: f64) -> String {
    if gap < 9.95 { format!("{gap:.1}") } else { format!("{gap:.0}") }
}
