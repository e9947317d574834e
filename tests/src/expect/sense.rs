//! What the numbers of an expectation can be: an expectation that nothing can meet, or that looks where no
//! run is, is a slip of the pen.

use toml::{Table, Value};

use crate::places::{Places, line_at};

/// The first expectation of a scenario's `text` whose numbers make no sense in a run of `duration_s` s: its
/// line, and what is wrong.
pub(crate) fn problem(text: &str, duration_s: f64) -> Option<(usize, String)> {
    Places::of(text).expect.iter().flatten().find_map(|(name, keys)| {
        let problem = of_keys(name.get_ref(), keys.as_table()?, duration_s)?;
        Some((line_at(text, name.span().start), format!("{}: {problem}", name.get_ref())))
    })
}

fn of_keys(name: &str, keys: &Table, duration_s: f64) -> Option<String> {
    keys.iter().find_map(|(key, value)| {
        if value.as_array().is_some_and(Vec::is_empty) {
            return Some(format!("{key} = [] must name at least one"));
        }
        if let ("states", Some(state)) = (key.as_str(), stays(value)) {
            return Some(format!(
                "{key} has {state:?} twice in a row, and each counts once when it is entered"
            ));
        }
        let numbers = match value {
            Value::Array(list) => list.iter().filter_map(number).collect(),
            one => number(one).into_iter().collect::<Vec<_>>(),
        };
        let sense = |value: &f64| {
            of_limit(name, key, *value).or_else(|| of_number(keys, (key, *value), duration_s))
        };
        if let Some(problem) = numbers.iter().find_map(sense) {
            return Some(problem);
        }
        // A list of numbers is least and greatest.
        let falls = numbers.windows(2).find(|pair| pair[0] > pair[1])?;
        Some(format!("{key} = [{}, {}] must not fall", falls[0], falls[1]))
    })
}

/// The name that a list has twice in a row.
fn stays(value: &Value) -> Option<&str> {
    let same = value.as_array()?.windows(2).find(|pair| pair[0].is_str() && pair[0] == pair[1])?;
    same[0].as_str()
}

/// What a number cannot be in this expectation, though it may in another.
fn of_limit(name: &str, key: &str, value: f64) -> Option<String> {
    match (name, key) {
        ("stays-level", "roll_deg" | "pitch_deg") if value < 0.0 => {
            Some(format!("{key} = {value} must be at least zero: it is the limit either way"))
        }
        ("stands-still", "over_s") if value <= 0.0 => {
            Some(format!("{key} = {value} must be above zero: an instant shows no standing"))
        }
        _ => None,
    }
}

fn of_number(keys: &Table, (key, value): (&str, f64), duration_s: f64) -> Option<String> {
    const NOT_BELOW_ZERO: [&str; 6] =
        ["within", "below", "end_within", "overshoot", "steady", "at_most"];
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
    let unit = key.strip_prefix("from")?;
    let limits = [format!("to{unit}"), format!("below{unit}")];
    limits.iter().find_map(|limit| {
        let end = keys.get(limit).and_then(number)?;
        if value > end { must(format!("at most {limit} = {end}")) } else { None }
    })
}

#[allow(clippy::cast_precision_loss)] // Nobody writes such integers.
fn number(value: &Value) -> Option<f64> {
    value.as_float().or_else(|| value.as_integer().map(|whole| whole as f64))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_limit_that_nothing_keeps_is_found_where_it_is_one() {
        let of = |expectation: &str| {
            problem(&format!("[[expect]]\n{expectation}"), 45.0)
                .map_or_else(String::new, |(_, problem)| problem)
        };
        for (expectation, wanted) in [
            (
                "stays-level = { roll_deg = -2, pitch_deg = 2 }",
                "stays-level: roll_deg = -2 must be at least zero",
            ),
            (
                "stays-level = { roll_deg = 2, pitch_deg = -0.5 }",
                "stays-level: pitch_deg = -0.5 must be at least",
            ),
            ("stands-still = { over_s = 0 }", "stands-still: over_s = 0 must be above zero"),
            ("stands-still = { over_s = -1 }", "stands-still: over_s = -1 must be above zero"),
        ] {
            assert!(of(expectation).starts_with(wanted), "{}", of(expectation));
        }
        assert_eq!(of("leans = { roll_deg = -2, within_deg = 1 }"), "");
        assert_eq!(of("stays-level = { roll_deg = 0, pitch_deg = 2 }"), "");
    }

    #[test]
    fn a_number_that_no_run_can_meet_is_found() {
        let of = |keys: &str| {
            problem(&format!("[[expect]]\nstands-still = {{ {keys} }}"), 45.0)
                .map_or_else(String::new, |(_, problem)| problem)
        };
        for sound in [
            "below_m_s = 0.02",
            "from_s = 1, to_s = 45",
            "roll_deg = -5.0",
            "x_m = -3",
            "from_kn = 2, to_kn = 2",
            "rise_s = [1.0, 1.0]",
            r#"states = ["standby", "active", "standby"]"#,
        ] {
            assert_eq!(of(sound), "", "{sound}");
        }
        for (keys, wanted) in [
            ("below_m_s = nan", "stands-still: below_m_s = NaN must be finite"),
            ("within_m = -1", "stands-still: within_m = -1 must be at least zero"),
            ("wheels = []", "stands-still: wheels = [] must name at least one"),
            ("to_s = 500", "stands-still: to_s = 500 must be within the run, 0 to 45"),
            ("over_s = 46", "stands-still: over_s = 46 must be within the run, 0 to 45"),
            ("rise_s = [0.1, inf]", "stands-still: rise_s = inf must be finite"),
            ("from_kn = 9.5, to_kn = 2", "stands-still: from_kn = 9.5 must be at most to_kn = 2"),
            ("from = 0.3, below = 0.2", "stands-still: from = 0.3 must be at most below = 0.2"),
            ("at_most_kn = -1", "stands-still: at_most_kn = -1 must be at least zero"),
            ("rise_s = [1.2, 0.9]", "stands-still: rise_s = [1.2, 0.9] must not fall"),
            (
                r#"states = ["standby", "active", "active"]"#,
                "stands-still: states has \"active\" twice in a row, and each counts once when it is entered",
            ),
        ] {
            assert_eq!(of(keys), wanted);
        }
    }
}
