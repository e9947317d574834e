//! What an answer rests on, for whoever finds the file later: program, logs and all that was given with them.

use std::path::Path;

use serde::Serialize;
use xt28_scenarios::sha256;

use crate::Failure;

/// A file as it was read.
#[derive(Debug, Serialize)]
pub(super) struct Input {
    /// As it was named.
    file: String,
    /// None of what is no file, and may be read but once.
    sha256: Option<String>,
}

impl Input {
    pub(super) fn of(path: &Path) -> Result<Self, Failure> {
        let is_file = std::fs::metadata(path).is_ok_and(|there| there.is_file());
        let bytes = is_file.then(|| std::fs::read(path)).transpose();
        let bytes = bytes.map_err(|error| format!("{}: cannot read: {error}", path.display()))?;
        Ok(Self { file: path.display().to_string(), sha256: bytes.as_deref().map(sha256) })
    }
}

/// The question.
#[derive(Debug, Serialize)]
pub(super) struct Asked {
    pub(super) program: String,
    pub(super) logs: Vec<Input>,
    pub(super) fitted_runs: Vec<String>,
    pub(super) dbc: Input,
    pub(super) mapping: Option<Input>,
    /// None where the built-in machine is meant.
    pub(super) machine: Option<Input>,
    pub(super) effects: Option<Input>,
    pub(super) about: Option<Input>,
    /// As it was named: a file, or a scenario.
    pub(super) terrain: Option<String>,
}

/// An answer and what it rests on.
#[derive(Debug, Serialize)]
pub(super) struct Answered<'a, T> {
    #[serde(flatten)]
    pub(super) answer: &'a T,
    pub(super) asked: Asked,
}
