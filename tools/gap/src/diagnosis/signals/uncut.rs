//! Strokes as they were between two readings that are cut off to whole millimetres.

use super::Samples;

/// Step of a stroke's reading, m.
pub(super) const CUT_M: f64 = 1.0e-3;
/// A reading that stays for longer says only that the stroke is within its step.
const STAYS: usize = 40;

/// A change that nothing leads up to and nothing follows is a jump of the reading from this size on, m, and where
/// those beside it are less than this share of it: a rod that moves crosses one step after the other.
const JUMP_M: f64 = 4.0e-3;
const BESIDE: f64 = 0.34;

/// Samples within which readings must have come before a jump: over a gap of a log a rod may move far.
const LOGGED: usize = 5;

/// Where readings change, and by how much they do there.
struct Changes {
    at: Vec<usize>,
    by_m: Vec<f64>,
}

impl Changes {
    fn of(reading: &Samples) -> Self {
        let at: Vec<usize> = (1..reading.len()).filter(|i| reading[*i] != reading[i - 1]).collect();
        let by_m = at.iter().map(|&i| reading[i] - reading[i - 1]).collect();
        Self { at, by_m }
    }

    /// Whether change number `k` is a jump.
    fn jumps(&self, k: usize) -> bool {
        let by_m = |k: usize| self.by_m.get(k).map_or(0.0, |by_m| by_m.abs());
        let beside_m = k.checked_sub(1).map_or(0.0, by_m).max(by_m(k + 1));
        by_m(k) >= JUMP_M && beside_m < BESIDE * by_m(k)
    }
}

/// By how much a reading has jumped by itself up to each sample, m. A reading came where `fresh` says so.
pub(super) fn jumped_m(reading: &Samples, fresh: &[bool]) -> Samples {
    let changes = Changes::of(reading);
    let mut jumped_m = vec![0.0; reading.len()];
    for (k, &i) in changes.at.iter().enumerate() {
        let is_logged = fresh[i.saturating_sub(LOGGED)..i].iter().any(|fresh| *fresh);
        if is_logged && changes.jumps(k) {
            jumped_m[i..].iter_mut().for_each(|jumped_m| *jumped_m += changes.by_m[k]);
        }
    }
    jumped_m
}

/// Strokes from readings that are cut off to whole millimetres. Between two readings that differ, the
/// stroke has crossed the edges between them; from crossing to crossing it goes straight. A reading that jumps by
/// itself, as that of a sensor that comes loose, does so at once.
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
    let changes = Changes::of(reading);
    for (k, &i) in changes.at.iter().enumerate() {
        stay(&mut known, since, i, reading[i - 1]);
        if changes.jumps(k) {
            known.push((i as f64 - 1.0, middle(reading[i - 1])));
            known.push((i as f64, middle(reading[i])));
        } else {
            // All edges crossed on the way, at the middle of the sample.
            known.push((i as f64 - 0.5, middle(0.5 * (reading[i] + reading[i - 1]))));
        }
        since = i;
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

#[cfg(test)]
mod tests {
    use super::*;

    /// A sensor that jumps while its arm moves: one step a tenth of a second, and then twelve at once.
    #[test]
    fn a_jump_is_at_once_and_a_motion_is_not() {
        let moves = |i: usize| (170 + i / 10) as f64 * CUT_M;
        let jump: Samples =
            (0..200).map(|i| moves(i) - if i < 103 { 0.0 } else { 12.0 * CUT_M }).collect();
        let (with, without) = (uncut(&jump), uncut(&(0..200).map(moves).collect()));
        for i in 0..200 {
            let by_m = without[i] - with[i] - if i < 103 { 0.0 } else { 12.0 * CUT_M };
            assert!(by_m.abs() < 0.6 * CUT_M, "{i}: {by_m} m");
        }
        // Told ten times a second, a rod that moves comes in steps as large.
        let seldom: Samples = (0..200).map(|i| (170 + 12 * (i / 10)) as f64 * CUT_M).collect();
        let rate = |i: usize| (uncut(&seldom)[i + 1] - uncut(&seldom)[i]) / CUT_M;
        assert!((40..150).all(|i| (rate(i) - 1.2).abs() < 0.01), "{}", rate(60));
    }
}
