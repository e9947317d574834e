//! How sure the answer is: a bar of the probabilities, every part by its name.

use super::colour::{ALONE, BEFORE, INK, NOTHING, OTHER, UNKNOWN, UNSEEN};
use super::svg::{Anchor, Svg};
use super::words::percent;
use crate::diagnosis::{Diagnosis, WORTH_TELLING};

const WIDTH: f64 = 350.0;
const HEIGHT: f64 = 22.0;
const ROW: f64 = 18.0;

/// The drawing.
pub(super) fn sureness(diagnosis: &Diagnosis) -> String {
    let parts = parts(diagnosis);
    let total: f64 = parts.iter().map(|(_, share, _)| share).sum();
    let rows: f64 = parts.iter().map(|_| ROW).sum();
    let mut svg = Svg::new(WIDTH, HEIGHT + rows + 8.0);
    let (mut x, mut y) = (0.0, HEIGHT + ROW);
    for (name, share, colour) in &parts {
        let part = WIDTH * share / total.max(1e-9);
        svg.rect([x, 0.0], [part, HEIGHT], colour, "none");
        x += part;
        svg.rect([0.0, y - 9.0], [10.0, 10.0], colour, "none");
        let words = format!("{} {name}", percent(*share));
        svg.text([16.0, y], &words, Anchor::Start, 12.0, INK);
        y += ROW;
    }
    svg.finish("Probabilities of the causes, of nothing, and of something unknown")
}

/// Each answer with its probability and colour.
fn parts(diagnosis: &Diagnosis) -> Vec<(String, f64, &'static str)> {
    let mut parts = Vec::new();
    let stood: Vec<&str> = diagnosis.stood_by().map(|cause| cause.effect.name).collect();
    // Two causes may each be likely: the likelier one is there with the other, or alone.
    let likely = || diagnosis.stood_by().map(|cause| cause.probability);
    let [first, both] = [likely().fold(0.0, f64::max), likely().fold(f64::INFINITY, f64::min)];
    if let [one, others @ ..] = &stood[..] {
        parts.push((stood.join(" and "), both, BEFORE));
        if !others.is_empty() {
            parts.push((format!("{one} alone"), first - both, ALONE));
        }
    }
    let [none, unknown] = [diagnosis.probability_none, diagnosis.probability_unknown];
    let unseen = diagnosis.probability_unseen;
    let rest = (1.0 - first - none - unknown - unseen).max(0.0);
    let runner_up = runner_up(diagnosis, rest).unwrap_or("other causes");
    parts.push((runner_up.to_owned(), rest, OTHER));
    parts.push(("nothing beyond tolerances".to_owned(), none, NOTHING));
    if unseen >= WORTH_TELLING {
        parts.push(("an effect that does not show".to_owned(), unseen, UNSEEN));
    }
    parts.push(("not in the catalogue".to_owned(), unknown, UNKNOWN));
    parts
}

/// The one cause, beside those stood by, that makes up all the `rest` that is worth telling.
fn runner_up(diagnosis: &Diagnosis, rest: f64) -> Option<&'static str> {
    let stood: Vec<_> = diagnosis.stood_by().map(|cause| cause.effect).collect();
    let mut others = diagnosis.causes.iter().filter(|cause| !stood.contains(&cause.effect));
    let one = others.next()?;
    let is_all = (rest - one.probability).abs() < WORTH_TELLING;
    (is_all && one.probability >= WORTH_TELLING).then_some(one.effect.name)
}
