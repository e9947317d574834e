//! The overlay as a file: the answer in words, then what the simulator loads.

use std::fmt::Write as _;

use super::headline::headline;
use super::size::{at_wheels, each};
use crate::diagnosis::Diagnosis;

/// Digits of a number that a file has: more than any interval leaves of it.
const DIGITS: i32 = 5;

/// The causes stood by, with their intervals as comments.
#[must_use]
pub fn overlay(diagnosis: &Diagnosis) -> String {
    let mut text = format!("# {}\n", headline(diagnosis).replace('\n', " "));
    for cause in diagnosis.stood_by() {
        let name = cause.effect.name;
        if each(cause).is_empty() {
            continue;
        }
        let _ = writeln!(text, "# {name}: {}", at_wheels(cause));
        if let Some(begins) = &cause.begins {
            let _ = writeln!(text, "# {name} begins {begins}; here it is there from the start.");
        }
    }
    let mut overlay = diagnosis.overlay();
    for (parameter, value) in overlay.entries.iter_mut().flat_map(|entry| &mut entry.values) {
        let [low, high] = parameter.range;
        *value = rounded(*value).clamp(low, high);
    }
    format!("{text}\n{}", overlay.to_toml())
}

/// A number to [`DIGITS`] digits.
fn rounded(value: f64) -> f64 {
    let text = format!("{value:.*e}", (DIGITS - 1) as usize);
    text.parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_has_no_more_digits_than_it_is_known_to() {
        assert_eq!(rounded(4_049.252_212_808_549), 4_049.3);
        assert_eq!(rounded(-0.001_880_044_629), -0.001_880_0);
        assert_eq!([rounded(0.0), rounded(1.0)], [0.0, 1.0]);
    }
}
