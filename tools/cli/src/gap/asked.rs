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
    sha256: String,
}

impl Input {
    pub(super) fn of(path: &Path) -> Result<Self, Failure> {
        let bytes = std::fs::read(path)
            .map_err(|error| format!("{}: cannot read it again: {error}", path.display()))?;
        Ok(Self { file: path.display().to_string(), sha256: sha256(&bytes) })
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
