//! Effects from a TOML file: a list of names with scope, severity and parameters.
//!
//! ```toml
//! [[effect]]
//! name = "arm-delay"
//! scope = "front"     # "all" unless given
//! severity = 0.5      # share of the way from neutral; 1 unless given
//! delay_s = 0.2
//! ```

use core::fmt::Write as _;
use std::path::{Path, PathBuf};

use serde::Deserialize;

use super::effect::{Effect, Parameter};
use super::{Effects, Scope, find};

/// A list of effects to add to a plant. Where two set the same number, the later one counts.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Overlay {
    /// The effects, in the order of the file.
    #[serde(default, rename = "effect")]
    pub entries: Vec<Entry>,
}

/// One effect of an overlay: a table that other files may hold as well.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(try_from = "toml::Table")]
pub struct Entry {
    /// Which effect.
    pub effect: &'static Effect,
    /// On which wheels.
    pub scope: Scope,
    /// Share of the way from neutral to the values given; 0 is the nominal plant.
    pub severity: f64,
    /// Parameters that are set; the others stay neutral.
    pub values: Vec<(&'static Parameter, f64)>,
}

/// Why an overlay was refused.
#[derive(Debug, thiserror::Error)]
pub enum OverlayError {
    /// The file could not be read.
    #[error("{path}: cannot read the overlay: {source}; give an existing file")]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// The text is not an overlay.
    #[error("{path}:{line}: {problem}")]
    Parse {
        /// The file.
        path: PathBuf,
        /// Line, from 1.
        line: usize,
        /// What is wrong there, and what to write instead.
        problem: String,
    },
}

impl Overlay {
    /// An overlay from a file.
    ///
    /// # Errors
    /// [`OverlayError`], with file, line and remedy.
    pub fn load(path: &Path) -> Result<Self, OverlayError> {
        let text = std::fs::read_to_string(path)
            .map_err(|source| OverlayError::Read { path: path.to_owned(), source })?;
        Self::parse(&text, path)
    }

    /// An overlay from TOML text; `path` only names it in errors.
    ///
    /// # Errors
    /// [`OverlayError::Parse`].
    pub fn parse(text: &str, path: &Path) -> Result<Self, OverlayError> {
        toml::from_str(text).map_err(|error| {
            let start = error.span().map_or(0, |span| span.start.min(text.len()));
            let line = text.as_bytes()[..start].iter().filter(|&&byte| byte == b'\n').count() + 1;
            let problem = error.message().replace('\n', " ");
            OverlayError::Parse { path: path.to_owned(), line, problem }
        })
    }

    /// The values of all its effects, neutral elsewhere.
    #[must_use]
    pub fn effects(&self) -> Effects {
        let mut effects = Effects::default();
        self.entries.iter().for_each(|entry| entry.apply(&mut effects));
        effects
    }

    /// The file that reads back as this overlay.
    #[must_use]
    pub fn to_toml(&self) -> String {
        let mut text = String::new();
        for entry in &self.entries {
            let _ = writeln!(text, "[[effect]]\nname = \"{}\"", entry.effect.name);
            if entry.effect.has_scope() {
                let _ = writeln!(text, "scope = \"{}\"", entry.scope);
            }
            if entry.severity != 1.0 {
                let _ = writeln!(text, "severity = {:?}", entry.severity);
            }
            for (parameter, value) in &entry.values {
                let _ = writeln!(text, "{} = {value:?}", parameter.name);
            }
            text.push('\n');
        }
        text
    }
}

impl TryFrom<toml::Table> for Entry {
    type Error = String;

