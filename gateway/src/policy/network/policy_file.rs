//! The policy file: which tensors a network is, and all that it was trained to see, refused line by line.

use core::cmp::Ordering;
use std::fs::File;
use std::io::Read as _;
use std::path::{Path, PathBuf};

use serde::Deserialize;
use toml::Spanned;

use super::layers::{Activation, Layers, Squash};
use super::rate::Rate;
use super::term::Term;
use super::window::{Input, Order, Scaled, Window};
use crate::policy::toml_text::{line_at, parsed};

/// Most frames of a window: six seconds at the receiver's rate.
const FRAMES_MAX: usize = 50;
/// Most numbers that a network is fed with.
const WIDTH_MAX: usize = 100_000;
/// The largest file of weights that is read, bytes: there may be other tensors in it.
const WEIGHTS_MAX: u64 = 256 << 20;
/// Numbers of an action.
const ACTION: usize = 8;

/// Why a network was refused.
#[derive(Debug, thiserror::Error)]
pub enum NetworkError {
    /// A file could not be read.
    #[error(
        "{path}: cannot read it: {source}; give network: a policy file, and `weights` in it beside it"
    )]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// The text is not a policy file.
    #[error("{path}:{line}: {problem}")]
    Parse {
        /// The file.
        path: PathBuf,
        /// Line, from 1.
        line: usize,
        /// What is wrong there and what would be right.
        problem: String,
    },
    /// The weights are not those of the policy file.
    #[error("{path}: {problem}")]
    Weights {
        /// The file of the weights.
        path: PathBuf,
        /// Which tensor, and what would be right.
        problem: String,
    },
    /// What it needs beside its file, or does not.
    #[error("{path}: {problem}")]
    Given {
        /// The policy file.
        path: PathBuf,
        /// What would be right.
        problem: &'static str,
    },
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PolicyFile {
    weights: PathBuf,
    layers: Vec<String>,
    activation: Activation,
    squash: Squash,
    rate: Spanned<RateKey>,
    input: Vec<InputTable>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct InputTable {
    frames: Option<Spanned<usize>>,
    newest: Option<Place>,
    terms: Vec<TermTable>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct TermTable {
    name: Spanned<Term>,
    offset: Option<Numbers>,
    scale: Option<Numbers>,
    clip: Option<Clip>,
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Place {
    First,
    Last,
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(untagged, expecting = "a rate is \"fix\" or 10, 20, 25, 50 or 100 Hz")]
enum RateKey {
    Fix(Fix),
    Hz(u32),
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Fix {
    Fix,
}

#[derive(Debug, Deserialize)]
#[serde(untagged, expecting = "a number, or one for each number of the term")]
enum Numbers {
    One(f64),
    Each(Vec<f64>),
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(untagged, expecting = "a clip is a number above 0, or [least, most]")]
enum Clip {
    Both(f64),
    Range([f64; 2]),
}

/// What a policy file comes to.
pub(super) struct Trained {
    pub(super) window: Window,
    pub(super) layers: Layers,
    pub(super) rate: Rate,
}

impl PolicyFile {
    /// Reads the policy file at `path`, and the weights that it names.
    pub(super) fn read(path: &Path) -> Result<Trained, NetworkError> {
        let (file, window, rate) = Self::parse(&text_of(path)?, path)?;
        let weights = file.weights_beside(path);
        let bytes = bytes_of(&weights)?;
        let kinds = (file.activation, file.squash);
        let layers = Layers::read(&bytes, &file.layers, [window.width(), ACTION], kinds)
            .map_err(|problem| NetworkError::Weights { path: weights, problem })?;
        Ok(Trained { window, layers, rate })
    }

    /// Where the weights are that the policy file at `path` names; none where nobody can tell.
    pub(super) fn weights_of(path: &Path) -> Option<PathBuf> {
        Some(Self::parse(&text_of(path).ok()?, path).ok()?.0.weights_beside(path))
    }

    fn weights_beside(&self, path: &Path) -> PathBuf {
        path.parent().unwrap_or(Path::new("")).join(&self.weights)
    }

    fn parse(text: &str, path: &Path) -> Result<(Self, Window, Rate), NetworkError> {
        let refuse = |at: usize, problem: String| NetworkError::Parse {
            path: path.to_owned(),
            line: line_at(text.as_bytes(), at),
            problem,
        };
        let file: Self = parsed(text).map_err(|(at, problem)| refuse(at, problem))?;
        let rate = match *file.rate.get_ref() {
            RateKey::Fix(Fix::Fix) => Rate::Fix,
            RateKey::Hz(hz) => Rate::of_hz(hz).ok_or_else(|| {
                let problem = format!("rate = {hz}: give \"fix\" or 10, 20, 25, 50 or 100 Hz");
                refuse(file.rate.span().start, problem)
            })?,
        };
        let mut names = file.layers.iter().map(String::as_str).chain(file.weights.to_str());
        if let Some(name) = names.find(|name| name.contains(char::is_control)) {
            return Err(refuse(0, format!("{name:?} is no name: it has control characters")));
        }
        let inputs = file.input.iter().map(|table| {
            table.input().map_err(|(at, problem)| refuse(at.unwrap_or_default(), problem))
        });
        let window = Window::new(inputs.collect::<Result<_, _>>()?);
        match window.width() {
            0 => Err(refuse(0, "the network sees nothing; name terms in [[input]]".to_owned())),
            width if width > WIDTH_MAX => {
                let problem = format!("{width} numbers to see; give {WIDTH_MAX} at most");
                Err(refuse(0, problem))
            }
            _ if file.layers.is_empty() => {
                let problem = "layers = [] is no network; name its layers, first to last";
                Err(refuse(0, problem.to_owned()))
            }
            _ => Ok((file, window, rate)),
        }
    }
}

/// Whether a network can be fed with `number`.
#[allow(clippy::cast_possible_truncation)] // it is about what is lost by it
fn is_fed(number: f64) -> bool {
    (number as f32).is_finite()
}

/// Where, as an offset into the text, and what is wrong there.
type Fault = (Option<usize>, String);

impl InputTable {
    fn input(&self) -> Result<Input, Fault> {
        let frames = self.frames.as_ref().map_or(1, |frames| *frames.get_ref());
        let at = self.frames.as_ref().map(|frames| frames.span().start);
        if !(1..=FRAMES_MAX).contains(&frames) {
            return Err((at, format!("frames = {frames} must be 1 to {FRAMES_MAX}")));
        }
        let order = match self.newest {
            Some(Place::First) => Order::NewestFirst,
            Some(Place::Last) => Order::OldestFirst,
            None if frames == 1 => Order::OldestFirst,
            None => {
                let problem = format!(
                    "which of {frames} frames comes first? Say newest = \"last\" or newest = \"first\""
                );
                return Err((at, problem));
            }
        };
        let terms = self.terms.iter().map(TermTable::scaled).collect::<Result<_, _>>()?;
        Ok(Input { frames, order, terms })
    }
}

impl TermTable {
    fn scaled(&self) -> Result<Scaled, Fault> {
        let (term, at) = (*self.name.get_ref(), Some(self.name.span().start));
        let width = term.width();
        let each = |key: &str, numbers: &Option<Numbers>, or: f64| -> Result<Vec<f64>, Fault> {
            let each = match numbers {
                None => vec![or; width],
                Some(Numbers::One(number)) => vec![*number; width],
                Some(Numbers::Each(numbers)) => numbers.clone(),
            };
            if each.len() != width {
                let count = each.len();
                let problem = format!("{key} has {count} numbers, the term has {width}");
                return Err((at, problem));
            }
            match each.iter().find(|number| !is_fed(**number)) {
                Some(number) => Err((at, format!("{key} = {number} must be a number of 32 bits"))),
                None => Ok(each),
            }
        };
        let clip = match self.clip {
            None => [f64::NEG_INFINITY, f64::INFINITY],
            Some(Clip::Both(most)) => [-most, most],
            Some(Clip::Range(range)) => range,
        };
        let is_clipped = self.clip.is_some();
        let is_range = clip[0].partial_cmp(&clip[1]) == Some(Ordering::Less);
        if !is_range || (is_clipped && !clip.into_iter().all(is_fed)) {
            let problem = "clip must be a number above 0, or [least, most]";
            return Err((at, problem.to_owned()));
        }
        let offset = each("offset", &self.offset, 0.0)?;
        Ok(Scaled { term, offset, scale: each("scale", &self.scale, 1.0)?, clip })
    }
}

fn text_of(path: &Path) -> Result<String, NetworkError> {
    String::from_utf8(bytes_of(path)?).map_err(|error| {
        let line = line_at(error.as_bytes(), error.utf8_error().valid_up_to());
        let problem = "no UTF-8; save the file as that".to_owned();
        NetworkError::Parse { path: path.to_owned(), line, problem }
    })
}

fn bytes_of(path: &Path) -> Result<Vec<u8>, NetworkError> {
    let unread = |source| NetworkError::Read { path: path.to_owned(), source };
    let mut bytes = Vec::new();
    let file = File::open(path).map_err(unread)?;
    file.take(WEIGHTS_MAX + 1).read_to_end(&mut bytes).map_err(unread)?;
    if bytes.len() as u64 > WEIGHTS_MAX {
        let problem = format!("larger than {WEIGHTS_MAX} bytes, which no policy here is");
        return Err(NetworkError::Weights { path: path.to_owned(), problem });
    }
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::super::made_up::FILE;
    use super::*;

    fn refused(from: &str, to: &str) -> String {
        assert!(FILE.contains(from), "{from}");
        let text = FILE.replacen(from, to, 1);
        let path = Path::new("p.toml");
        PolicyFile::parse(&text, path).map(|_| ()).expect_err(&text).to_string()
    }

    #[test]
    fn a_policy_file_is_refused_with_line_and_remedy() {
        assert!(PolicyFile::parse(FILE, Path::new("p.toml")).is_ok());
        for (from, to, says) in [
            ("\"fix\"", "8", "p.toml:5: rate = 8: give \"fix\" or 10, 20"),
            ("\"fix\"", "\"often\"", "p.toml:5: a rate is \"fix\" or 10"),
            ("frames = 2", "frames = 0", "p.toml:8: frames = 0 must be 1 to 50"),
            ("newest = \"last\"", "", "p.toml:8: which of 2 frames comes first?"),
            (
                "\"roll_rad\"",
                "\"roll\"",
                "p.toml:11: unknown variant `roll`, expected one of `goal_m`",
            ),
            (
                "scale = [1.0, 2.0]",
                "scale = [1.0]",
                "p.toml:16: scale has 1 numbers, the term has 2",
            ),
            (
                "scale = [1.0, 2.0]",
                "scale = nan",
                "p.toml:16: scale = NaN must be a number of 32 bits",
            ),
            ("clip = 5", "clip = 0", "p.toml:16: clip must be a number above 0"),
            ("clip = 5", "clip = [1, nan]", "p.toml:16: clip must be"),
            ("clip = 5", "clip = inf", "p.toml:16: clip must be"),
            ("scale = [1.0, 2.0]", "scale = 1e300", "p.toml:16: scale = 1"),
            ("[\"0\"]", "[\"a\\nb\"]", "p.toml:1: \"a\\nb\" is no name"),
            ("[\"0\"]", "[]", "p.toml:1: layers = [] is no network"),
            ("squash", "squish", "unknown field `squish`"),
            ("\"tanh\"", "\"gelu\"", "p.toml:3: unknown variant `gelu`"),
        ] {
            let error = refused(from, to);
            assert!(error.contains(says), "{error}\n{says}");
        }
    }
}
