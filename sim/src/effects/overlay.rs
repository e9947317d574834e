//! Effects from a TOML file: a list of names with scope, severity and parameters.
//!
//! ```toml
//! [[effect]]
//! name = "arm-delay"
//! scope = "front"     # "all" unless given
//! severity = 0.5      # share of the way from the machine as it is; 1 unless given
//! delay_s = 0.2
//! ```
//!
//! One that adds nothing says so, `effect = []`: a file without a word of effects is more likely another file. An
//! entry that would do nothing is refused: without a value, or with those only that say where, when or how fast
//! another parameter acts, where no entry on its wheels sets that one.

use core::fmt::Write as _;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::Deserialize;
use toml::{Spanned, Value};
use xt28_machine::Machine;

use super::effect::{Effect, Parameter};
use super::{Effects, Scope, find};

/// A list of effects to add to a plant. Where two set the same number, the later one counts.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Overlay {
    /// The effects, in the order of the file.
    pub entries: Vec<Entry>,
}

/// The keys of one effect and where each has its value.
type DraftEntry = BTreeMap<String, Spanned<Value>>;

/// The file of an overlay, before anyone asked what its keys mean.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Draft {
    effect: Option<Vec<Spanned<DraftEntry>>>,
}

/// One effect of an overlay: a table that other files may hold as well.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(try_from = "toml::Table")]
pub struct Entry {
    /// Which effect.
    pub effect: &'static Effect,
    /// On which wheels.
    pub scope: Scope,
    /// Share of the way from the machine file's machine to the values given; 0 is that machine.
    pub severity: f64,
    /// Parameters that are set; the others stay neutral.
    pub values: Vec<(&'static Parameter, f64)>,
}

/// Why an overlay was refused.
#[derive(Debug, thiserror::Error)]
pub enum OverlayError {
    /// The file could not be read.
    #[error("{path}: cannot read the overlay: {source}; give a text file that exists")]
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
    /// More load than the machine file allows.
    #[error(
        "payload: mass_kg = {mass_kg} is more than this machine carries; its machine file has \
         masses.load_max_kg = {load_max_kg}"
    )]
    Overloaded {
        /// The load, kg.
        mass_kg: f64,
        /// The most, kg.
        load_max_kg: f64,
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
        let refuse = |start: usize, problem: String| {
            let before = &text.as_bytes()[..start.min(text.len())];
            let line = before.iter().filter(|&&byte| byte == b'\n').count() + 1;
            OverlayError::Parse { path: path.to_owned(), line, problem }
        };
        let draft: Draft = toml::from_str(text).map_err(|error| {
            let start = error.span().map_or(0, |span| span.start);
            let problem = error.message().replace('\n', " ");
            let single = text.get(start..).is_some_and(|rest| rest.starts_with("[effect]"));
            refuse(start, if single { format!("{problem}; write [[effect]]") } else { problem })
        })?;
        let listed = draft.effect.ok_or_else(|| {
            let problem = "no [[effect]] in this file; write effect = [] where none is meant";
            refuse(0, problem.to_owned())
        })?;
        let entry = |draft: &Spanned<DraftEntry>| {
            let table = draft.get_ref();
            let values = table.iter().map(|(key, value)| (key.as_str(), value.get_ref()));
            Entry::of(&values.collect()).map_err(|Refusal { key, problem }| {
                let at_key = key.and_then(|key| table.get(&key)).map(|value| value.span().start);
                refuse(at_key.unwrap_or(draft.span().start), problem)
            })
        };
        let entries = listed.iter().map(entry).collect::<Result<Vec<_>, _>>()?;
        if let Some((at, problem)) = Entry::idle(&entries) {
            return Err(refuse(listed[at].span().start, problem));
        }
        Ok(Self { entries })
    }

    /// The values of all its effects on this machine, neutral elsewhere.
    ///
    /// # Errors
    /// [`OverlayError::Overloaded`]: the machine file has the largest load (paper, table of the machine).
    pub fn effects(&self, machine: &Machine) -> Result<Effects, OverlayError> {
        let mut effects = Effects::none_on(machine);
        self.entries.iter().for_each(|entry| entry.apply(machine, &mut effects));
        let (mass_kg, load_max_kg) = (effects.masses.payload.mass_kg, machine.masses.load_max_kg);
        if mass_kg > load_max_kg {
            return Err(OverlayError::Overloaded { mass_kg, load_max_kg });
        }
        Ok(effects)
    }

    /// The file that reads back as this overlay.
    #[must_use]
    pub fn to_toml(&self) -> String {
        if self.entries.is_empty() {
            return "effect = []\n".to_owned();
        }
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
        let values = table.iter().map(|(key, value)| (key.as_str(), value));
        Self::of(&values.collect()).map_err(|refusal| refusal.problem)
    }
}

/// What is wrong with an entry, and at which of its keys; `None` where one is missing.
struct Refusal {
    key: Option<String>,
    problem: String,
}

