//! Which signal of a DBC is which channel: the built-in names, and a file where a log has others.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::Deserialize;
use toml::Spanned;

use crate::toml_error::{line_of, locate};
use crate::{Channel, GapError};

/// The names of this bench's own database.
const BUILTIN: &str = include_str!("mapping.toml");

/// Where every channel is found.
#[derive(Clone, Debug, PartialEq)]
pub struct Mapping {
    sources: BTreeMap<Channel, Source>,
    /// The user's file, and the line in it of each channel that it names.
    file: PathBuf,
    named: BTreeMap<Channel, usize>,
}

/// Where one channel is found.
#[derive(Clone, Debug, PartialEq)]
pub struct Source {
    /// Name of the message in the DBC.
    pub message: String,
    /// Name of the signal in that message.
    pub signal: String,
    /// Unit of the signal's physical value; the DBC's own where `None`.
    pub unit: Option<String>,
    /// Multiplies the physical value, -1 where the signal counts the other way.
    pub scale: f64,
    /// Added to that, in `unit`: where the signal counts from another zero.
    pub offset: f64,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct MappingFile {
    signals: BTreeMap<Spanned<String>, Entry>,
}

#[derive(Deserialize)]
#[serde(untagged, expecting = "expected \"Message.Signal\" or { signal, unit, scale, offset }")]
enum Entry {
    Name(String),
    Table(EntryTable),
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct EntryTable {
    signal: String,
    unit: Option<String>,
    scale: Option<f64>,
    offset: Option<f64>,
}

impl Default for Mapping {
    /// The names of this bench's own database.
    fn default() -> Self {
        let (sources, named) = (BTreeMap::new(), BTreeMap::new());
        let mut mapping = Self { sources, file: PathBuf::new(), named };
        mapping
            .read(BUILTIN, Path::new("mapping.toml"))
            .expect("the built-in mapping is valid: a test reads it");
        mapping.named.clear();
        mapping
    }
}

impl Mapping {
    /// The file that [`Mapping::default`] reads, as a start for one of somebody else's names.
    #[must_use]
    pub const fn builtin_text() -> &'static str {
        BUILTIN
    }

    /// The built-in names, with those in the file at `path` over them.
    ///
    /// # Errors
    /// [`GapError::Read`] or [`GapError::Toml`].
    pub fn load(path: &Path) -> Result<Self, GapError> {
        let text = std::fs::read_to_string(path).map_err(|source| GapError::read(path, source))?;
        Self::parse(&text, path)
    }

    /// The built-in names, with those in `text` over them; `path` names it in errors.
    ///
    /// # Errors
    /// [`GapError::Toml`].
    pub fn parse(text: &str, path: &Path) -> Result<Self, GapError> {
        let mut mapping = Self { file: path.to_owned(), ..Self::default() };
        mapping.read(text, path)?;
        Ok(mapping)
    }

    /// Where `channel` is found; `None` only if a mapping were not complete.
    #[must_use]
    pub fn source(&self, channel: Channel) -> Option<&Source> {
        self.sources.get(&channel)
    }

    /// All channels with where they are found.
    pub fn iter(&self) -> impl Iterator<Item = (Channel, &Source)> {
        self.sources.iter().map(|(channel, source)| (*channel, source))
    }

    /// The user's file and the line in it that names `channel`'s source; `None` where it is built in.
    pub(crate) fn named_at(&self, channel: Channel) -> Option<(&Path, usize)> {
        self.named.get(&channel).map(|line| (self.file.as_path(), *line))
    }

    fn read(&mut self, text: &str, path: &Path) -> Result<(), GapError> {
        let refuse = |(line, problem)| GapError::Toml { path: path.to_owned(), line, problem };
        let file: MappingFile =
            toml::from_str(text).map_err(|error| refuse(locate(text, &error)))?;
        for (name, entry) in file.signals {
            let line = line_of(text, name.span().start);
            let channel = Channel::from_name(name.get_ref()).ok_or_else(|| {
                refuse((line, format!("unknown channel `{}`, one is `stroke.FR`", name.get_ref())))
            })?;
            let source = entry.source().map_err(|problem| refuse((line, problem)))?;
            self.sources.insert(channel, source);
            self.named.insert(channel, line);
        }
        match self.read_twice() {
            Some((line, problem)) => Err(refuse((line, problem))),
            None => Ok(()),
        }
    }

