//! Why a check cannot be made: one line each, with file, line and remedy.

use std::path::{Path, PathBuf};

use xt28_gap::GapError;
use xt28_gap_plants::CaseError;

/// Why a check cannot be made.
#[derive(Debug, thiserror::Error)]
pub enum CheckError {
    /// A file or folder could not be read.
    #[error("{path}: cannot read: {source}; give an existing, readable one")]
    Read {
        /// The file or folder.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// A folder has no cases.
    #[error("{path}: no case here; a case is a folder with an about.toml")]
    Empty {
        /// The folder.
        path: PathBuf,
    },
    /// A case has no answer.
    #[error("{case}: no answer in {looked}; put {case}.toml there")]
    NoAnswer {
        /// The case.
        case: String,
        /// Where it was looked for.
        looked: String,
    },
    /// An answer is not what it should be.
    #[error("{path}:{line}: {problem}")]
    Answer {
        /// The file.
        path: PathBuf,
        /// Line, from 1.
        line: usize,
        /// What is wrong there, and what would be right.
        problem: String,
    },
    /// An answer says that a fault set in in a run that its case does not have.
    #[error("{case}: start_run = \"{run}\" is no log of it; name the file of one of its runs")]
    NoRun {
        /// The case.
        case: String,
        /// The run.
        run: String,
    },
    /// A case's logs do not say which database they were sent with.
    #[error("{path}: names no DBC; add dbc = \"FILE\"")]
    NoDatabase {
        /// Its `about.toml`.
        path: PathBuf,
    },
    /// A case has no logs.
    #[error("{path}: lists no run; add a [[run]] for each log of the case")]
    NoRuns {
        /// Its `about.toml`.
        path: PathBuf,
    },
    /// A set has no machine whose readings could be made wrong.
    #[error(
        "no case to lay a fault over; a set needs a machine that is sound, or has one effect that is no sensor's"
    )]
    NoBase,
    /// The answers are not those that were sealed.
    #[error(
        "the seal is broken: the answers are not those sealed before the diagnosis as {seal}; check again and leave them alone"
    )]
    SealBroken {
        /// The seal.
        seal: String,
    },
    /// A picture could not be drawn.
    #[error("the picture cannot be drawn: {0}; leave it out")]
    Picture(String),
    /// A case could not be made.
    #[error(transparent)]
    Case(#[from] CaseError),
    /// A log could not be read.
    #[error(transparent)]
    Log(#[from] GapError),
}

impl CheckError {
    pub(crate) fn read(path: &Path, source: std::io::Error) -> Self {
        Self::Read { path: path.to_owned(), source }
    }
}
