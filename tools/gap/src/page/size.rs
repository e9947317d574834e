//! How large a cause is, as a person says it: to which side it is off, in units that one reads.

use xt28_sim::effects::{Block, Effect, Parameter};

use super::unit;
use super::words::on;
use crate::diagnosis::{Cause, Estimate};

/// A parameter that has two sides: what is said before its size, and after one above and one below nothing.
type Sides = (&'static str, [&'static str; 2]);

/// Share of a parameter's range from which on an interval says nothing.
const NEARLY_ALL: f64 = 0.9;
/// Share of it within which an estimate is at its end.
const AT_LIMIT: f64 = 1e-3;

/// A reading that is too large or too small.
const READING: Sides = ("reads ", ["too much", "too little"]);

/// The sides of a parameter; `None` where its number says all.
fn sides(effect: &Effect, parameter: &str) -> Option<Sides> {
    Some(match parameter {
        "bias_pa" | "bias_m" => READING,
        "factor" if effect.block == Block::Sensor => READING,
        "roll_rad" => ("reads ", ["right side high", "right side low"]),
        "pitch_rad" => ("reads ", ["nose up", "nose down"]),
        "x_m" | "longitudinal_m" => ("", ["forward", "back"]),
        "y_m" | "lateral_m" => ("", ["to the left", "to the right"]),
        "z_m" => ("", ["up", "down"]),
        "grade_x_rad" => ("", ["up to the east", "down to the east"]),
        "grade_y_rad" => ("", ["up to the north", "down to the north"]),
        "added" => ("coefficient ", ["more", "less"]),
        _ => return None,
    })
}

/// Every parameter of a cause with its interval, in one line.
pub(super) fn sizes(cause: &Cause) -> String {
    each(cause).join(", ")
}

/// The same with its wheels: "reads 7.3 bar too little (3.3 to 11.4), wheel FL".
pub(super) fn at_wheels(cause: &Cause) -> String {
    let wheels = cause.effect.has_scope().then(|| on(cause.scope));
    each(cause).into_iter().chain(wheels).collect::<Vec<_>>().join(", ")
}

/// Every parameter of a cause with its interval.
pub(super) fn each(cause: &Cause) -> Vec<String> {
    cause.parameters.iter().map(|estimate| told(cause.effect, estimate)).collect()
}

/// One parameter of `effect`: "reads 7.3 bar too little (3.3 to 11.4)", "delay 210 ms (190 to 230)".
fn told(effect: &Effect, estimate: &Estimate) -> String {
    let (name, unit, per_si) = unit::of(estimate.name);
    let sides = sides(effect, estimate.name);
    let parameter = effect.parameter(estimate.name);
    if parameter.is_some_and(|parameter| is_untold(parameter, estimate)) {
        let whose = match sides {
            Some((before, [one, other])) => format!("{before}{one} or {other}"),
            None if name.is_empty() => "size".to_owned(),
            None => name,
        };
        return format!("{whose}: not told by these logs");
    }
    let limit = if parameter.is_some_and(|parameter| is_at_limit(parameter, estimate)) {
        ", at its limit"
    } else {
        ""
    };
    let Some(sides) = sides else {
        let values = estimate.value.map(|value| value * per_si);
        let decimals = unit::decimals(values);
        let [best, low, high] = values.map(|value| number(value, decimals));
        let named = if name.is_empty() { name } else { name + " " };
        return format!("{named}{best}{unit} ({low} to {high}{limit})");
    };
    // What a factor makes a reading off by is a share of it.
    let (nothing, unit) = if estimate.name == "factor" { (1.0, " %") } else { (0.0, unit) };
    beside_nothing(estimate.value.map(|value| (value - nothing) * per_si), sides, unit, limit)
}

/// Whether its interval is as good as all that the law is made for.
fn is_untold(parameter: &Parameter, estimate: &Estimate) -> bool {
    let ([least, most], [_, low, high]) = (parameter.range, estimate.value);
    high - low >= NEARLY_ALL * (most - least)
}

/// Whether it went as far as it may, and might have gone farther; what is not there at all did not.
fn is_at_limit(parameter: &Parameter, estimate: &Estimate) -> bool {
    let [least, most] = parameter.range;
    let near = |limit: f64| (estimate.value[0] - limit).abs() <= AT_LIMIT * (most - least);
    [least, most].into_iter().any(near) && !near(parameter.neutral)
}

/// A size with its side in words, which the interval has again where it reaches to the other.
fn beside_nothing(values: [f64; 3], (before, sides): Sides, unit: &str, limit: &str) -> String {
    let decimals = unit::decimals(values);
    let size = |value: f64| number(value.abs(), decimals);
    let side = |value: f64| sides[usize::from(value < 0.0)];
    let [best, low, high] = values;
    let interval = if low < 0.0 && high > 0.0 {
        format!("{} {} to {} {}", size(low), side(low), size(high), side(high))
    } else {
        let (near, far) = (low.abs().min(high.abs()), low.abs().max(high.abs()));
        format!("{} to {}", size(near), size(far))
    };
    format!("{before}{}{unit} {} ({interval}{limit})", size(best), side(best))
}

