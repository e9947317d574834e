//! The scenarios that come with the bench, by name.

use std::io;
use std::path::Path;

use crate::{Scenario, ScenarioError};

macro_rules! texts {
    ($($name:literal),* $(,)?) => {
        &[$(($name, include_str!(concat!("../scenarios/", $name, ".toml")))),*]
    };
}

/// Name and text of every built-in scenario, in the order a reader should meet them.
pub const BUILTIN: &[(&str, &str)] = texts!(
    "straight-25m",
    "turn-left",
    "turn-right",
    "s-turn",
    "arm-steps",
    "arm-step-response",
    "ramp",
    "ramp-locked",
    "ramp-automatic",
    "ramp-automatic-late",
    "cross-slope",
    "bumpy-field",
    "bumpy-field-locked",
    "kerb",
    "command-loss",
    "emergency-stop",
    "brown-out",
    "reboot",
    "broken-wire",
    "false-stroke",
    "2016-cross-slope",
    "2016-pedal",
    "2016-bend"
);

/// Name and text of the scripts that they play.
const SCRIPTS: &[(&str, &str)] = texts!(
    "s-turn.script",
    "arm-steps.script",
    "arm-step-response.script",
    "ramp-locked.script",
    "ramp-automatic.script",
    "ramp-automatic-late.script",
    "cross-slope.script",
    "bumpy-field.script",
    "bumpy-field-locked.script",
    "kerb.script",
    "brown-out.script",
    "false-stroke.script",
    "2016-cross-slope.operator",
    "2016-pedal.operator",
    "2016-bend.operator",
);

/// The text of a built-in script.
fn script(path: &Path) -> io::Result<String> {
    script_text(path).map(str::to_owned).ok_or_else(|| io::ErrorKind::NotFound.into())
}

fn script_text(path: &Path) -> Option<&'static str> {
    let named = |name: &str| path.to_str() == Some(&format!("{name}.toml"));
    SCRIPTS.iter().find(|(name, _)| named(name)).map(|(_, text)| *text)
}

/// Files of a built-in scenario, each with its text: the scenario's own first, then what it names beside it. None of one
/// that is not built in.
#[must_use]
pub fn files_of(name: &str) -> Vec<(String, &'static str)> {
    let own = BUILTIN.iter().find(|(built_in, _)| *built_in == name);
    let Some((Ok(scenario), (_, text))) = own.map(|own| (Scenario::find(own.0), own)) else {
        return Vec::new();
    };
    let named = [scenario.script.map(|script| script.path), scenario.operator];
    let beside = named.into_iter().flatten().filter_map(|path| {
        let text = script_text(&path)?;
        Some((path.to_str()?.to_owned(), text))
    });
    std::iter::once((format!("{name}.toml"), *text)).chain(beside).collect()
}

impl Scenario {
    /// The scenario `wanted`: a built-in name, or a path when it ends in `.toml` or has a `/`.
    ///
    /// # Errors
    /// [`ScenarioError`]; an unknown name is answered with the nearest one and the whole list.
    pub fn find(wanted: &str) -> Result<Self, ScenarioError> {
        if wanted.ends_with(".toml") || wanted.contains('/') {
            return Self::load(Path::new(wanted));
        }
        match BUILTIN.iter().find(|(name, _)| *name == wanted) {
            Some((name, text)) => Self::parse(text, Path::new(&format!("{name}.toml")), script),
            None => Err(ScenarioError::Unknown {
                name: wanted.to_owned(),
                nearest: nearest(wanted),
                known: BUILTIN.iter().map(|(name, _)| *name).collect::<Vec<_>>().join(", "),
            }),
        }
    }
}

/// The built-in name with the fewest edits from `wanted`, if those are few enough to be a slip.
fn nearest(wanted: &str) -> Option<&'static str> {
    BUILTIN
        .iter()
        .map(|&(name, _)| (edits(wanted, name), name))
        .filter(|&(edits, name)| edits <= name.len() / 2)
        .min()
        .map(|(_, name)| name)
}

/// Levenshtein distance, by the usual row of costs.
fn edits(a: &str, b: &str) -> usize {
    let mut row: Vec<usize> = (0..=b.chars().count()).collect();
    for (i, x) in a.chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, y) in b.chars().enumerate() {
            let replace = diagonal + usize::from(x != y);
            diagonal = row[j + 1];
            row[j + 1] = replace.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[b.chars().count()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_built_in_scenario_parses_and_expects_something() {
        for (name, _) in BUILTIN {
            let scenario = Scenario::find(name).unwrap_or_else(|error| panic!("{error}"));
            assert_eq!(scenario.name, *name);
            assert!(!scenario.expectations.is_empty(), "{name}");
        }
    }

    #[test]
    fn what_a_built_in_scenario_needs_is_among_its_files() {
        for (name, _) in BUILTIN {
            let folder = tempfile::tempdir().unwrap();
            let files = files_of(name);
            for (file, text) in &files {
                std::fs::write(folder.path().join(file), text).unwrap();
            }
            let scenario = Scenario::load(&folder.path().join(&files[0].0));
            let scenario = scenario.unwrap_or_else(|error| panic!("{error}"));
            assert_eq!(scenario.name, *name);
            let beside = [scenario.script.is_some(), scenario.operator.is_some()];
            assert_eq!(files.len(), 1 + beside.into_iter().filter(|is_there| *is_there).count());
        }
        assert!(files_of("no-such").is_empty());
    }

    #[test]
    fn a_slip_of_the_pen_is_answered_with_the_nearest_name() {
        let error = Scenario::find("straigt-25").unwrap_err().to_string();
        assert!(error.contains("did you mean `straight-25m`?"), "{error}");
        assert!(error.contains("command-loss"), "{error}");
        let error = Scenario::find("xyz").unwrap_err().to_string();
        assert!(!error.contains("did you mean"), "{error}");
        assert_eq!(edits("kitten", "sitting"), 3);
    }

    #[test]
    fn a_missing_file_is_named() {
        let error = Scenario::find("no/such.toml").unwrap_err().to_string();
        assert!(error.starts_with("no/such.toml: cannot read the scenario"), "{error}");
    }
}