impl Entry {
    fn of(table: &BTreeMap<&str, &Value>) -> Result<Self, Refusal> {
        let whole = |problem: String| Refusal { key: None, problem };
        let at = |key: &str, problem: String| Refusal { key: Some(key.to_owned()), problem };
        let name = table.get("name").and_then(|name| name.as_str());
        let name = name.ok_or_else(|| whole("an effect needs a name = \"...\"".to_owned()))?;
        let effect = find(name).ok_or_else(|| {
            let names: Vec<&str> = super::CATALOGUE.iter().map(|effect| effect.name).collect();
            at("name", format!("\"{name}\" is no effect; known are {}", names.join(", ")))
        })?;
        let mut entry = Self { effect, scope: Scope::All, severity: 1.0, values: Vec::new() };
        let parameters = || effect.parameters.iter().map(|p| p.name).collect::<Vec<_>>().join(", ");
        for (&key, &value) in table {
            match key {
                "name" => {}
                "scope" => entry.scope = scope(value).map_err(|problem| at(key, problem))?,
                "severity" => {
                    entry.severity =
                        number(key, value, [0.0, 1.0]).map_err(|problem| at(key, problem))?;
                }
                _ => {
                    let parameter = effect.parameter(key).ok_or_else(|| {
                        at(key, format!("{name} has no {key}; it has {}", parameters()))
                    })?;
                    let number =
                        number(key, value, parameter.range).map_err(|problem| at(key, problem))?;
                    entry.values.push((parameter, number));
                }
            }
        }
        if entry.scope != Scope::All && !effect.has_scope() {
            let problem = format!("{name} acts on the whole machine; leave out the scope");
            return Err(at("scope", problem));
        }
        if entry.values.is_empty() {
            let problem = format!("{name} has no value here and would do nothing; it has");
            return Err(whole(format!("{problem} {}", parameters())));
        }
        Ok(entry)
    }

    /// What `said` of a parameter comes to at this severity.
    fn value(&self, machine: &Machine, parameter: &Parameter, said: f64) -> f64 {
        if self.severity == 0.0 {
            return parameter.neutral;
        }
        let own = parameter.neutral_on(machine);
        let value = if self.severity == 1.0 { said } else { own + self.severity * (said - own) };
        // Neutral stands for the machine's own number. Where that is another, who says the very number
        // means it: a last bit more says so.
        let is_said = value == parameter.neutral && value != own;
        if is_said { value.next_up() } else { value }
    }

    /// Sets its parameters in `effects`, which are those of this machine.
    pub fn apply(&self, machine: &Machine, effects: &mut Effects) {
        for (parameter, value) in &self.values {
            parameter.set(effects, self.scope, self.value(machine, parameter, *value));
        }
    }
}

fn scope(value: &Value) -> Result<Scope, String> {
    let scope = value.as_str().ok_or("scope is a string, such as \"front\"")?;
    scope.parse().map_err(|error| format!("{error}"))
}

#[allow(clippy::cast_precision_loss)]
fn number(key: &str, value: &Value, [low, high]: [f64; 2]) -> Result<f64, String> {
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
        let machine = Machine::xt28();
        let [again, overlay] = [again, overlay].map(|o| o.effects(&machine).unwrap());
        assert_eq!(again, overlay);
        assert_ne!(again, Effects::default());
    }

    #[test]
    fn an_effect_in_single_brackets_is_told_of_the_double_ones() {
        let error = parse("\n[effect]\nname = \"arm-delay\"\ndelay_s = 0.2\n").unwrap_err();
        assert!(error.starts_with("o.toml:2:") && error.ends_with("write [[effect]]"), "{error}");
    }

    #[test]
    fn none_is_said_and_a_file_that_says_nothing_is_refused() {
        let none = Overlay::default();
        assert_eq!(parse(&none.to_toml()).unwrap(), none);
        for text in ["", "# a note\n"] {
            let error = parse(text).unwrap_err();
            assert!(error.starts_with("o.toml:1: no [[effect]] in this file"), "{error}");
            assert!(error.ends_with("effect = [] where none is meant"), "{error}");
        }
    }

    #[test]
    fn severity_zero_is_the_nominal_plant() {
        let text =
            "[[effect]]\nname = \"arm-delay\"\nscope = \"front\"\nseverity = 0\ndelay_s = 0.2";
        let effects = parse(text).unwrap().effects(&Machine::xt28()).unwrap();
        assert_eq!(effects, Effects::default());
    }

    #[test]
    fn more_than_the_machine_carries_is_refused() {
        let mut machine = Machine::xt28();
        machine.masses.load_max_kg = 8000.0;
        let payload = |severity: f64| {
            let text = "[[effect]]\nname = \"payload\"\nmass_kg = 14000\nseverity =";
            parse(&format!("{text} {severity}")).unwrap()
        };
        assert_eq!(payload(0.5).effects(&machine).unwrap().masses.payload.mass_kg, 7000.0);
        assert!(payload(1.0).effects(&Machine::xt28()).is_ok());
        let error = payload(1.0).effects(&machine).unwrap_err().to_string();
        assert!(error.starts_with("payload: mass_kg = 14000 is more"), "{error}");
        assert!(error.ends_with("masses.load_max_kg = 8000"), "{error}");
    }

    #[test]
    fn a_bad_overlay_says_line_and_remedy() {
        const DELAY: &str = "[[effect]]\nname = \"arm-delay\"\n";
        let twice = format!("{DELAY}delay_s = 0.1\n\n{DELAY}");
        for (text, says) in [
            (
                "\n[[effect]]\nname = \"arm-delya\"",
                "o.toml:3: \"arm-delya\" is no effect; known are",
            ),
            ("[[effect]]\nscope = \"all\"", "o.toml:1: an effect needs a name"),
            (&format!("{DELAY}delay_ms = 2"), "o.toml:3: arm-delay has no delay_ms; it has"),
            (&format!("{DELAY}delay_s = 7"), "o.toml:3: delay_s = 7 is outside 0 to 1"),
            (&format!("{DELAY}scope = \"top\""), "o.toml:3: \"top\" is no scope"),
            (
                &format!("{twice}scope = \"front\"\nseverity = 2\n"),
                "o.toml:8: severity = 2 is outside",
            ),
            (
                &format!("{twice}scope = \"front\"\n"),
                "o.toml:5: arm-delay has no value here and would do nothing; it has delay_s",
            ),
            (
                "[[effect]]\nname = \"payload\"\nmass_kg = 10\nscope = \"front\"",
                "o.toml:4: payload acts on the whole machine",
            ),
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
