//! What a terrain is made of, as its TOML says it.

use std::path::Path;

use serde::Serialize;
use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{Deserialize, Deserializer, MapAccess, SeqAccess, Visitor};

use crate::{Boulders, Bumps, Course, Extent, HeightMap, MapSpec, Perlin, Ramp, Slope, Step};

/// The layers of a terrain; heights add up. Every kind may stand once, `[ramp]`, or several times,
/// `[[ramp]]`. Without any layer the ground is level.
#[derive(Clone, Debug, Default, PartialEq, serde::Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct TerrainSpec {
    /// A plane under everything else.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub slope: Option<Slope>,
    /// Ramps in a lane.
    #[serde(deserialize_with = "one_or_more", skip_serializing_if = "Vec::is_empty")]
    pub ramp: Vec<Ramp>,
    /// Steps and kerbs.
    #[serde(deserialize_with = "one_or_more", skip_serializing_if = "Vec::is_empty")]
    pub step: Vec<Step>,
    /// Natural variation.
    #[serde(deserialize_with = "one_or_more", skip_serializing_if = "Vec::is_empty")]
    pub perlin: Vec<Perlin>,
    /// Even bumps.
    #[serde(deserialize_with = "one_or_more", skip_serializing_if = "Vec::is_empty")]
    pub bumps: Vec<Bumps>,
    /// Vibration courses.
    #[serde(deserialize_with = "one_or_more", skip_serializing_if = "Vec::is_empty")]
    pub course: Vec<Course>,
    /// Boulders.
    #[serde(deserialize_with = "one_or_more", skip_serializing_if = "Vec::is_empty")]
    pub boulders: Vec<Boulders>,
    /// Height maps from files.
    #[serde(deserialize_with = "one_or_more", skip_serializing_if = "Vec::is_empty")]
    pub height_map: Vec<HeightMap>,
    /// Where the grid lies; ignored where a plane is all there is.
    #[serde(skip_serializing_if = "is_default")]
    pub grid: Extent,
    /// How the map that a policy is given differs from the ground.
    #[serde(skip_serializing_if = "is_default")]
    pub map: MapSpec,
}

/// A kind of layer, as `leave_out` of a map names it: the key in the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Deserialize, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum LayerKind {
    /// [`Slope`].
    Slope,
    /// [`Ramp`].
    Ramp,
    /// [`Step`].
    Step,
    /// [`Perlin`].
    Perlin,
    /// [`Bumps`].
    Bumps,
    /// [`Course`].
    Course,
    /// [`Boulders`].
    Boulders,
    /// [`HeightMap`].
    HeightMap,
}

/// What is wrong with one table of a spec.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("[{table}]: {problem}")]
pub struct Fault {
    /// The table's key.
    pub table: &'static str,
    /// Which of the tables with that key, from 0.
    pub index: usize,
    /// A sentence that names the key.
    pub problem: String,
}

impl Fault {
    /// The line of `text`, from 1, at which the table begins, where tables of a terrain stand under
    /// `prefix` (`"terrain."` in a scenario, `""` in a terrain file). In a file of one layer, which has no header, the
    /// line of the key with which the problem begins, or of `kind`; 1 if there is neither.
    #[must_use]
    pub fn line_in(&self, text: &str, prefix: &str) -> usize {
        let headers = [format!("[{prefix}{}]", self.table), format!("[[{prefix}{}]]", self.table)];
        let begins = |line: &&str| headers.iter().any(|header| line.trim().starts_with(header));
        let numbered = text.lines().zip(1..).filter(|(line, _)| begins(line));
        numbered.map(|(_, number)| number).nth(self.index).unwrap_or_else(|| {
            let key = self.problem.split([' ', ':']).next().filter(|_| prefix.is_empty());
            let at = |key: &str| {
                text.lines().position(|line| {
                    let value = line.trim_start().strip_prefix(key);
                    value.is_some_and(|value| value.trim_start().starts_with('='))
                })
            };
            key.and_then(|key| at(key).or_else(|| at("kind"))).map_or(1, |index| index + 1)
        })
    }
}

