//! One message that carries channels: which frames of it can be read, and what they say in SI.

use std::time::Duration;

use xt28_dbc::{Frame, e2e};
use xt28_dbc_model::{Kind, Message, Signal, ValueError};

use crate::Channel;

/// A message that carries channels.
#[derive(Clone, Debug)]
pub(crate) struct Tap {
    message: Message,
    readings: Vec<Reading>,
    /// Data ID of what its CRC covers, where it has one.
    protection: Option<u16>,
}

#[derive(Clone, Debug)]
struct Reading {
    channel: Channel,
    signal: Signal,
    si_per: f64,
    si_from: f64,
}

/// Why nothing is read from a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Unread {
    /// It has fewer bytes than the DBC says.
    Short,
    /// Its CRC is not that of its data.
    Crc,
}

impl Tap {
    pub(super) fn new(message: &Message) -> Self {
        let protection = message.is_protected().then_some(message.data_id);
        Self { message: message.clone(), readings: Vec::new(), protection }
    }

    /// Reads `channel` from `signal` too, of which one is `si_per` in SI and nothing `si_from`.
    pub(super) fn add(&mut self, channel: Channel, signal: &Signal, [si_per, si_from]: [f64; 2]) {
        self.readings.push(Reading { channel, signal: signal.clone(), si_per, si_from });
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

    /// Whether its frames carry an alive counter, so that no two in a row are the same.
    pub(crate) fn counts(&self) -> bool {
        self.message.alive || self.message.signal("Counter").is_some()
    }

    /// Whether a signal that is read of it has no sign: all ones are the most that it can say.
    pub(crate) fn has_unsigned(&self) -> bool {
        let is_unsigned = |reading: &Reading| reading.signal.field.kind == Kind::Unsigned;
        self.readings.iter().any(is_unsigned)
    }

    /// Channels it carries.
    pub(crate) fn channels(&self) -> impl Iterator<Item = Channel> {
        self.readings.iter().map(|reading| reading.channel)
    }

    /// By how much one count changes `channel`, SI.
    pub(crate) fn step_of(&self, channel: Channel) -> Option<f64> {
        let reading = self.readings.iter().find(|reading| reading.channel == channel)?;
        let Reading { signal, si_per, .. } = reading;
        let field = &signal.field;
        (!field.is_float()).then(|| (field.factor * si_per).abs())
    }

    /// Why nothing is read from `frame`; `None` where it can be. More bytes than the DBC says are no
    /// reason: some nodes pad all they send to eight.
    pub(crate) fn unread(&self, frame: &Frame) -> Option<Unread> {
        let data = frame.data();
        if data.len() < self.bytes() {
            return Some(Unread::Short);
        }
        let (crc, payload) = data.split_last()?;
        (e2e::crc(self.protection?, payload) != *crc).then_some(Unread::Crc)
    }

    /// Values in SI that `frame` carries, or why one cannot be believed; none where the frame is
    /// [unread](Self::unread). A multiplexed signal is there when its switch says so.
    pub(crate) fn values(
        &self,
        frame: &Frame,
    ) -> impl Iterator<Item = (Channel, Result<f64, ValueError>)> {
        let data = *frame;
        let readable = self.unread(frame).is_none();
        let present =
            move |r: &&Reading| readable && self.message.is_present(&r.signal, data.data());
        self.readings.iter().filter(present).map(move |r| {
            let si = |value: f64| value * r.si_per + r.si_from;
            (r.channel, r.signal.field.read(data.data()).map(si))
        })
    }
}
