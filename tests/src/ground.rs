//! The ground of a scenario: tables of a terrain, `[terrain.ramp]`, or a file, `terrain = "a.toml"`.

use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

use serde::de::value::MapAccessDeserializer;
use serde::de::{Deserialize, Deserializer, Error, MapAccess, Visitor};
use xt28_sim::{TerrainError, TerrainSpec};

/// The ground that a scenario runs on; level when nothing is said.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Ground {
    /// The terrain file, where one is named.
    pub file: Option<PathBuf>,
    /// Its layers; those of the file once the scenario has been read.
    pub spec: TerrainSpec,
}

impl Ground {
    /// Reads the file that it names, and looks for the files that its layers name in `folder`.
    pub(crate) fn resolve(
        &mut self,
        folder: &Path,
        read: impl Fn(&Path) -> io::Result<String>,
    ) -> Result<(), TerrainError> {
        let Some(file) = &mut self.file else {
            self.spec = std::mem::take(&mut self.spec).beside(folder);
            return Ok(());
        };
        *file = folder.join(&file);
        let text = read(file).map_err(|source| TerrainError::Read {
            path: file.clone(),
            what: "terrain file",
            remedy: "its path is relative to the scenario file",
            source,
        })?;
        self.spec = TerrainSpec::parse(&text, file)?;
        Ok(())
    }
}

impl fmt::Display for Ground {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let TerrainSpec { slope, ramp, step, perlin, bumps, course, boulders, height_map, .. } =
            &self.spec;
        let mut words = Vec::new();
        words.extend(slope.iter().map(|slope| format!("slope {} %", 100.0 * slope.grade)));
        words.extend(ramp.iter().map(|ramp| format!("ramp {} m", ramp.height_m)));
        words.extend(step.iter().map(|step| format!("step {} m", step.height_m)));
        words.extend(perlin.iter().map(|perlin| format!("noise ±{} m", perlin.amplitude_m)));
        words.extend(bumps.iter().map(|bumps| format!("bumps {} m", bumps.height_m)));
        words.extend(course.iter().map(|course| format!("{} sills", course.count)));
        words.extend(boulders.iter().map(|_| "boulders".to_owned()));
        words.extend(height_map.iter().map(|map| map.file.display().to_string()));
        if words.is_empty() {
            words.push("flat ground".to_owned());
        }
        f.write_str(&words.join(", "))
    }
}

/// A string names a file, a table is the terrain. Not an untagged enum: that would lose the line of
/// an error.
impl<'de> Deserialize<'de> for Ground {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Either;

        impl<'de> Visitor<'de> for Either {
            type Value = Ground;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a terrain file or tables such as [terrain.ramp]")
            }

            fn visit_str<E: Error>(self, file: &str) -> Result<Ground, E> {
                Ok(Ground { file: Some(file.into()), ..Ground::default() })
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Ground, A::Error> {
                let spec = TerrainSpec::deserialize(MapAccessDeserializer::new(map))?;
                Ok(Ground { file: None, spec })
            }
        }

        deserializer.deserialize_any(Either)
    }
}
