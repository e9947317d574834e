//! A terrain from its TOML file: tables of layers, or `kind = "..."` and the keys of the one layer.

use std::fmt;
use std::marker::PhantomData;
use std::path::Path;

use serde::de::value::{MapAccessDeserializer, StringDeserializer};
use serde::de::{
    DeserializeOwned, DeserializeSeed, IgnoredAny, IntoDeserializer, MapAccess, Visitor,
};
use serde::{Deserialize, Deserializer};
use toml::Spanned;

use crate::{Terrain, TerrainError, TerrainSpec};

/// What may stand behind `kind`.
const KINDS: &str = "flat, slope, ramp, step, perlin, bumps, course, boulders, height_map";

impl Terrain {
    /// A terrain from a file.
    ///
    /// # Errors
    /// [`TerrainError`], with file, line and remedy.
    pub fn load(path: &Path) -> Result<Self, TerrainError> {
        TerrainSpec::load(path)?.build()
    }

    /// A terrain from TOML text; `path` names it in errors, and files that it names lie beside it.
    ///
    /// # Errors
    /// [`TerrainError`].
    pub fn parse(text: &str, path: &Path) -> Result<Self, TerrainError> {
        TerrainSpec::parse(text, path)?.build()
    }
}

impl TerrainSpec {
    /// What a terrain file says. The files that it names are looked for beside it.
    ///
    /// # Errors
    /// [`TerrainError::Read`] or [`TerrainError::Parse`].
    pub fn load(path: &Path) -> Result<Self, TerrainError> {
        let text = std::fs::read_to_string(path).map_err(|source| TerrainError::Read {
            path: path.to_owned(),
            what: "terrain file",
            remedy: "give --terrain an existing file",
            source,
        })?;
        Self::parse(&text, path)
    }

    /// As [`Self::load`], from text; `path` says where it came from.
    ///
    /// # Errors
    /// [`TerrainError::Parse`].
    pub fn parse(text: &str, path: &Path) -> Result<Self, TerrainError> {
        let refuse = |line, problem| TerrainError::Parse { path: path.to_owned(), line, problem };
        let spec = read(text)
            .map_err(|error| refuse(line_at(text, error.byte), error.problem.replace('\n', " ")))?;
        spec.check().map_err(|fault| refuse(fault.line_in(text, ""), fault.to_string()))?;
        Ok(spec.beside(path.parent().unwrap_or(Path::new(""))))
    }
}

/// The line, from 1, of a byte of `text`.
fn line_at(text: &str, byte: usize) -> usize {
    text.as_bytes()[..byte.min(text.len())].iter().filter(|&&b| b == b'\n').count() + 1
}

/// The one key that says which form the file has.
#[derive(Deserialize)]
struct Form {
    kind: Option<Spanned<String>>,
}

/// What is wrong, and from which byte of the text on.
struct Problem {
    byte: usize,
    problem: String,
}

impl From<toml::de::Error> for Problem {
    fn from(error: toml::de::Error) -> Self {
        let byte = error.span().map_or(0, |span| span.start);
        Self { byte, problem: error.message().to_owned() }
    }
}

fn read(text: &str) -> Result<TerrainSpec, Problem> {
    let Form { kind } = toml::from_str(text)?;
    let Some(kind) = kind else {
        return tables(text);
    };
    let mut spec = TerrainSpec::default();
    match kind.get_ref().as_str() {
        "flat" => {
            layer::<Nothing>(text)?;
        }
        "slope" => spec.slope = Some(layer(text)?),
        "ramp" => spec.ramp.push(layer(text)?),
        "step" => spec.step.push(layer(text)?),
        "perlin" => spec.perlin.push(layer(text)?),
        "bumps" => spec.bumps.push(layer(text)?),
        "course" => spec.course.push(layer(text)?),
        "boulders" => spec.boulders.push(layer(text)?),
        "height_map" => spec.height_map.push(layer(text)?),
        other => {
            let problem = format!("unknown kind `{other}`, expected one of {KINDS}");
            return Err(Problem { byte: kind.span().start, problem });
        }
    }
    Ok(spec)
}

fn tables(text: &str) -> Result<TerrainSpec, Problem> {
    let spec: TerrainSpec = toml::from_str(text)?;
    if spec == TerrainSpec::default() {
        let problem = "no layer; level ground is `kind = \"flat\"`".to_owned();
        return Err(Problem { byte: 0, problem });
    }
    Ok(spec)
}

/// The one layer of a file with `kind`.
fn layer<T: DeserializeOwned>(text: &str) -> Result<T, toml::de::Error> {
    toml::from_str(text).map(|WithoutKind(layer)| layer)
}

/// A layer without keys.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Nothing {}

/// A table read as if its key `kind` were not there. An internally tagged enum would do the same,
/// but forget the line of every error.
struct WithoutKind<T>(T);

impl<'de, T: Deserialize<'de>> Deserialize<'de> for WithoutKind<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Table<T>(PhantomData<T>);

        impl<'de, T: Deserialize<'de>> Visitor<'de> for Table<T> {
            type Value = T;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a table")
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<T, A::Error> {
                T::deserialize(MapAccessDeserializer::new(SkipKind(map)))
            }
        }

        deserializer.deserialize_map(Table(PhantomData)).map(Self)
    }
}

/// The entries of a table but `kind`.
struct SkipKind<A>(A);

