//! Frames of a log to samples of channels, as the log's own DBC and a mapping say.

mod tap;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use xt28_dbc::CanId;
use xt28_dbc_model::{Database, Message, Signal, text};

use crate::{Channel, GapError, Mapping, Need, Source};

pub(crate) use tap::{Tap, Unread};

/// Reads channels from frames. Knows no identifier and no layout of its own.
#[derive(Clone, Debug)]
pub struct Decoder {
    messages: BTreeMap<u32, Tap>,
    names: BTreeMap<Channel, String>,
}

impl Decoder {
    /// A decoder for the DBC at `path`, in UTF-8 or Windows-1252, with the channels where `mapping`
    /// has them.
    ///
    /// # Errors
    /// As [`Decoder::parse`], and [`GapError::Read`].
    pub fn load(path: &Path, mapping: &Mapping) -> Result<Self, GapError> {
        let bytes = std::fs::read(path).map_err(|source| GapError::read(path, source))?;
        Self::parse(&text(&bytes), path, mapping)
    }

    /// A decoder for a DBC's text; `path` names it in errors. What is wrong with messages that carry
    /// no channel is of no matter.
    ///
    /// # Errors
    /// [`GapError::NoDatabase`], [`GapError::Dbc`], [`GapError::Layout`] for a signal that would be misread,
    /// [`GapError::Missing`] for a required channel, [`GapError::Misnamed`] for one that a mapping
    /// file names, [`GapError::Unit`].
    pub fn parse(text: &str, path: &Path, mapping: &Mapping) -> Result<Self, GapError> {
        if !text.lines().any(|line| line.trim_start().starts_with("BO_ ")) {
            return Err(GapError::NoDatabase { path: path.to_owned() });
        }
        let database = Database::parse(text, &path.display().to_string())
            .map_err(|error| GapError::Dbc { problem: error.to_string() })?;
        let name = |(channel, source): (Channel, &Source)| {
            (channel, format!("{}.{}", source.message, source.signal))
        };
        let names = mapping.iter().map(name).collect();
        let mut decoder = Self { messages: BTreeMap::new(), names };
        for (channel, source) in mapping.iter() {
            let Some((message, signal)) = find(&database, path, mapping, channel, source)? else {
                continue;
            };
            let unit = source.unit.as_deref().unwrap_or(&signal.unit);
            let si_per = channel.dimension().si_per(unit).ok_or_else(|| GapError::Unit {
                place: unit_from(path, mapping, channel, source),
                signal: format!("{}.{}", source.message, source.signal),
                unit: unit.to_owned(),
                channel: channel.to_string(),
                known: channel.dimension().units(),
            })?;
            let tap = decoder.messages.entry(message.id).or_insert_with(|| Tap::new(message));
            tap.add(channel, signal, [si_per * source.scale, si_per * source.offset]);
        }
        Ok(decoder)
    }

    /// Name of the message that `channel` is read from.
    #[must_use]
    pub fn message_of(&self, channel: Channel) -> Option<&str> {
        let tap = self.messages.values().find(|tap| tap.channels().any(|c| c == channel))?;
        Some(tap.name())
    }

    /// Message and signal that `channel` is read from, whether or not the DBC has them.
    #[must_use]
    pub fn name_of(&self, channel: Channel) -> String {
        self.names.get(&channel).cloned().unwrap_or_default()
    }

    /// By how much one count of the signal that `channel` is read from changes it, SI; none of one that is not read,
    /// or that is no count.
    #[must_use]
    pub fn step_of(&self, channel: Channel) -> Option<f64> {
        self.messages.values().find_map(|tap| tap.step_of(channel))
    }

    /// Name of the message with this identifier; the identifier itself where nothing is read of it.
    pub(crate) fn name_of_message(&self, id: CanId) -> String {
        self.tap(id).map_or_else(|| id.to_string(), |tap| tap.name().to_owned())
    }

    pub(crate) fn tap(&self, id: CanId) -> Option<&Tap> {
        self.messages.get(&id.dbc())
    }
}

/// Where the database has `channel`; `None` for one that nobody asked for and that can be done without.
fn find<'a>(
    database: &'a Database,
    path: &Path,
    mapping: &Mapping,
    channel: Channel,
    source: &Source,
) -> Result<Option<(&'a Message, &'a Signal)>, GapError> {
    let refuse = |place: String, problem: String| {
        Err(GapError::Layout { place, problem, channel: channel.to_string() })
    };
    if let Some(why) = database.why_unusable(&source.message, &source.signal) {
        return refuse(format!("{}:{}", why.file, why.line), why.problem.clone());
    }
    let message = database.message_named(&source.message);
    let Some((message, signal)) = message.and_then(|m| Some((m, m.signal(&source.signal)?))) else {
        if let Some((file, line)) = mapping.named_at(channel) {
            return Err(GapError::Misnamed {
                path: file.to_owned(),
                line,
                channel: channel.to_string(),
                what: what(source, message),
                dbc: path.to_owned(),
            });
        }
        if channel.need() == Need::Optional {
            return Ok(None);
        }
        return Err(missing(path.to_owned(), mapping, channel, message));
    };
    match database.misread(message, signal) {
        Some(problem) => refuse(path.display().to_string(), problem.to_string()),
        None => Ok(Some((message, signal))),
    }
}

/// Where the unit of `channel` is said: in the DBC at `path`, unless the mapping says another.
fn unit_from(path: &Path, mapping: &Mapping, channel: Channel, source: &Source) -> String {
    match mapping.named_at(channel).filter(|_| source.unit.is_some()) {
        Some((file, line)) => format!("{}:{line}", file.display()),
        None => path.display().to_string(),
    }
}

/// What a source names that is not there; `message` where its message is.
fn what(source: &Source, message: Option<&Message>) -> String {
    match message {
        Some(_) => format!("signal `{}` in message `{}`", source.signal, source.message),
        None => format!("message `{}`", source.message),
    }
}

/// One error for all channels that a missing message leaves without a source.
fn missing(
    path: PathBuf,
    mapping: &Mapping,
    channel: Channel,
    message: Option<&Message>,
) -> GapError {
    let Some(source) = mapping.source(channel) else {
        return GapError::Missing { path, what: "signal".into(), channels: channel.to_string() };
    };
    let what = what(source, message);
    if message.is_some() {
        return GapError::Missing { path, what, channels: channel.to_string() };
    }
    let orphans = mapping.iter().filter(|(_, other)| other.message == source.message);
    let channels: Vec<String> = orphans.map(|(channel, _)| channel.to_string()).collect();
    GapError::Missing { path, what, channels: channels.join(", ") }
}
