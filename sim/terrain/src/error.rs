//! Why a terrain was refused: one line with file, place and remedy.

use std::path::PathBuf;

use crate::Fault;

/// Why a terrain was refused.
#[derive(Debug, thiserror::Error)]
pub enum TerrainError {
    /// A file could not be read.
    #[error("{path}: cannot read the {what}: {source}; {remedy}")]
    Read {
        /// The file.
        path: PathBuf,
        /// What it should be.
        what: &'static str,
        /// What to do about it.
        remedy: &'static str,
        /// What the system said.
        source: std::io::Error,
    },
    /// The text is not a terrain.
    #[error("{path}:{line}: {problem}")]
    Parse {
        /// The file.
        path: PathBuf,
        /// Line, from 1.
        line: usize,
        /// What is wrong there, and what would be right.
        problem: String,
    },
    /// A layer is none that can be; of a spec that was not read from a file.
    #[error("terrain {0}")]
    Layer(#[from] Fault),
    /// A file is no height map, or not one that can be driven on.
    #[error("{path}: {problem}")]
    HeightMap {
        /// The file.
        path: PathBuf,
        /// What is wrong and where, and what would be right.
        problem: String,
    },
}
