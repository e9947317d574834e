//! A terrain from a TOML file: `kind = "flat"`, or `kind = "ramp"` with its stations.

use std::path::{Path, PathBuf};

use serde::Deserialize;

use crate::{Ramp, Terrain};

/// Why a terrain file was refused.
#[derive(Debug, thiserror::Error)]
pub enum TerrainError {
    /// The file could not be read.
    #[error("{path}: cannot read the terrain file: {source}; give --terrain an existing file")]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// The text is not a terrain.
    #[error(
        "{path}:{line}: {problem}; a terrain is `kind = \"flat\"` or a `kind = \"ramp\"` with x_m, height_m, y_min_m, y_max_m"
    )]
    Parse {
        /// The file.
        path: PathBuf,
        /// Line, from 1.
        line: usize,
        /// What is wrong there.
        problem: String,
    },
}

#[derive(Deserialize)]
#[serde(tag = "kind", rename_all = "lowercase", deny_unknown_fields)]
enum TerrainFile {
    Flat,
    Ramp { x_m: [f64; 4], height_m: f64, y_min_m: f64, y_max_m: f64 },
}

impl Terrain {
    /// A terrain from a file.
    ///
    /// # Errors
    /// [`TerrainError`], with file, line and remedy.
    pub fn load(path: &Path) -> Result<Self, TerrainError> {
        let text = std::fs::read_to_string(path)
            .map_err(|source| TerrainError::Read { path: path.to_owned(), source })?;
        Self::parse(&text, path)
    }

    /// A terrain from TOML text; `path` only names it in errors.
    ///
    /// # Errors
    /// [`TerrainError::Parse`].
    pub fn parse(text: &str, path: &Path) -> Result<Self, TerrainError> {
        let refuse = |line, problem| TerrainError::Parse { path: path.to_owned(), line, problem };
        let file: TerrainFile = toml::from_str(text).map_err(|error| {
            let start = error.span().map_or(0, |span| span.start.min(text.len()));
            let line = text.as_bytes()[..start].iter().filter(|&&b| b == b'\n').count() + 1;
            refuse(line, error.message().replace('\n', " "))
        })?;
        match file {
            TerrainFile::Flat => Ok(Self::Flat),
            TerrainFile::Ramp { x_m, height_m, y_min_m, y_max_m } => {
                let ramp = Ramp { x_m, height_m, y_min_m, y_max_m };
                ramp.check().map_err(|problem| refuse(1, problem.to_owned()))?;
                Ok(Self::ramp(&ramp))
            }
        }
    }
}

impl Ramp {
    /// Says what no ramp can be.
    ///
    /// # Errors
    /// A sentence that names the key.
    pub fn check(&self) -> Result<(), &'static str> {
        let numbers = [self.height_m, self.y_min_m, self.y_max_m];
        if !self.x_m.iter().chain(&numbers).all(|n| n.is_finite()) {
            return Err("every number of a ramp must be finite");
        }
        if !self.x_m.is_sorted_by(|a, b| a < b) {
            return Err("x_m must grow: foot, crest, crest, foot");
        }
        if self.y_min_m >= self.y_max_m {
            return Err("y_min_m must be below y_max_m");
        }
        if self.height_m.abs() > 5.0 {
            return Err("height_m must be within 5 m");
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reads_both_kinds_and_refuses_others_with_their_line() {
        let parse = |text: &str| Terrain::parse(text, Path::new("t.toml"));
        assert!(matches!(parse("kind = \"flat\"\n"), Ok(Terrain::Flat)));
        let ramp = "kind = \"ramp\"\nx_m = [4, 7, 8.5, 11.5]\nheight_m = 0.3\ny_min_m = -1.9\ny_max_m = -0.5\n";
        assert!((parse(ramp).unwrap().height_m(8.0, -1.0) - 0.3).abs() < 1e-6);
        let error = parse("kind = \"swamp\"\n").unwrap_err().to_string();
        assert!(error.starts_with("t.toml:1: unknown variant `swamp`"), "{error}");
        let error = parse(&ramp.replace("7, 8.5", "9, 8.5")).unwrap_err().to_string();
        assert!(error.contains("x_m must grow"), "{error}");
        let error = parse(&ramp.replace("height_m", "height_mm")).unwrap_err().to_string();
        assert!(error.contains("height_mm"), "{error}");
    }
}
