//! The script file: timed commands as people write calibration tests, refused line by line.

use std::path::{Path, PathBuf};

use serde::Deserialize;
use toml::Spanned;
use xt28_safety::Limits;

use super::toml_text::{line_at, parsed};

/// Why a script was refused.
#[derive(Debug, thiserror::Error)]
pub enum ScriptError {
    /// The file could not be read.
    #[error("{path}: cannot read the script: {source}; give script: an existing file")]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// The text is not a script.
    #[error("{path}:{line}: {problem}")]
    Parse {
        /// The file.
        path: PathBuf,
        /// Line, from 1.
        line: usize,
        /// What is wrong there and what would be right.
        problem: String,
    },
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ScriptFile {
    /// When the script is over, s; the last command's end when left out.
    pub(super) end_s: Option<Spanned<f64>>,
    #[serde(rename = "command")]
    pub(super) commands: Vec<Entry>,
}

/// One timed command. What it leaves out stays as it is.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Entry {
    /// When, s since arming.
    pub(super) at_s: Spanned<f64>,
    /// Time to go linearly from the value in force to the new one, s.
    #[serde(default)]
    pub(super) ramp_s: f64,
    pub(super) throttle_percent: Option<f64>,
    pub(super) front_angle_deg: Option<f64>,
    pub(super) arms: Option<Mode>,
    pub(super) stroke_mm: Option<[Stroke; 6]>,
    pub(super) opening_percent: Option<[f64; 6]>,
    pub(super) brake: Option<bool>,
}

/// How the arms are driven.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum Mode {
    Off,
    Automatic,
    Position,
    Valve,
}

/// A target stroke, or the word "hold".
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(untagged, expecting = "a stroke is a number of mm or \"hold\"")]
pub(super) enum Stroke {
    Target(f64),
    Hold(Hold),
}

#[derive(Clone, Copy, Debug, Deserialize)]
pub(super) enum Hold {
    #[serde(rename = "hold")]
    Hold,
}

impl ScriptFile {
    pub(super) fn read(path: &Path, limits: &Limits) -> Result<Self, ScriptError> {
        let text = std::fs::read_to_string(path)
            .map_err(|source| ScriptError::Read { path: path.to_owned(), source })?;
        Self::parse(&text, path, limits)
    }

    pub(super) fn parse(text: &str, path: &Path, limits: &Limits) -> Result<Self, ScriptError> {
        let refuse = |at: usize, problem: String| ScriptError::Parse {
            path: path.to_owned(),
            line: line_at(text.as_bytes(), at),
            problem,
        };
        let file: Self = parsed(text).map_err(|(at, problem)| refuse(at, problem))?;
        let mut before_s = 0.0;
        for entry in &file.commands {
            let at = entry.at_s.span().start;
            entry.check(before_s, limits).map_err(|problem| refuse(at, problem))?;
            before_s = *entry.at_s.get_ref();
        }
        if let Some(end) = &file.end_s {
            let end_s = *end.get_ref();
            if !(end_s >= before_s && end_s.is_finite()) {
                let problem = format!("end_s = {end_s} must not be before the last command");
                return Err(refuse(end.span().start, problem));
            }
        }
        Ok(file)
    }
}

impl ScriptFile {
    /// Refuses a command that would never be played in a run of `run_s` s, of which arming takes a while.
    #[allow(clippy::cast_precision_loss)] // a fraction of a second
    pub(super) fn check_run(
        &self,
        run_s: f64,
        limits: &Limits,
        text: &str,
        path: &Path,
    ) -> Result<(), ScriptError> {
        let arms_s = limits.steady_ns as f64 * 1e-9;
        let late = self.commands.iter().find(|entry| *entry.at_s.get_ref() + arms_s >= run_s);
        let Some(Entry { at_s, .. }) = late else { return Ok(()) };
        let problem = format!(
            "at_s = {} lies outside the run of {run_s} s and would never be played: it counts from arming, which comes \
             {arms_s} s after the start at the earliest",
            at_s.get_ref()
        );
        let line = line_at(text.as_bytes(), at_s.span().start);
        Err(ScriptError::Parse { path: path.to_owned(), line, problem })
    }
}

impl Entry {
    /// Refuses what is outside the safety kernel's absolute limits, so that a script runs as written. Its
    /// rates still apply: a step is a ramp at the machine.
    fn check(&self, before_s: f64, limits: &Limits) -> Result<(), String> {
        let at_s = *self.at_s.get_ref();
        if !(at_s >= before_s && at_s.is_finite()) {
            return Err(format!("at_s = {at_s} must not be before the command above, {before_s}"));
        }
        // In the file's units, where 0.25 m must not become 249.999 mm.
        let whole = |value: f64, factor: f64| (value * factor * 1e6).round() * 1e-6;
        let stroke_mm = whole(limits.stroke_max_m, 1e3);
        let opening_percent = whole(limits.opening_max, 1e2);
        let throttle_percent = whole(limits.throttle_max, 1e2);
        let angle_deg = whole(limits.angle_max_rad.to_degrees(), 1.0);
        let strokes = self.stroke_mm.iter().flatten().filter_map(|stroke| match stroke {
            Stroke::Target(mm) => Some(("stroke_mm", *mm, 0.0, stroke_mm)),
            Stroke::Hold(_) => None,
        });
        let openings = self.opening_percent.iter().flatten();
        let numbers = strokes
            .chain(openings.map(|o| ("opening_percent", *o, -opening_percent, opening_percent)))
            .chain(
                self.throttle_percent
                    .map(|t| ("throttle_percent", t, -throttle_percent, throttle_percent)),
            )
            .chain(self.front_angle_deg.map(|a| ("front_angle_deg", a, -angle_deg, angle_deg)))
            .chain([("ramp_s", self.ramp_s, 0.0, 3600.0)]);
        for (key, value, low, high) in numbers {
            // Written so that NaN is refused.
            if !(value >= low && value <= high) {
                return Err(format!("{key} = {value} must be {low} to {high}"));
            }
        }
        match (self.arms, &self.stroke_mm, &self.opening_percent) {
            (_, Some(_), Some(_)) => {
                Err("stroke_mm and opening_percent exclude each other: give one".to_owned())
            }
            (Some(Mode::Off | Mode::Automatic | Mode::Valve), Some(_), None) => {
                Err("stroke_mm needs arms = \"position\"".to_owned())
            }
            (Some(Mode::Off | Mode::Automatic | Mode::Position), None, Some(_)) => {
                Err("opening_percent needs arms = \"valve\"".to_owned())
            }
            _ => Ok(()),
        }
    }
}
