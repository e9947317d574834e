//! Wilson's interval of a share: honest for few cases and for shares near 0 and 1.

/// Quantile of the normal distribution that leaves 5 % outside on both sides together.
const Z: f64 = 1.959_963_984_540_054;

/// The 95 % interval of a share of which `hits` of `of` were seen (Wilson 1927, JASA 22, 209);
/// `of` zero says nothing, so the interval is 0 to 1.
///
/// # Panics
/// With more hits than cases.
#[must_use]
#[allow(clippy::cast_precision_loss)]
pub fn wilson(hits: usize, of: usize) -> [f64; 2] {
    assert!(hits <= of, "{hits} hits in {of}");
    if of == 0 {
        return [0.0, 1.0];
    }
    let (n, share) = (of as f64, hits as f64 / of as f64);
    let middle = (share + Z * Z / (2.0 * n)) / (1.0 + Z * Z / n);
    let half = Z / (1.0 + Z * Z / n) * (share * (1.0 - share) / n + Z * Z / (4.0 * n * n)).sqrt();
    // At the ends the formula gives exactly 0 and 1, but for rounding.
    let low = if hits == 0 { 0.0 } else { middle - half };
    let high = if hits == of { 1.0 } else { middle + half };
    [low, high]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_has_the_published_values() {
        // Newcombe (1998), Statistics in Medicine 17, 857, table I, method 3.
        for (hits, of, low, high) in [
            (81, 263, 0.2553, 0.3662),
            (15, 148, 0.0624, 0.1605),
            (0, 20, 0.0, 0.1611),
            (1, 29, 0.0061, 0.1718),
        ] {
            let interval = wilson(hits, of);
            assert!((interval[0] - low).abs() < 5e-5, "{hits}/{of}: {interval:?}");
            assert!((interval[1] - high).abs() < 5e-5, "{hits}/{of}: {interval:?}");
        }
    }

    #[test]
    fn it_stays_within_0_and_1_and_holds_the_share() {
        assert_eq!(wilson(0, 0), [0.0, 1.0]);
        for of in 1_u32..60 {
            for hits in 0..=of {
                let [low, high] = wilson(hits as usize, of as usize);
                let share = f64::from(hits) / f64::from(of);
                assert!(0.0 <= low && low <= share && share <= high && high <= 1.0);
                let [other_low, other_high] = wilson((of - hits) as usize, of as usize);
                assert!(
                    (low + other_high - 1.0).abs() < 1e-12
                        && (high + other_low - 1.0).abs() < 1e-12
                );
            }
        }
    }
}
