//! What a diagnosis said of one machine, as a row of a table.

use std::fs;
use std::path::Path;

use serde_json::Value;
use toml::Table;

use crate::workspace::Outcome;

/// A diagnosis read back.
pub(super) struct Verdict(Value);

impl Verdict {
    /// Above the rows.
    pub(super) const HEADING: &'static str = "| machine | said | likeliest | probability | sizes: true, found [90 %] |\n|---|---|---|---|---|";

    /// Reads what `xt28 gap diagnose --json` wrote.
    ///
    /// # Errors
    /// When there is no such file, or it is no JSON.
    pub(super) fn read(path: &Path) -> Outcome<Self> {
        Ok(Self(serde_json::from_slice(&fs::read(path)?)?))
    }

    /// Whether `effect` stands first and is believed.
    pub(super) fn names(&self, effect: &str) -> bool {
        self.first()["effect"] == effect && self.probability() > 0.5
    }

    /// Whether an effect is believed that is not `effect`, of a machine that has that one or none.
    pub(super) fn is_wrong(&self, effect: Option<&str>) -> bool {
        self.probability() > 0.5 && effect.is_none_or(|effect| !self.names(effect))
    }

    /// A row of the table, of the machine called `label` with the sizes of `overlay`.
    pub(super) fn row(&self, label: &str, overlay: Option<&Table>) -> String {
        let (first, said) = (self.first(), self.0["verdict"].as_str().unwrap_or("?"));
        let word = |name: &str| first[name].as_str().unwrap_or("-");
        let sizes: Vec<String> = overlay
            .into_iter()
            .flatten()
            .filter_map(|(name, value)| {
                Some(size(name, number(value)?, &first["parameters"][name]))
            })
            .collect();
        format!(
            "| {label} | {said} | {} {} | {:.2} | {} |",
            word("effect"),
            word("scope"),
            self.probability(),
            sizes.join("; ")
        )
    }

    fn first(&self) -> &Value {
        &self.0["causes"][0]
    }

    fn probability(&self) -> f64 {
        self.first()["probability"].as_f64().unwrap_or(0.0)
    }
}

/// A number of an overlay.
#[allow(clippy::cast_precision_loss)] // as written by hand
fn number(value: &toml::Value) -> Option<f64> {
    value.as_float().or_else(|| value.as_integer().map(|whole| whole as f64))
}

/// A size that is true, beside the one found with its interval.
fn size(name: &str, is: f64, found: &Value) -> String {
    let show = |k: usize| found[k].as_f64().map_or_else(|| "-".to_owned(), short);
    format!("{name} {}, {} [{} {}]", short(is), show(0), show(1), show(2))
}

/// Three digits, whatever the size.
fn short(number: f64) -> String {
    match number.abs() {
        0.0 => "0".to_owned(),
        size if !(0.001..100_000.0).contains(&size) => format!("{number:.2e}"),
        size => {
            let digits = 2.0 - size.log10().floor();
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // 0 to 5
            let digits = digits.clamp(0.0, 5.0) as usize;
            format!("{number:.digits$}")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn verdict(effect: &str, probability: f64) -> Verdict {
        let first = serde_json::json!({
            "effect": effect, "scope": "front", "probability": probability,
            "parameters": { "delay_s": [0.2218, 0.2014, 0.2422] },
        });
        Verdict(serde_json::json!({ "verdict": "effect", "causes": [first] }))
    }

    #[test]
    fn a_name_is_wrong_where_it_is_believed_of_a_machine_that_has_another_or_none() {
        let believed = verdict("arm-delay", 0.9);
        assert!(believed.names("arm-delay") && !believed.is_wrong(Some("arm-delay")));
        assert!(believed.is_wrong(Some("valve-lag")) && believed.is_wrong(None));
        let doubted = verdict("arm-delay", 0.4);
        assert!(!doubted.names("arm-delay") && !doubted.is_wrong(None));
    }

    #[test]
    fn a_row_has_each_size_beside_what_was_found() {
        let overlay = "name = \"arm-delay\"\nscope = \"front\"\ndelay_s = 0.22".parse().unwrap();
        let row = verdict("arm-delay", 0.9).row("arm-delay front", Some(&overlay));
        let want = "| arm-delay front | effect | arm-delay front | 0.90 | delay_s 0.220, 0.222 [0.201 0.242] |";
        assert_eq!(row, want);
    }

    #[test]
    fn numbers_have_three_digits() {
        assert_eq!(
            [0.0, 0.22, 5e6, 8e-6, 4500.0, 1.6e-3].map(short),
            ["0", "0.220", "5.00e6", "8.00e-6", "4500", "0.00160"]
        );
    }
}
