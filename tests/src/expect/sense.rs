//! What the numbers of an expectation can be: an expectation that nothing can meet, or that looks where no
//! run is, is a slip of the pen.

use toml::{Table, Value};

/// The first expectation of a scenario's `text` whose numbers make no sense in a run of `duration_s` s: its
/// name, and what is wrong.
pub(crate) fn problem(text: &str, duration_s: f64) -> Option<(String, String)> {
    let scenario: Table = toml::from_str(text).ok()?;
    let expectations = scenario.get("expect")?.as_array()?.iter().filter_map(Value::as_table);
    expectations.flatten().find_map(|(name, keys)| {
        let problem = of_keys(keys.as_table()?, duration_s)?;
        Some((name.clone(), problem))
    })
}

fn of_keys(keys: &Table, duration_s: f64) -> Option<String> {
    keys.iter().find_map(|(key, value)| {
        if value.as_array().is_some_and(Vec::is_empty) {
            return Some(format!("{key} = [] must name at least one"));
        }
        let numbers = match value {
            Value::Array(list) => list.iter().filter_map(number).collect(),
            one => number(one).into_iter().collect::<Vec<_>>(),
        };
        numbers.into_iter().find_map(|value| of_number(keys, (key, value), duration_s))
    })
}

fn of_number(keys: &Table, (key, value): (&str, f64), duration_s: f64) -> Option<String> {
    const NOT_BELOW_ZERO: [&str; 5] = ["within", "below", "end_within", "overshoot", "steady"];
    let must = |what: String| Some(format!("{key} = {value} must be {what}"));
    if !value.is_finite() {
        return must("finite".to_owned());
    }
    if value < 0.0 && NOT_BELOW_ZERO.iter().any(|start| key.starts_with(start)) {
        return must("at least zero".to_owned());
    }
    if ["from_s", "to_s", "over_s"].contains(&key) && !(0.0..=duration_s).contains(&value) {
        return must(format!("within the run, 0 to {duration_s}"));
    }
    let to = key.strip_prefix("from").map(|unit| format!("to{unit}"))?;
    let end = keys.get(&to).and_then(number)?;
    if value > end { must(format!("at most {to} = {end}")) } else { None }
}

#[allow(clippy::cast_precision_loss)] // Nobody writes such integers.
fn number(value: &Value) -> Option<f64> {
    value.as_float().or_else(|| value.as_integer().map(|whole| whole as f64))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_that_no_run_can_meet_is_found() {
        let of = |keys: &str| {
            problem(&format!("[[expect]]\nstands-still = {{ {keys} }}"), 45.0)
                .map_or_else(String::new, |(name, problem)| format!("{name}: {problem}"))
        };
        for sound in ["below_m_s = 0.02", "from_s = 1, to_s = 45", "roll_deg = -5.0", "x_m = -3"] {
            assert_eq!(of(sound), "", "{sound}");
        }
        for (keys, wanted) in [
            ("below_m_s = nan", "stands-still: below_m_s = NaN must be finite"),
            ("within_m = -1", "stands-still: within_m = -1 must be at least zero"),
            ("wheels = []", "stands-still: wheels = [] must name at least one"),
            ("to_s = 500", "stands-still: to_s = 500 must be within the run, 0 to 45"),
            ("rise_s = [0.1, inf]", "stands-still: rise_s = inf must be finite"),
            ("from_kn = 9.5, to_kn = 2", "stands-still: from_kn = 9.5 must be at most to_kn = 2"),
        ] {
            assert_eq!(of(keys), wanted);
        }
    }
}
