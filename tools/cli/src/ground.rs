//! `--terrain`: a terrain file, or the scenario whose ground a log was recorded on.

use std::path::{Path, PathBuf};
use std::{env, fs};

use tempfile::TempDir;
use xt28_scenarios::Scenario;

use crate::Failure;

/// The terrain file that is meant.
#[derive(Debug)]
pub(crate) struct Ground {
    file: PathBuf,
    /// Where it was written to, if it was not there: gone with this.
    _folder: Option<TempDir>,
}

impl Ground {
    /// The terrain file `given`, or that of the scenario of that name or in that file.
    pub(crate) fn find(given: Option<&Path>) -> Result<Option<Self>, Failure> {
        let Some(given) = given else { return Ok(None) };
        let name = given.to_string_lossy();
        let scenario = if is_scenario(given) {
            Scenario::load(given)?
        } else if given.is_file() || name.ends_with(".toml") || name.contains('/') {
            return Ok(Some(Self { file: given.to_owned(), _folder: None }));
        } else {
            Scenario::find(&name)?
        };
        let ground = scenario.terrain.spec.beside(&env::current_dir()?);
        let folder = tempfile::Builder::new().prefix("xt28-ground-").tempdir()?;
        let file = folder.path().join("terrain.toml");
        fs::write(&file, ground.to_toml()?)?;
        Ok(Some(Self { file, _folder: Some(folder) }))
    }

    pub(crate) fn file(&self) -> &Path {
        &self.file
    }
}

/// Whether a file is a scenario's: of all files here those alone say who drives.
fn is_scenario(path: &Path) -> bool {
    let table = fs::read_to_string(path).ok().and_then(|text| text.parse::<toml::Table>().ok());
    table.is_some_and(|table| table.contains_key("policy"))
}

#[cfg(test)]
mod tests {
    use xt28_gap::Terrain;

    use super::*;

    /// Height of the ground that is meant there, m.
    fn height_m(given: &Path) -> f64 {
        let ground = Ground::find(Some(given)).unwrap().unwrap();
        Terrain::load(ground.file()).unwrap().height_m(7.5, -1.0)
    }

    #[test]
    fn a_scenario_stands_for_its_ground_by_name_and_by_file() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        let ramp = Scenario::find("ramp").unwrap();
        fs::write(at("terrain.toml"), ramp.terrain.spec.to_toml().unwrap()).unwrap();
        let text = "title = \"t\"\npolicy = \"hold\"\nduration_s = 9\n[terrain.ramp]\nx_m = [4.0, 7.0, 8.5, 11.5]\n\
                    height_m = 0.3\ny_min_m = -1.9\ny_max_m = -0.5\n";
        fs::write(at("mine.toml"), text).unwrap();
        for given in [at("terrain.toml"), "ramp".into(), at("mine.toml")] {
            assert!((height_m(&given) - 0.3).abs() < 1e-6, "{}", given.display());
        }
        let error = Ground::find(Some(Path::new("rampe"))).unwrap_err().to_string();
        assert!(error.contains("ramp"), "{error}");
        assert!(Ground::find(None).unwrap().is_none());
    }
}