impl TerrainSpec {
    /// Whether the ground is a plane without end, so that no grid is needed.
    #[must_use]
    pub fn is_plane(&self) -> bool {
        let Self { slope: _, ramp, step, perlin, bumps, course, boulders, height_map, .. } = self;
        ramp.is_empty()
            && step.is_empty()
            && perlin.is_empty()
            && bumps.is_empty()
            && course.is_empty()
            && boulders.is_empty()
            && height_map.is_empty()
    }

    /// Says what no terrain can be.
    ///
    /// # Errors
    /// The first table that is refused, and why.
    pub fn check(&self) -> Result<(), Fault> {
        fn each<T, E: Into<String>>(
            table: &'static str,
            layers: &[T],
            check: impl Fn(&T) -> Result<(), E>,
        ) -> Result<(), Fault> {
            for (index, layer) in layers.iter().enumerate() {
                check(layer).map_err(|problem| Fault { table, index, problem: problem.into() })?;
            }
            Ok(())
        }
        each("slope", self.slope.as_slice(), Slope::check)?;
        each("ramp", &self.ramp, Ramp::check)?;
        each("step", &self.step, Step::check)?;
        each("perlin", &self.perlin, Perlin::check)?;
        each("bumps", &self.bumps, Bumps::check)?;
        each("course", &self.course, Course::check)?;
        each("boulders", &self.boulders, Boulders::check)?;
        each("boulders", &self.boulders, |layer| layer.check_room(self.grid))?;
        each("height_map", &self.height_map, HeightMap::check)?;
        each("grid", &[self.grid], Extent::check)?;
        self.check_work()?;
        each("map", std::slice::from_ref(&self.map), MapSpec::check)
    }

    /// The spec as a terrain file says it.
    ///
    /// # Errors
    /// A seed above 2^63 - 1, which no TOML can hold.
    pub fn to_toml(&self) -> Result<String, toml::ser::Error> {
        if *self == Self::default() {
            // A file without a layer is refused: it may have been meant to have one.
            return Ok("kind = \"flat\"\n".to_owned());
        }
        toml::to_string(self)
    }

    /// The spec with the files that it names taken as lying in `folder`.
    #[must_use]
    pub fn beside(mut self, folder: &Path) -> Self {
        for height_map in &mut self.height_map {
            height_map.file = folder.join(&height_map.file);
        }
        self
    }

    /// The same kind of ground, another one: each seed is mixed with `seed`, so that ten
    /// environments can train on ten grounds of one file.
    #[must_use]
    pub fn reseeded(mut self, seed: u64) -> Self {
        // TOML has no integer of 64 bits without a sign.
        let turn = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(32) >> 1;
        self.perlin.iter_mut().for_each(|layer| layer.seed ^= turn);
        self.boulders.iter_mut().for_each(|layer| layer.seed ^= turn);
        self.map.seed ^= turn;
        self
    }

    /// The spec without its layers of some kinds.
    pub(crate) fn without(mut self, kinds: &[LayerKind]) -> Self {
        for kind in kinds {
            match kind {
                LayerKind::Slope => self.slope = None,
                LayerKind::Ramp => self.ramp.clear(),
                LayerKind::Step => self.step.clear(),
                LayerKind::Perlin => self.perlin.clear(),
                LayerKind::Bumps => self.bumps.clear(),
                LayerKind::Course => self.course.clear(),
                LayerKind::Boulders => self.boulders.clear(),
                LayerKind::HeightMap => self.height_map.clear(),
            }
        }
        self
    }
}

fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

/// A table, or an array of tables. Not an untagged enum: that would lose the line of an error.
fn one_or_more<'de, D, T>(deserializer: D) -> Result<Vec<T>, D::Error>
where
    D: Deserializer<'de>,
    T: Deserialize<'de>,
{
    struct OneOrMore<T>(std::marker::PhantomData<T>);

    impl<'de, T: Deserialize<'de>> Visitor<'de> for OneOrMore<T> {
        type Value = Vec<T>;

        fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
            f.write_str("a table or an array of tables")
        }

        fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Vec<T>, A::Error> {
            Ok(vec![T::deserialize(MapAccessDeserializer::new(map))?])
        }

        fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<Vec<T>, A::Error> {
            Vec::deserialize(SeqAccessDeserializer::new(seq))
        }
    }

    deserializer.deserialize_any(OneOrMore(std::marker::PhantomData))
}
