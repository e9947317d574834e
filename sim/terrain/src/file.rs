//! A terrain from its TOML file: tables of layers, or `kind = "..."` and the keys of the one layer.

use std::collections::BTreeMap;
use std::path::Path;

use serde::Deserialize;
use serde::de::DeserializeOwned;
use toml::{Spanned, Value};

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
            remedy: "give an existing, readable file",
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
    let Some(one) = OneLayer::find(text)? else {
        return tables(text);
    };
    let mut spec = TerrainSpec::default();
    match one.kind.as_str() {
        "flat" => {
            one.layer::<Nothing>()?;
        }
        "slope" => spec.slope = Some(one.layer()?),
        "ramp" => spec.ramp.push(one.layer()?),
        "step" => spec.step.push(one.layer()?),
        "perlin" => spec.perlin.push(one.layer()?),
        "bumps" => spec.bumps.push(one.layer()?),
        "course" => spec.course.push(one.layer()?),
        "boulders" => spec.boulders.push(one.layer()?),
        "height_map" => spec.height_map.push(one.layer()?),
        other => {
            let problem = format!("unknown kind `{other}`, expected one of {KINDS}");
            return Err(Problem { byte: one.at, problem });
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

/// A file of the one layer that its key `kind` names.
struct OneLayer {
    kind: String,
    /// Byte at which `kind` stands.
    at: usize,
    /// The text with blanks for `kind = "..."`: what is left are the layer's keys, at the places where they were.
    keys: String,
}

impl OneLayer {
    /// `None` of a file that has no `kind`.
    fn find(text: &str) -> Result<Option<Self>, Problem> {
        let table: BTreeMap<Spanned<String>, Spanned<Value>> = toml::from_str(text)?;
        let Some((key, value)) = table.into_iter().find(|(key, _)| key.get_ref() == "kind") else {
            return Ok(None);
        };
        let (at, end) = (key.span().start, value.span().end);
        let Value::String(kind) = value.into_inner() else {
            let problem = format!("kind is a string, one of {KINDS}");
            return Err(Problem { byte: at, problem });
        };
        let mut keys = text.to_owned();
        keys.replace_range(at..end, &" ".repeat(end - at));
        Ok(Some(Self { kind, at, keys }))
    }

    /// The layer. A key that is missing is missing where the kind is named.
    fn layer<T: DeserializeOwned>(&self) -> Result<T, Problem> {
        toml::from_str(&self.keys).map_err(|error: toml::de::Error| {
            let problem = Problem::from(error);
            let missing = problem.problem.starts_with("missing field");
            if missing { Problem { byte: self.at, ..problem } } else { problem }
        })
    }
}

/// A layer without keys.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Nothing {}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const RAMP: &str = "kind = \"ramp\"\nx_m = [4, 7, 8.5, 11.5]\nheight_m = 0.3\n\
        y_min_m = -1.9\ny_max_m = -0.5\n";

    const BOULDERS: &str = "count = 3\nradius_m = [0.3, 0.4]\nheight_m = [0.1, 0.2]\n";

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
            (RAMP.replace("height_m", "height_mm"), "t.toml:3: unknown field", "`height_mm`"),
            (format!("# a ramp\n\n{RAMP}up_m = 3\n"), "t.toml:8: unknown field", "`up_m`"),
            (format!("# a ramp\n{}", RAMP.replace("height_m", "#")), "t.toml:2: missing", "height_m"),
            (format!("x_mm = 1\n{RAMP}"), "t.toml:1: unknown field", "`x_mm`"),
            ("# level\n\n\"kind\" = 'flat' # so\nflat = 1".to_owned(), "t.toml:4: unknown", "`flat`"),
            ("\nkind = 3".to_owned(), "t.toml:2: kind is a string", "ramp"),
            (format!("\n{}", RAMP.replace("7, 8.5", "9, 8.5")), "t.toml:3: [ramp]:", "x_m must grow"),
            (RAMP.replace("0.3", "\"high\""), "t.toml:3: invalid type", "f64"),
            (RAMP.replace("7, 8.5", "9, 8.5"), "t.toml:2: [ramp]:", "x_m must grow"),
            ("\n[ramps]\n".to_owned(), "t.toml:2: unknown field `ramps`", "`ramp`"),
            ("\n\n[perlin]\namplitude_m = 1".to_owned(), "t.toml:3: missing field", "wavelength_m"),
            ("[map]\nleave_out = [\"trees\"]".to_owned(), "t.toml:2: unknown variant", "boulders"),
            ("[slope]\ngrade = 0.1\nup_deg = 3".to_owned(), "t.toml:3: unknown field", "uphill_deg"),
            ("[[bumps]]\nheight_m = 0\nwavelength_m = 1\n[[bumps]]\nheight_m = -1\nwavelength_m = 1"
                .to_owned(), "t.toml:4: [bumps]", "0 to 2 m"),
            ("[slope]\ngrade = 1\n[grid]\nx_m = [0, 1e5]".to_owned(), "t.toml:3: [grid]", "smaller"),
            (format!("[boulders]\n{BOULDERS}\n[boulders.clear]\nx_m = [-9, 3]"), "t.toml:6: clear", "both x_m"),
            (format!("{BOULDERS}clear = {{ y_m = [-3, 3] }}\nkind = \"boulders\""), "t.toml:4: clear", "both x_m"),
            (format!("[[boulders]]\n{BOULDERS}clear = {{}}"), "t.toml:5: clear", "both x_m"),
            (format!("[boulders]\n{BOULDERS}[boulders.clear]\nz_m = 1"), "t.toml:6: unknown", "`x_m`"),
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
        let level = TerrainSpec::default();
        let written = level.to_toml().unwrap();
        assert_eq!(TerrainSpec::parse(&written, Path::new("t.toml")).unwrap(), level, "{written}");
    }

    proptest! {
        #[test]
        fn no_text_panics(text in "([a-z_\\[\\]]{0,10} ?= ?[\\[\\]{}\"a-z.,0-9 -]{0,24}\n){0,6}") {
            let _ = TerrainSpec::parse(&text, Path::new("t.toml"));
        }
    }
}