    /// Two channels that one signal would be read for, and the line that makes it so: one arm would be taken
    /// for another without a word.
    fn read_twice(&self) -> Option<(usize, String)> {
        let mut readers: BTreeMap<(&str, &str), Channel> = BTreeMap::new();
        for (channel, source) in self.iter() {
            let signal = (source.message.as_str(), source.signal.as_str());
            let Some(other) = readers.insert(signal, channel) else { continue };
            let lines = [channel, other].map(|channel| self.named.get(&channel).copied());
            let line = lines.into_iter().flatten().max().unwrap_or_default();
            let (message, signal) = signal;
            let problem = format!(
                "both {other} and {channel} would be read from {message}.{signal}; give one of them another"
            );
            return Some((line, problem));
        }
        None
    }
}

impl Entry {
    fn source(self) -> Result<Source, String> {
        let table = match self {
            Self::Name(signal) => EntryTable { signal, unit: None, scale: None, offset: None },
            Self::Table(table) => table,
        };
        let scale = table.scale.unwrap_or(1.0);
        if !scale.is_finite() || scale == 0.0 {
            return Err(format!("scale = {scale} says nothing; use a finite number other than 0"));
        }
        let offset = table.offset.unwrap_or(0.0);
        if !offset.is_finite() {
            return Err(format!("offset = {offset} says nothing; use a finite number"));
        }
        match table.signal.split_once('.') {
            Some((message, signal)) if !message.is_empty() && !signal.is_empty() => Ok(Source {
                message: message.to_owned(),
                signal: signal.to_owned(),
                unit: table.unit,
                scale,
                offset,
            }),
            _ => Err(format!("`{}` is not of the form \"Message.Signal\"", table.signal)),
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn refused(text: &str) -> String {
        Mapping::parse(text, Path::new("m.toml")).unwrap_err().to_string()
    }

    #[test]
    fn the_built_in_mapping_has_every_channel_once() {
        let mapping = Mapping::default();
        for channel in Channel::all() {
            assert!(mapping.source(channel).is_some(), "{channel}");
        }
        let mut signals: Vec<_> = mapping.iter().map(|(_, s)| (&s.message, &s.signal)).collect();
        signals.sort();
        signals.dedup();
        assert_eq!(signals.len(), Channel::all().len());
    }

    #[test]
    fn a_file_overrides_single_channels() {
        let text = "[signals]\n\"stroke.FR\" = \"Susp.S1\"\n\
                    \"attitude.roll\" = { signal = \"Imu.R\", unit = \"rad\", scale = -1 }\n";
        let mapping = Mapping::parse(text, Path::new("m.toml")).unwrap();
        assert_eq!(mapping.source(Channel::from_name("stroke.FR").unwrap()).unwrap().signal, "S1");
        let roll = mapping.source(Channel::Roll).unwrap();
        assert_eq!((roll.unit.as_deref(), roll.scale), (Some("rad"), -1.0));
        assert_eq!(mapping.source(Channel::Pitch), Mapping::default().source(Channel::Pitch));
    }

    #[test]
    fn what_is_wrong_is_said_with_its_line() {
        let unknown = refused("[signals]\n\n\"stroke.XX\" = \"A.B\"\n");
        assert!(unknown.starts_with("m.toml:3: unknown channel `stroke.XX`"), "{unknown}");
        let form = refused("[signals]\n\"stroke.FR\" = \"PosFront\"\n");
        assert!(form.starts_with("m.toml:2: `PosFront` is not of the form"), "{form}");
        let key = refused("[signal]\n");
        assert!(key.starts_with("m.toml:1: unknown field `signal`"), "{key}");
        let twice = refused("[signals]\n\n\"stroke.FR\" = \"PosFront.FL\"\n");
        let both = "m.toml:3: both stroke.FR and stroke.FL would be read from PosFront.FL";
        assert!(twice.starts_with(both), "{twice}");
        let scale = refused("[signals]\n\"stroke.FR\" = { signal = \"A.B\", scale = 0 }\n");
        assert!(scale.contains("scale = 0"), "{scale}");
        let offset = refused("[signals]\n\"stroke.FR\" = { signal = \"A.B\", offset = inf }\n");
        assert!(offset.contains("offset = inf"), "{offset}");
    }

    proptest! {
        #[test]
        fn no_text_panics(text in "(\\[signals\\]\n)?(\"?[a-z_.A-Z]{0,12}\"? ?= ?[\"{}a-z.=0-9 ]{0,24}\n){0,4}") {
            let _ = Mapping::parse(&text, Path::new("m.toml"));
        }
    }
}
