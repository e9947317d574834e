//! Units that a person reads, by the unit suffix of a parameter's name: bar for Pa, mm for m.

/// How a suffix is told: the unit with its space, and how many of them one of the SI's is.
type Told = (&'static str, &'static str, f64);

/// By suffix; of those that fit a name the longest counts. What has none is a plain number or a share.
const BY_SUFFIX: [Told; 16] = [
    ("_m_s_n", " mm/s/kN", 1e6),
    ("_n_s_m", " kN s/m", 1e-3),
    ("_per_w", " %/kW", 1e5),
    ("_m3_s", " l/min", 6e4),
    ("_n_m", " kN/m", 1e-3),
    ("_m_s", " mm/s", 1e3),
    ("_rad", " deg", 57.295_779_513_082_32),
    ("_m3", " l", 1e3),
    ("_pa", " bar", 1e-5),
    ("_kg", " kg", 1.0),
    ("_nm", " kNm", 1e-3),
    ("_m", " mm", 1e3),
    ("_n", " kN", 1e-3),
    ("_s", " ms", 1e3),
    ("factor", " % of nominal", 1e2),
    ("", " %", 1e2),
];
/// Numbers that are no share, though their names have no unit.
const PLAIN: [&str; 2] = ["exponent", "added"];

/// A parameter's name in words, its unit, and the factor that takes it there from SI.
pub(super) fn of(parameter: &str) -> (String, &'static str, f64) {
    let (suffix, unit, per_si) = if PLAIN.contains(&parameter) {
        ("", "", 1.0)
    } else {
        let fits = |(suffix, ..): &&Told| parameter.ends_with(suffix);
        // The last one fits every name.
        *BY_SUFFIX.iter().find(fits).unwrap_or(&BY_SUFFIX[BY_SUFFIX.len() - 1])
    };
    let name = parameter.strip_suffix(suffix).unwrap_or(parameter);
    (name.trim_end_matches('_').replace('_', " "), unit, per_si)
}

/// A wider half of an interval, in the unit told, makes decimals idle.
const WIDE: f64 = 5.0;

/// Decimals of an estimate and the ends of its interval: two or three digits of the largest, and none that the
/// interval makes idle.
pub(super) fn decimals([best, low, high]: [f64; 3]) -> usize {
    let largest = best.abs().max(low.abs()).max(high.abs());
    let is_idle = largest >= 99.5 || high - low >= 2.0 * WIDE;
    if is_idle || !(largest > 0.0 && largest.is_finite()) {
        return 0;
    }
    // The decimal exponent of any f64 is within a few hundred of zero.
    #[allow(clippy::cast_possible_truncation)]
    let exponent = largest.log10().floor().min(0.0) as i32;
    usize::try_from(1 - exponent).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use xt28_sim::effects::CATALOGUE;

    use super::*;

    #[test]
    fn a_suffix_is_not_taken_for_the_end_of_a_longer_one() {
        for (parameter, name, unit) in [
            ("delay_s", "delay", " ms"),
            ("rate_m_s", "rate", " mm/s"),
            ("creep_m_s_n", "creep", " mm/s/kN"),
            ("damping_n_s_m", "damping", " kN s/m"),
            ("stiffness_n_m", "stiffness", " kN/m"),
            ("torque_nm", "torque", " kNm"),
            ("flow_m3_s", "flow", " l/min"),
            ("contraction_factor", "contraction", " % of nominal"),
            ("factor", "", " % of nominal"),
            ("rod_share", "rod share", " %"),
            ("exponent", "exponent", ""),
        ] {
            let (found, of, _) = super::of(parameter);
            assert_eq!((found.as_str(), of), (name, unit), "{parameter}");
        }
    }

    /// A name that ends in a unit that the table lacks would be told in percent.
    #[test]
    fn every_parameter_of_the_catalogue_has_its_unit() {
        const SHARES: [&str; 6] = ["share", "rod_share", "slip", "width", "deadband", "droop"];
        for parameter in CATALOGUE.iter().flat_map(|effect| effect.parameters) {
            let (_, unit, _) = of(parameter.name);
            assert_eq!(unit == " %", SHARES.contains(&parameter.name), "{}", parameter.name);
            assert_eq!(unit.is_empty(), PLAIN.contains(&parameter.name), "{}", parameter.name);
        }
    }

    #[test]
    fn small_numbers_keep_their_digits_and_large_ones_lose_their_decimals() {
        let sharp = |best: f64| decimals([best, 0.9 * best, best]);
        assert_eq!([240.0, 11.4, 2.0, 0.31, 0.021, 0.0].map(sharp), [0, 1, 1, 2, 3, 0]);
        assert_eq!(decimals([80.0, 75.0, 85.0]), 0);
    }
}
