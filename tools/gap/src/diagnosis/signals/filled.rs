//! Commands that who wrote the log lost: they came, and nobody can say that they did not.

/// Intervals of this many periods have a hole.
const HOLE_PERIODS: f64 = 1.5;

/// Instants at which commands came, those in between of which the log has none put back in their places, `period_s`
/// apart as they come otherwise.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
pub(super) fn filled(times_s: &[f64], period_s: f64) -> Vec<f64> {
    let mut all = Vec::with_capacity(times_s.len());
    for (k, at_s) in times_s.iter().enumerate() {
        let before_s = k.checked_sub(1).map_or(*at_s, |before| times_s[before]);
        let periods = (at_s - before_s) / period_s;
        let missing = if periods > HOLE_PERIODS { periods.round() as u32 - 1 } else { 0 };
        let apart_s = (at_s - before_s) / f64::from(missing + 1);
        all.extend((1..=missing).map(|nth| before_s + apart_s * f64::from(nth)));
        all.push(*at_s);
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn holes_are_filled_and_jitter_is_left() {
        let row = filled(&[0.0, 0.012, 0.02, 0.05, 0.06], 0.01);
        let wanted = [0.0, 0.012, 0.02, 0.03, 0.04, 0.05, 0.06];
        assert_eq!(row.len(), wanted.len(), "{row:?}");
        assert!(row.iter().zip(wanted).all(|(a, b)| (a - b).abs() < 1e-9), "{row:?}");
        assert!(filled(&[], 0.01).is_empty());
    }
}