    fn try_from(table: toml::Table) -> Result<Self, String> {
        let name = table.get("name").and_then(toml::Value::as_str);
        let name = name.ok_or("an effect needs a name = \"...\"")?;
        let effect = find(name).ok_or_else(|| {
            let names: Vec<&str> = super::CATALOGUE.iter().map(|effect| effect.name).collect();
            format!("\"{name}\" is no effect; known are {}", names.join(", "))
        })?;
        let mut entry = Self { effect, scope: Scope::All, severity: 1.0, values: Vec::new() };
        for (key, value) in &table {
            match key.as_str() {
                "name" => {}
                "scope" => {
                    let scope = value.as_str().ok_or("scope is a string, such as \"front\"")?;
                    entry.scope = scope.parse().map_err(|error| format!("{error}"))?;
                }
                "severity" => entry.severity = number(key, value, [0.0, 1.0])?,
                _ => {
                    let parameter = effect.parameter(key).ok_or_else(|| {
                        let names: Vec<&str> = effect.parameters.iter().map(|p| p.name).collect();
                        format!("{name} has no {key}; it has {}", names.join(", "))
                    })?;
                    entry.values.push((parameter, number(key, value, parameter.range)?));
                }
            }
        }
        if entry.scope != Scope::All && !effect.has_scope() {
            return Err(format!("{name} acts on the whole machine; leave out the scope"));
        }
        Ok(entry)
    }
}

impl Entry {
    /// Sets its parameters in `effects`.
    pub fn apply(&self, effects: &mut Effects) {
        for (parameter, value) in &self.values {
            let neutral = parameter.neutral;
            let value = if self.severity == 1.0 {
                *value
            } else {
                neutral + self.severity * (value - neutral)
            };
            parameter.set(effects, self.scope, value);
        }
    }
}

#[allow(clippy::cast_precision_loss)]
fn number(key: &str, value: &toml::Value, [low, high]: [f64; 2]) -> Result<f64, String> {
    let number = value.as_float().or_else(|| value.as_integer().map(|n| n as f64));
    match number {
        Some(number) if (low..=high).contains(&number) => Ok(number),
        Some(number) => Err(format!("{key} = {number} is outside {low} to {high}")),
        None => Err(format!("{key} is a number from {low} to {high}")),
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::effects::CATALOGUE;

    fn parse(text: &str) -> Result<Overlay, String> {
        Overlay::parse(text, Path::new("o.toml")).map_err(|error| error.to_string())
    }

    #[test]
    fn every_effect_reads_back_from_what_it_writes() {
        let entries = CATALOGUE.iter().map(|effect| Entry {
            effect,
            scope: Scope::All,
            severity: 0.25,
            values: effect.parameters.iter().map(|p| (p, p.range[1])).collect(),
        });
        let overlay = Overlay { entries: entries.collect() };
        let again = parse(&overlay.to_toml()).unwrap();
        assert_eq!(again.effects(), overlay.effects());
        assert_ne!(again.effects(), Effects::default());
    }

    #[test]
    fn severity_zero_is_the_nominal_plant() {
        let text =
            "[[effect]]\nname = \"arm-delay\"\nscope = \"front\"\nseverity = 0\ndelay_s = 0.2";
        assert_eq!(parse(text).unwrap().effects(), Effects::default());
    }

    #[test]
    fn a_bad_overlay_says_line_and_remedy() {
        for (text, says) in [
            (
                "\n[[effect]]\nname = \"arm-delya\"",
                "o.toml:2: \"arm-delya\" is no effect; known are",
            ),
            ("[[effect]]\nscope = \"all\"", "o.toml:1: an effect needs a name"),
            ("[[effect]]\nname = \"arm-delay\"\ndelay_ms = 2", "arm-delay has no delay_ms; it has"),
            ("[[effect]]\nname = \"arm-delay\"\ndelay_s = 7", "delay_s = 7 is outside 0 to 1"),
            ("[[effect]]\nname = \"arm-delay\"\nscope = \"top\"", "\"top\" is no scope"),
            ("[[efect]]\n", "o.toml:1: unknown field"),
        ] {
            let error = parse(text).unwrap_err();
            assert!(error.contains(says), "{error}");
        }
    }

    proptest! {
        #[test]
        fn any_text_is_an_overlay_or_an_error(text in "\\PC*") {
            let _ = parse(&text);
        }
    }
}
