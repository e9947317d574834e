//! `about.toml`: what is known of a set of logs, foremost the ground each was driven on.

use std::path::Path;

use serde::{Deserialize, Deserializer};
use toml::value::Datetime;
use xt28_sim::{Ramp, Terrain};

use crate::GapError;
use crate::toml_error::locate;

/// What is known of one machine's logs.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct About {
    /// Name of the case; empty where nobody gave one.
    #[serde(default)]
    pub case: String,
    /// Day of the runs, as written: a date, or words.
    #[serde(default, deserialize_with = "day")]
    pub date: Option<String>,
    /// The machine, in words.
    pub machine: Option<String>,
    /// Machine file that it is believed to be.
    pub nominal: Option<String>,
    /// Text on how the machine reads its sensors.
    pub conventions: Option<String>,
    /// DBC that the logs were sent with.
    pub dbc: Option<String>,
    /// The logs.
    pub run: Vec<Run>,
    #[serde(skip)]
    text: String,
}

/// One log.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Run {
    /// File name, beside `about.toml`, with folders before it where two logs have one name.
    pub file: String,
    /// What was driven.
    pub scenario: Option<String>,
    /// Length, s.
    pub seconds: Option<f64>,
    /// What it was driven on.
    pub terrain: Ground,
    /// The ramp, where the terrain is one.
    pub ramp: Option<Ramp>,
    /// Recommended for fitting, rather than for validation.
    #[serde(default)]
    pub fit: bool,
}

/// Kind of terrain.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Ground {
    /// Level.
    Flat,
    /// A ramp under one side, level elsewhere.
    Ramp,
}

impl About {
    /// Reads the file at `path`.
    ///
    /// # Errors
    /// [`GapError::Read`] or [`GapError::Toml`].
    pub fn load(path: &Path) -> Result<Self, GapError> {
        let text = std::fs::read_to_string(path).map_err(|source| GapError::read(path, source))?;
        Self::parse(&text, path)
    }

    /// Reads `text`; `path` names it in errors.
    ///
    /// # Errors
    /// [`GapError::Toml`], also for a ramp without its stations, stations without a ramp, or two
    /// descriptions of one file.
    pub fn parse(text: &str, path: &Path) -> Result<Self, GapError> {
        let refuse = |(line, problem)| GapError::Toml { path: path.to_owned(), line, problem };
        let mut about: Self = toml::from_str(text).map_err(|error| refuse(locate(text, &error)))?;
        for (i, run) in about.run.iter().enumerate() {
            if about.run[..i].iter().any(|before| before.file == run.file) {
                let lines = text.lines().enumerate().filter(|(_, line)| line.contains(&run.file));
                let line = lines.map(|(line, _)| line + 1).nth(1).unwrap_or(1);
                let problem = format!(
                    "run {} is described twice; which ground is it? keep one of the two [[run]]",
                    run.file
                );
                return Err(refuse((line, problem)));
            }
            if let Err(problem) = run.terrain() {
                let line = text.lines().position(|line| line.contains(&run.file));
                let problem = format!("run {}: {problem}", run.file);
                return Err(refuse((line.map_or(1, |line| line + 1), problem)));
            }
        }
        about.text = text.to_owned();
        Ok(about)
    }

    /// The run whose log has the file name of `log`, and its folders as far as it names them; the one that names
    /// most of them.
    #[must_use]
    pub fn run_of(&self, log: &Path) -> Option<&Run> {
        let named = self.run.iter().filter(|run| log.ends_with(&run.file));
        named.max_by_key(|run| Path::new(&run.file).components().count())
    }

    /// Line, from 1, at which `key` of `run` is said; where that is not found, the run's own.
    pub(crate) fn line_of(&self, run: &Run, key: &str) -> usize {
        let lines = || self.text.lines().enumerate().map(|(k, line)| (k + 1, line.trim_start()));
        let file = lines().find(|(_, line)| line.contains(&format!("\"{}\"", run.file)));
        let at = file.map_or(1, |(line, _)| line);
        let begins = lines().filter(|(line, text)| *line <= at && text.starts_with("[[")).last();
        let ends = lines().find(|(line, text)| *line > at && text.starts_with("[["));
        let within = begins.map_or(0, |(line, _)| line)..ends.map_or(usize::MAX, |(line, _)| line);
        let is_key = |text: &str| {
            text.strip_prefix(key).is_some_and(|rest| rest.trim_start().starts_with('='))
        };
        let said = lines().find(|(line, text)| within.contains(line) && is_key(text));
        said.map_or(at, |(line, _)| line)
    }

    /// The ground that `log` was driven on, as the file at `path` says.
    ///
    /// # Errors
    /// [`GapError::Read`], [`GapError::Toml`] or [`GapError::NoRun`].
    pub fn terrain_of(path: &Path, log: &Path) -> Result<Terrain, GapError> {
        let about = Self::load(path)?;
        let run = about.run_of(log).ok_or_else(|| GapError::NoRun {
            path: path.to_owned(),
            log: log.file_name().unwrap_or_default().to_string_lossy().into_owned(),
        })?;
        run.terrain().map_err(|problem| GapError::Toml {
            path: path.to_owned(),
            line: 1,
            problem: problem.to_owned(),
        })
    }
}

