//! Colours that stay apart for every kind of eye, on screen and on paper.

/// Measured.
pub(super) const INK: &str = "#333333";
/// Before, and what is wrong: vermilion (Okabe and Ito).
pub(super) const BEFORE: &str = "#d55e00";
/// One of two that are wrong, without the other: orange.
pub(super) const ALONE: &str = "#e69f00";
/// After, and what is right: blue.
pub(super) const AFTER: &str = "#0072b2";
/// The other causes: sky blue.
pub(super) const OTHER: &str = "#56b4e9";
/// What is not in the catalogue: reddish purple.
pub(super) const UNKNOWN: &str = "#cc79a7";
/// Nothing: green.
pub(super) const NOTHING: &str = "#009e73";
/// An effect that shows in nothing: yellow.
pub(super) const UNSEEN: &str = "#f0e442";
/// Where there is nothing to show.
pub(super) const BLANK: &str = "#f4f4f2";

/// From pale to dark, equal steps of lightness (`ColorBrewer` OrRd); for gaps up to these bounds.
const STEPS: [(f64, &str); 7] = [
    (1.5, "#fff7ec"),
    (3.0, "#fee8c8"),
    (6.0, "#fdd49e"),
    (12.0, "#fdbb84"),
    (25.0, "#fc8d59"),
    (50.0, "#d7301f"),
    (f64::INFINITY, "#7f0000"),
];

/// Colour of a gap in noise floors, and of writing on it.
pub(super) fn of_gap(floors: f64) -> (&'static str, &'static str) {
    let step = STEPS.iter().position(|(bound, _)| floors < *bound).unwrap_or(STEPS.len() - 1);
    (STEPS[step].1, if step >= 5 { "#ffffff" } else { INK })
}

/// Every colour with the gaps it stands for.
pub(super) fn legend() -> Vec<(&'static str, String)> {
    let mut from = 0.0;
    STEPS
        .iter()
        .map(|(bound, colour)| {
            let words = if bound.is_finite() {
                format!("{from} to {bound}")
            } else {
                format!("above {from}")
            };
            from = *bound;
            (*colour, words)
        })
        .collect()
}