impl<'de, A: MapAccess<'de>> MapAccess<'de> for SkipKind<A> {
    type Error = A::Error;

    fn next_key_seed<K: DeserializeSeed<'de>>(
        &mut self,
        seed: K,
    ) -> Result<Option<K::Value>, A::Error> {
        // A key is read before one knows what it is; only then can the wanted type be made of it.
        while let Some(key) = self.0.next_key::<Spanned<String>>()? {
            if key.get_ref() != "kind" {
                let key: StringDeserializer<A::Error> = key.into_inner().into_deserializer();
                return seed.deserialize(key).map(Some);
            }
            self.0.next_value::<IgnoredAny>()?;
        }
        Ok(None)
    }

    fn next_value_seed<V: DeserializeSeed<'de>>(&mut self, seed: V) -> Result<V::Value, A::Error> {
        self.0.next_value_seed(seed)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const RAMP: &str = "kind = \"ramp\"\nx_m = [4, 7, 8.5, 11.5]\nheight_m = 0.3\n\
        y_min_m = -1.9\ny_max_m = -0.5\n";

    fn parse(text: &str) -> Result<Terrain, TerrainError> {
        Terrain::parse(text, Path::new("t.toml"))
    }

    fn refusal(text: &str) -> String {
        parse(text).unwrap_err().to_string()
    }

    #[test]
    fn both_forms_say_the_same() {
        assert_eq!(parse("kind = \"flat\"").unwrap(), Terrain::Flat);
        assert!((parse(RAMP).unwrap().height_m(8.0, -1.0) - 0.3).abs() < 1e-6);
        assert_eq!(
            parse(RAMP).unwrap(),
            parse(&RAMP.replace("kind = \"ramp\"", "[ramp]")).unwrap()
        );
        let kinds =
            KINDS.split(", ").filter(|kind| !["flat", "height_map", "course"].contains(kind));
        for kind in kinds {
            // Every kind is known, and then lacks its keys.
            assert!(refusal(&format!("kind = \"{kind}\"")).contains("missing field"), "{kind}");
        }
    }

    #[test]
    fn layers_add_up() {
        let text = "[slope]\ngrade = 0.1\n[[step]]\nx_m = 2\nheight_m = 0.15\n\
            [[step]]\nx_m = 4\nheight_m = 0.15\n[grid]\nx_m = [-2, 8]\ny_m = [-2, 2]\n";
        let terrain = parse(text).unwrap();
        for (x, height) in [(1.0, 0.1), (3.0, 0.45), (6.0, 0.9), (60.0, 6.3), (-60.0, -6.0)] {
            assert!((terrain.height_m(x, 30.0) - height).abs() < 1e-6, "{x}");
        }
        let slope = parse("kind = \"slope\"\ngrade = 0.1\n").unwrap();
        assert!(matches!(slope, Terrain::Plane(_)));
    }

    #[test]
    fn each_error_is_one_line_with_its_place() {
        let cases = [
            ("kind = \"swamp\"\n".to_owned(), "t.toml:1: unknown kind `swamp`", "course"),
            (RAMP.replace("height_m", "height_mm"), "t.toml:", "`height_mm`"),
            (RAMP.replace("0.3", "\"high\""), "t.toml:3: invalid type", "f64"),
            (RAMP.replace("7, 8.5", "9, 8.5"), "t.toml:1: [ramp]:", "x_m must grow"),
            ("\n[ramps]\n".to_owned(), "t.toml:2: unknown field `ramps`", "`ramp`"),
            ("\n\n[perlin]\namplitude_m = 1".to_owned(), "t.toml:3: missing field", "wavelength_m"),
            ("[map]\nleave_out = [\"trees\"]".to_owned(), "t.toml:2: unknown variant", "boulders"),
            ("[slope]\ngrade = 0.1\nup_deg = 3".to_owned(), "t.toml:3: unknown field", "uphill_deg"),
            ("[[bumps]]\nheight_m = 0\nwavelength_m = 1\n[[bumps]]\nheight_m = -1\nwavelength_m = 1"
                .to_owned(), "t.toml:4: [bumps]", "0 to 2 m"),
            ("[slope]\ngrade = 1\n[grid]\nx_m = [0, 1e5]".to_owned(), "t.toml:3: [grid]", "smaller"),
            (String::new(), "t.toml:1: no layer", "flat"),
            ("a = ".to_owned(), "t.toml:1: ", ""),
        ];
        for (text, starts, contains) in cases {
            let error = refusal(&text);
            assert!(error.starts_with(starts), "{error}");
            assert!(error.contains(contains) && !error.contains('\n'), "{error}");
        }
    }

    #[test]
    fn a_spec_survives_being_written() {
        let text = "[slope]\ngrade = 0.1\n[[perlin]]\namplitude_m = 0.2\nwavelength_m = 4\n\
            [boulders]\ncount = 3\nradius_m = [0.3, 0.4]\nheight_m = [0.1, 0.2]\n\
            [map]\nleave_out = [\"boulders\"]\nnoise_m = 0.045\n";
        let spec = TerrainSpec::parse(text, Path::new("t.toml")).unwrap();
        let written = spec.clone().reseeded(7).reseeded(7).to_toml().unwrap();
        assert_eq!(TerrainSpec::parse(&written, Path::new("t.toml")).unwrap(), spec, "{written}");
    }

    proptest! {
        #[test]
        fn no_text_panics(text in "([a-z_\\[\\]]{0,10} ?= ?[\\[\\]{}\"a-z.,0-9 -]{0,24}\n){0,6}") {
            let _ = TerrainSpec::parse(&text, Path::new("t.toml"));
        }
    }
}
