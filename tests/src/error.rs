//! Why a scenario did not load or did not run: one line with file, line and remedy.

use std::path::{Path, PathBuf};

use ecu_emu::{OperatorError, UnheardEffect};
use xt28_machine::MachineError;
use xt28_sim::TerrainError;
use xt28_sim::effects::OverlayError;

use crate::places::line_at;

/// Why a scenario was refused.
#[derive(Debug, thiserror::Error)]
pub enum ScenarioError {
    /// The file could not be read.
    #[error(
        "{path}: cannot read the scenario: {source}; give a scenario file or one of `xt28 scenarios`"
    )]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// The text is no scenario: bad TOML, an unknown key, a value of another type.
    #[error("{path}:{line}: {problem}{}", remedy(.problem))]
    Parse {
        /// The file.
        path: PathBuf,
        /// Line, from 1.
        line: usize,
        /// What is wrong there, with the keys known there.
        problem: String,
    },
    /// A value no run can have.
    #[error("{path}:{line}: {problem}")]
    Value {
        /// The file.
        path: PathBuf,
        /// Line, from 1.
        line: usize,
        /// The key, its value and what it must be.
        problem: String,
    },
    /// The script that the policy names could not be read.
    #[error(
        "{policy_at}: cannot read {script}: {source}; a script is looked for beside the scenario file, and that of --policy from the working folder on"
    )]
    Script {
        /// File and line of the policy.
        policy_at: String,
        /// The script's file.
        script: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// The operator's script that it names was refused.
    #[error("{operator_at}: {source}")]
    Operator {
        /// File and line of the operator.
        operator_at: String,
        /// What is wrong with the script.
        source: OperatorError,
    },
    /// A policy with nothing to drive.
    #[error(
        "{policy_at}: `{policy}` would drive nothing: the ECUs of profile 2016 take no commands, and the operator in the cab drives; take `hold`, or profile paper"
    )]
    NotDriven {
        /// File and line of the policy, or the option.
        policy_at: String,
        /// The policy.
        policy: String,
    },
    /// The terrain that it names was refused.
    #[error("{terrain_at}: {source}")]
    Terrain {
        /// File and line of the terrain.
        terrain_at: String,
        /// What is wrong with it.
        source: TerrainError,
    },
    /// No built-in scenario has this name.
    #[error("no scenario `{name}`{}; the built-in ones are {known}, or give a file ending in .toml", suggest(.nearest))]
    Unknown {
        /// The name given.
        name: String,
        /// The built-in name most like it.
        nearest: Option<&'static str>,
        /// All built-in names.
        known: String,
    },
}

/// Why a scenario could not be made ready to run.
#[derive(Debug, thiserror::Error)]
pub enum SetupError {
    /// The machine file is refused.
    #[error(transparent)]
    Machine(#[from] MachineError),
    /// A height map of the terrain is refused.
    #[error(transparent)]
    Terrain(#[from] TerrainError),
    /// An effect is none that the machine can have.
    #[error(transparent)]
    Effects(#[from] OverlayError),
    /// An effect is none that the scenario's ECUs hear of.
    #[error("{path}: {source}")]
    Unheard {
        /// The overlay.
        path: PathBuf,
        /// Which effect.
        source: UnheardEffect,
    },
}

impl ScenarioError {
    /// From what the TOML reader said of `text`.
    pub(crate) fn from_toml(error: &toml::de::Error, text: &str, path: &Path) -> Self {
        let start = error.span().map_or(0, |span| span.start);
        Self::Parse {
            path: path.to_owned(),
            line: line_at(text, start),
            problem: error.message().replace('\n', " "),
        }
    }
}

/// What mends what the TOML reader found.
fn remedy(problem: &str) -> &'static str {
    let of = |words: &str| problem.contains(words);
    if of("unknown field") || of("missing field") {
        "; keys carry their unit, as duration_s and height_m do"
    } else if of("wanted exactly 1 element") {
        "; an [[expect]] has one key, and keys of the scenario itself stand above the first table"
    } else if of("invalid type: map, expected a sequence") {
        "; of such tables there may be several: write double brackets, as [[expect]]"
    } else {
        ""
    }
}

fn suggest(nearest: &Option<&'static str>) -> String {
    nearest.map_or_else(String::new, |name| format!(" (did you mean `{name}`?)"))
}