/// With so many decimals; what is left of a negative number that rounds to none is no minus.
fn number(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    let is_none = text.chars().all(|c| matches!(c, '-' | '0' | '.'));
    if is_none { text.trim_start_matches('-').to_owned() } else { text }
}

#[cfg(test)]
mod tests {
    use xt28_sim::effects::find;

    use super::*;

    fn said(effect: &str, name: &str, value: [f64; 3]) -> String {
        let effect = find(effect).unwrap();
        let name = effect.parameter(name).unwrap().name;
        told(effect, &Estimate { name, value })
    }

    #[test]
    fn a_reading_is_off_to_the_side_that_its_number_says() {
        let bias = |value| said("pressure-bias", "bias_pa", value);
        let little = bias([-733_932.0, -1_139_969.0, -327_889.0]);
        assert_eq!(little, "reads 7.3 bar too little (3.3 to 11.4)");
        assert_eq!(bias([7.3e5, 3.3e5, 11.4e5]), "reads 7.3 bar too much (3.3 to 11.4)");
        let both = bias([2.0e4, -5.0e4, 9.0e4]);
        assert_eq!(both, "reads 0.20 bar too much (0.50 too little to 0.90 too much)");
        let stroke = said("stroke-bias", "bias_m", [-0.012, -0.014, -0.010]);
        assert_eq!(stroke, "reads 12.0 mm too little (10.0 to 14.0)");
        for effect in ["pressure-scale", "stroke-scale", "wheel-speed-scale"] {
            let scale = said(effect, "factor", [0.949, 0.918, 0.980]);
            assert_eq!(scale, "reads 5.1 % too little (2.0 to 8.2)");
            assert!(said(effect, "factor", [1.06, 1.05, 1.07]).contains("6.0 % too much"));
        }
        let tilted = said("imu-offset", "pitch_rad", [-0.02, -0.025, -0.015]);
        assert_eq!(tilted, "reads 1.1 deg nose down (0.9 to 1.4)");
    }

    #[test]
    fn what_the_logs_do_not_tell_has_no_size_and_what_could_go_no_farther_says_so() {
        for (effect, name, value, words) in [
            ("com-shift", "z_m", [-0.03, -0.7, 0.7], "up or down: not told by these logs"),
            ("pressure-scale", "rod_share", [0.76, 0.0, 1.0], "rod share: not told by these logs"),
            ("valve-gain", "factor", [1.2, 0.1, 3.0], "size: not told by these logs"),
            (
                "lock-damping",
                "factor",
                [5.0, 4.0, 5.0],
                "500 % of nominal (400 to 500, at its limit)",
            ),
            ("com-shift", "z_m", [0.7, 0.5, 0.7], "700 mm up (500 to 700, at its limit)"),
            ("arm-delay", "delay_s", [0.0, 0.0, 0.012], "delay 0 ms (0 to 12)"),
        ] {
            assert_eq!(said(effect, name, value), words);
        }
    }

    #[test]
    fn sizes_are_told_in_units_that_one_reads() {
        for (effect, name, value, words) in [
            ("arm-delay", "delay_s", [0.21, 0.19, 0.23], "delay 210 ms (190 to 230)"),
            ("leakage-drift", "rate_m_s", [7.76e-3, 7e-3, 8.5e-3], "rate 7.8 mm/s (7.0 to 8.5)"),
            ("valve-gain", "factor", [0.8, 0.75, 0.85], "80 % of nominal (75 to 85)"),
            ("com-shift", "y_m", [-0.0475, -0.0762, -0.0188], "48 mm to the right (19 to 76)"),
            ("payload", "mass_kg", [4123.4, 3900.0, 4300.0], "mass 4123 kg (3900 to 4300)"),
            ("payload", "height_m", [1.8, 1.7, 1.9], "height 1800 mm (1700 to 1900)"),
            (
                "terrain-slope",
                "grade_x_rad",
                [0.02, 0.018, 0.022],
                "1.1 deg up to the east (1.0 to 1.3)",
            ),
            (
                "rolling-resistance",
                "added",
                [0.021, 0.018, 0.024],
                "coefficient 0.021 more (0.018 to 0.024)",
            ),
            ("accumulator-gas", "exponent", [1.3, 1.2, 1.4], "exponent 1.3 (1.2 to 1.4)"),
            ("unsupported-sag", "below_n", [-1.0, -2.0, 20e3], "below 0 kN (0 to 20)"),
        ] {
            assert_eq!(said(effect, name, value), words);
        }
    }
}
