//! What goes wrong with the machine's electrics in a run, as a TOML file says it.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use crate::power::PowerEvent;
use crate::sensor_faults::SensorFault;

/// Faults of sensors and events of the supply.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Mishaps {
    /// Sensors that fail.
    #[serde(default, rename = "fault", skip_serializing_if = "Vec::is_empty")]
    pub faults: Vec<SensorFault>,
    /// What befalls the supply.
    #[serde(default, rename = "event", skip_serializing_if = "Vec::is_empty")]
    pub events: Vec<PowerEvent>,
}

/// Why a file of mishaps is refused.
#[derive(Debug, thiserror::Error)]
pub enum MishapsError {
    /// It cannot be read.
    #[error("{path}: cannot read the mishaps: {source}")]
    Read {
        /// The file.
        path: PathBuf,
        /// Why not.
        source: std::io::Error,
    },
    /// It is no such file.
    #[error("{path}:{line}: {problem}")]
    Parse {
        /// The file.
        path: PathBuf,
        /// Where, from 1.
        line: usize,
        /// What is wrong, in one line.
        problem: String,
    },
    /// An entry makes no sense.
    #[error("{path}: {entry} {number}: {problem}")]
    Entry {
        /// The file.
        path: PathBuf,
        /// `fault` or `event`.
        entry: &'static str,
        /// Which of them, from 1.
        number: usize,
        /// What is wrong, and the remedy.
        problem: String,
    },
}

impl Mishaps {
    /// Mishaps from a file.
    ///
    /// # Errors
    /// [`MishapsError`].
    pub fn load(path: &Path) -> Result<Self, MishapsError> {
        let text = std::fs::read_to_string(path)
            .map_err(|source| MishapsError::Read { path: path.to_owned(), source })?;
        Self::parse(&text, path)
    }

    /// Mishaps from text; `path` stands in errors.
    ///
    /// # Errors
    /// [`MishapsError::Parse`], [`MishapsError::Entry`].
    pub fn parse(text: &str, path: &Path) -> Result<Self, MishapsError> {
        let mishaps: Self = toml::from_str(text).map_err(|error| {
            let before = error.span().map_or("", |span| &text[..span.start.min(text.len())]);
            let line = before.matches('\n').count() + 1;
            let problem = error.message().lines().collect::<Vec<_>>().join("; ");
            MishapsError::Parse { path: path.to_owned(), line, problem }
        })?;
        let entry = |entry, number: usize, problem| MishapsError::Entry {
            path: path.to_owned(),
            entry,
            number: number + 1,
            problem,
        };
        for (i, fault) in mishaps.faults.iter().enumerate() {
            fault.check().map_err(|problem| entry("fault", i, problem))?;
        }
        for (i, event) in mishaps.events.iter().enumerate() {
            event.check().map_err(|problem| entry("event", i, problem))?;
        }
        Ok(mishaps)
    }

    /// Nothing goes wrong.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.faults.is_empty() && self.events.is_empty()
    }

    /// The same as a file would have it.
    #[must_use]
    pub fn to_toml(&self) -> String {
        toml::to_string(self).unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = r#"
[[fault]]
sensor = "stroke"
wheel = "FR"
kind = "offset"
by_mv = 100.0
from_s = 5.0

[[event]]
at_s = 6.0
kind = "brown-out"
ecu = "SMS"
for_s = 0.2
"#;

    fn parse(text: &str) -> Result<Mishaps, MishapsError> {
        Mishaps::parse(text, Path::new("a/mishaps.toml"))
    }

    #[test]
    fn a_file_is_read_and_written_again() {
        let mishaps = parse(TEXT).unwrap();
        assert_eq!((mishaps.faults.len(), mishaps.events.len()), (1, 1));
        assert_eq!(parse(&mishaps.to_toml()).unwrap(), mishaps);
    }

    #[test]
    fn a_bad_file_is_refused_in_one_line_with_its_place() {
        let cases = [
            ("by_mv", "by_v", "a/mishaps.toml:6: unknown field `by_v`"),
            ("\"FR\"", "\"RF\"", "a/mishaps.toml:4: no wheel `RF`"),
            ("from_s = 5.0", "from_s = -5.0", "a/mishaps.toml: fault 1: from_s = -5"),
            ("\"SMS\"", "\"ABS\"", "a/mishaps.toml:12: unknown variant `ABS`"),
            ("for_s = 0.2", "for_s = 0", "a/mishaps.toml: event 1: for_s = 0"),
        ];
        for (from, to, starts) in cases {
            let error = parse(&TEXT.replace(from, to)).unwrap_err().to_string();
            assert!(error.starts_with(starts) && !error.contains('\n'), "{error}");
        }
    }
}
