//! Frames of a log to samples of channels, as the log's own DBC and a mapping say.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::Duration;

use xt28_dbc::{CanId, Frame};
use xt28_dbc_model::{Database, Message, Signal, ValueError};

use crate::{Channel, GapError, Mapping, Need, Source};

/// Reads channels from frames. Knows no identifier and no layout of its own.
#[derive(Clone, Debug)]
pub struct Decoder {
    messages: BTreeMap<u32, Tap>,
    names: BTreeMap<Channel, String>,
    missing: Vec<Channel>,
}

/// A message that carries channels.
#[derive(Clone, Debug)]
pub(crate) struct Tap {
    message: Message,
    readings: Vec<Reading>,
}

#[derive(Clone, Debug)]
struct Reading {
    channel: Channel,
    signal: Signal,
    si_per: f64,
}

impl Decoder {
    /// A decoder for the DBC at `path`, with the channels where `mapping` has them.
    ///
    /// # Errors
    /// [`GapError::Dbc`], [`GapError::Missing`] for a required channel, [`GapError::Unit`].
    pub fn load(path: &Path, mapping: &Mapping) -> Result<Self, GapError> {
        let text = std::fs::read_to_string(path).map_err(|source| GapError::read(path, source))?;
        Self::parse(&text, path, mapping)
    }

    /// A decoder for a DBC's text; `path` names it in errors.
    ///
    /// # Errors
    /// [`GapError::Dbc`], [`GapError::Missing`] for a required channel, [`GapError::Unit`].
    pub fn parse(text: &str, path: &Path, mapping: &Mapping) -> Result<Self, GapError> {
        let database = Database::parse(text, &path.display().to_string())
            .map_err(|error| GapError::Dbc { problem: error.to_string() })?;
        let name = |(channel, source): (Channel, &Source)| {
            (channel, format!("{}.{}", source.message, source.signal))
        };
        let names = mapping.iter().map(name).collect();
        let mut decoder = Self { messages: BTreeMap::new(), names, missing: Vec::new() };
        for (channel, source) in mapping.iter() {
            let Some(message) = database.message_named(&source.message) else {
                decoder.miss(path, mapping, channel, None)?;
                continue;
            };
            let Some(signal) = message.signal(&source.signal) else {
                decoder.miss(path, mapping, channel, Some(message))?;
                continue;
            };
            let unit = source.unit.as_deref().unwrap_or(&signal.unit);
            let si_per = channel.dimension().si_per(unit).ok_or_else(|| GapError::Unit {
                path: path.to_owned(),
                signal: format!("{}.{}", source.message, source.signal),
                unit: unit.to_owned(),
                channel: channel.to_string(),
                known: channel.dimension().units(),
            })?;
            let reading =
                Reading { channel, signal: signal.clone(), si_per: si_per * source.scale };
            let tap = decoder.messages.entry(message.id).or_insert_with(|| Tap::new(message));
            tap.readings.push(reading);
        }
        Ok(decoder)
    }

    /// Channels that the DBC lacks; none that a replay needs.
    #[must_use]
    pub fn missing(&self) -> &[Channel] {
        &self.missing
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

    pub(crate) fn tap(&self, id: CanId) -> Option<&Tap> {
        self.messages.get(&id.dbc())
    }

    fn miss(
        &mut self,
        path: &Path,
        mapping: &Mapping,
        channel: Channel,
        message: Option<&Message>,
    ) -> Result<(), GapError> {
        if channel.need() == Need::Optional {
            self.missing.push(channel);
            return Ok(());
        }
        Err(missing(path.to_owned(), mapping, channel, message))
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
    if message.is_some() {
        let what = format!("signal `{}` in message `{}`", source.signal, source.message);
        return GapError::Missing { path, what, channels: channel.to_string() };
    }
    let orphans = mapping.iter().filter(|(_, other)| other.message == source.message);
    let channels: Vec<String> = orphans.map(|(channel, _)| channel.to_string()).collect();
    let what = format!("message `{}`", source.message);
    GapError::Missing { path, what, channels: channels.join(", ") }
}

impl Tap {
    fn new(message: &Message) -> Self {
        Self { message: message.clone(), readings: Vec::new() }
    }

    /// Name of the message.
    pub(crate) fn name(&self) -> &str {
        &self.message.name
    }

    /// Bytes that a frame of it has.
    pub(crate) fn bytes(&self) -> usize {
        usize::from(self.message.len)
    }

    /// Time from one frame to the next, where the DBC says.
    pub(crate) fn period(&self) -> Option<Duration> {
        let period_ms = u64::from(self.message.period_ms);
        (period_ms > 0).then(|| Duration::from_millis(period_ms))
    }

    /// Channels it carries.
    pub(crate) fn channels(&self) -> impl Iterator<Item = Channel> {
        self.readings.iter().map(|reading| reading.channel)
    }

    /// Values in SI that `frame` carries, or why one cannot be believed. A frame of another length
    /// carries none, a multiplexed signal is there when its switch says so.
    pub(crate) fn values(
        &self,
        frame: &Frame,
    ) -> impl Iterator<Item = (Channel, Result<f64, ValueError>)> {
        let data = *frame;
        let readable = frame.data().len() == self.bytes();
        let present =
            move |r: &&Reading| readable && self.message.is_present(&r.signal, data.data());
        self.readings.iter().filter(present).map(move |r| {
            (r.channel, r.signal.field.read(data.data()).map(|value| value * r.si_per))
        })
    }
}