impl Run {
    /// The ground as the simulator has it.
    ///
    /// # Errors
    /// A sentence on what is missing or no ramp.
    pub fn terrain(&self) -> Result<Terrain, &'static str> {
        match (self.terrain, &self.ramp) {
            (Ground::Flat, None) => Ok(Terrain::Flat),
            (Ground::Flat, Some(_)) => Err("terrain = \"flat\" has no ramp; remove one of the two"),
            (Ground::Ramp, None) => {
                Err("terrain = \"ramp\" needs ramp = { x_m, height_m, y_min_m, y_max_m }")
            }
            (Ground::Ramp, Some(ramp)) => ramp.check().map(|()| Terrain::ramp(ramp)),
        }
    }
}

/// A day that TOML knows for one, or in words.
#[derive(Deserialize)]
#[serde(
    untagged,
    expecting = "`date` is neither a date, as 2026-05-14, nor words in quotes, as \"14 May\""
)]
enum Day {
    Date(Datetime),
    Words(String),
}

/// Reads a day; of a time of day alone nobody knows which day it was.
fn day<'de, D: Deserializer<'de>>(from: D) -> Result<Option<String>, D::Error> {
    match Day::deserialize(from)? {
        Day::Date(date) if date.date.is_none() => Err(serde::de::Error::custom(format!(
            "`date` is the time of day {date}, and of which day? write a date, as 2026-05-14"
        ))),
        Day::Date(date) => Ok(Some(date.to_string())),
        Day::Words(words) => Ok(Some(words)),
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const ABOUT: &str = r#"
case = "one"
dbc = "a.dbc"
[[run]]
file = "flat.log.gz"
terrain = "flat"
fit = true
[[run]]
file = "ramp.log"
terrain = "ramp"
ramp = { x_m = [4, 7, 8.5, 11.5], height_m = 0.3, y_min_m = -1.9, y_max_m = -0.5 }
"#;

    fn parse(text: &str) -> Result<About, GapError> {
        About::parse(text, Path::new("about.toml"))
    }

    #[test]
    fn finds_the_ground_of_a_run() {
        let about = parse(ABOUT).unwrap();
        let flat = about.run_of(Path::new("somewhere/flat.log.gz")).unwrap();
        assert!(flat.fit && matches!(flat.terrain(), Ok(Terrain::Flat)));
        let ramp = about.run_of(Path::new("ramp.log")).unwrap().terrain().unwrap();
        assert!((ramp.height_m(8.0, -1.0) - 0.3).abs() < 1e-6);
        assert!(ramp.height_m(8.0, 1.0).abs() < 1e-6);
        assert!(about.run_of(Path::new("other.log")).is_none());
        let lines =
            [(&about.run[0], "fit"), (&about.run[1], "terrain"), (&about.run[1], "seconds")];
        assert_eq!(lines.map(|(run, key)| about.line_of(run, key)), [7, 10, 9]);
    }

    #[test]
    fn a_case_need_not_have_a_name() {
        let about = parse(&ABOUT.replace("case = \"one\"", "")).unwrap();
        assert_eq!((about.case.as_str(), about.run.len()), ("", 2));
    }

    #[test]
    fn a_run_that_names_its_folder_is_of_no_other() {
        let about = parse(&ABOUT.replace("ramp.log", "monday/flat.log.gz")).unwrap();
        let of = |log: &str| about.run_of(Path::new(log)).map(|run| run.file.as_str());
        assert_eq!(of("days/monday/flat.log.gz"), Some("monday/flat.log.gz"));
        assert_eq!(of("days/sunday/flat.log.gz"), Some("flat.log.gz"));
    }

    #[test]
    fn says_what_is_wrong_with_its_line() {
        let error = parse(&ABOUT.replace("height_m", "height_mm")).unwrap_err().to_string();
        assert!(error.starts_with("about.toml:11:") && error.contains("height_mm"), "{error}");
        let error = parse(&ABOUT.replace("7, 8.5", "9, 8.5")).unwrap_err().to_string();
        assert!(error.starts_with("about.toml:9: run ramp.log: x_m must grow"), "{error}");
        let error = parse(&ABOUT.replace("\"flat\"", "\"swamp\"")).unwrap_err().to_string();
        assert!(error.starts_with("about.toml:6:") && error.contains("swamp"), "{error}");
        let error = parse(&ABOUT.replace("\"flat\"", "\"ramp\"")).unwrap_err().to_string();
        assert!(error.contains("needs ramp"), "{error}");
        let twice = ABOUT.replace("ramp.log\"", "flat.log.gz\"");
        let error = parse(&twice).unwrap_err().to_string();
        assert!(error.starts_with("about.toml:9: run flat.log.gz is described twice"), "{error}");
    }

    #[test]
    fn a_date_may_be_one_of_toml_or_words_and_nothing_else() {
        let with = |date: &str| parse(&ABOUT.replace("dbc =", &format!("date = {date}\ndbc =")));
        for (date, told) in [
            ("2026-05-03", "2026-05-03"),
            ("2026-05-03T07:32:00Z", "2026-05-03T07:32:00Z"),
            ("\"3 May\"", "3 May"),
        ] {
            assert_eq!(with(date).unwrap().date.as_deref(), Some(told));
        }
        assert_eq!(parse(ABOUT).unwrap().date, None);
        for (date, told) in
            [("3", "neither a date"), ("[2026]", "neither"), ("07:32:00", "of which day")]
        {
            let error = with(date).unwrap_err().to_string();
            assert!(
                error.starts_with("about.toml:3: `date` is") && error.contains(told),
                "{error}"
            );
        }
    }

    proptest! {
        #[test]
        fn no_text_panics(text in "([a-z_\\[\\]]{0,10} ?= ?[\\[\\]{}\"a-z.,0-9 -]{0,24}\n){0,6}") {
            let _ = parse(&text);
        }
    }
}
