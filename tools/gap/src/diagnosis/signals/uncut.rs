//! Strokes as they were between two readings that are cut off to whole millimetres.

use super::Samples;

/// Step of a stroke's reading, m.
pub(super) const CUT_M: f64 = 1.0e-3;
/// A reading that stays for longer says only that the stroke is within its step.
const STAYS: usize = 40;

/// Strokes from readings that are cut off to whole millimetres. Between two readings that differ, the
/// stroke has crossed the edges between them; from crossing to crossing it goes straight.
#[allow(clippy::cast_precision_loss)]
pub(super) fn uncut(reading: &Samples) -> Samples {
    let mut known: Vec<(f64, f64)> = Vec::new();
    let middle = |value: f64| value + 0.5 * CUT_M;
    let stay = |known: &mut Vec<(f64, f64)>, from: usize, to: usize, value: f64| {
        if to - from > STAYS {
            known.push(((from + STAYS / 2) as f64, middle(value)));
            known.push(((to - STAYS / 2) as f64, middle(value)));
        }
    };
    let mut since = 0;
    for i in 1..reading.len() {
        if reading[i] != reading[i - 1] {
            stay(&mut known, since, i, reading[i - 1]);
            // All edges crossed on the way, at the middle of the sample.
            known.push((i as f64 - 0.5, middle(0.5 * (reading[i] + reading[i - 1]))));
            since = i;
        }
    }
    if let Some(last) = reading.last() {
        stay(&mut known, since, reading.len(), *last);
    }
    let mut after = 0;
    (0..reading.len())
        .map(|i| {
            let now = i as f64;
            while after < known.len() && known[after].0 <= now {
                after += 1;
            }
            match (after.checked_sub(1).map(|k| known[k]), known.get(after)) {
                (Some((from, a)), Some(&(to, b))) => a + (b - a) * (now - from) / (to - from),
                (Some((_, value)), None) | (None, Some(&(_, value))) => value,
                (None, None) => middle(reading[i]),
            }
        })
        .collect()
}
