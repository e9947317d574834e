//! A field log as time series: candump, plain or gzipped, or MCAP, read through the log's own DBC.

use std::collections::{BTreeMap, BTreeSet};
use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::path::Path;
use std::sync::Arc;

use flate2::bufread::MultiGzDecoder;
use xt28_bus::candump::{Reader, Record};
use xt28_dbc::CanId;
use xt28_dbc_model::ValueError;
use xt28_machine::SimTime;

use crate::decoder::Tap;
use crate::recorded::{self, MAGIC};
use crate::{Channel, Decoder, FaultKind, GapError, LogFault, Need, Series};

/// First two bytes of gzip (RFC 1952); no candump line begins so.
const GZIP_MAGIC: [u8; 2] = [0x1F, 0x8B];
/// A frame this many periods after the last of its kind came after a gap. Below two, so that one lost
/// frame is seen; above one, so that jitter is not.
const GAP_PERIODS: f64 = 1.5;

/// No frame of any message for longer: twenty periods of the fastest are more than a bus ever loses.
const PAUSE_S: f64 = 0.2;

/// What a log measured and what it commanded, against seconds from its first frame.
#[derive(Clone, Debug)]
pub struct FieldLog {
    name: Arc<str>,
    series: BTreeMap<Channel, Series>,
    faults: Vec<LogFault>,
    frames: u64,
    duration_s: f64,
}

impl FieldLog {
    /// Reads the log at `path`. With `accept_cut`, a log that ends in the middle of a line is taken
    /// as ending before it, and says so in [`FieldLog::faults`].
    ///
    /// # Errors
    /// [`GapError::Read`], [`GapError::Log`], [`GapError::Recording`], or [`GapError::Silent`].
    pub fn load(path: &Path, decoder: &Decoder, accept_cut: bool) -> Result<Self, GapError> {
        let file = File::open(path).map_err(|source| GapError::read(path, source))?;
        let mut input = BufReader::new(file);
        let head = input.fill_buf().map_err(|source| GapError::read(path, source))?;
        let name = path.display().to_string();
        if head.starts_with(MAGIC) {
            return Self::read_mcap(input, &name, decoder, accept_cut);
        }
        if head.starts_with(&GZIP_MAGIC) {
            let input = BufReader::new(MultiGzDecoder::new(input));
            Self::read(input, &name, decoder, accept_cut)
        } else {
            Self::read(input, &name, decoder, accept_cut)
        }
    }

    /// Reads a log from `input`; `name` is its name in errors.
    ///
    /// # Errors
    /// [`GapError::Log`] or [`GapError::Silent`].
    pub fn read(
        input: impl BufRead,
        name: &str,
        decoder: &Decoder,
        accept_cut: bool,
    ) -> Result<Self, GapError> {
        let reader = Reader::new(input, name);
        let mut reader = if accept_cut { reader.accepting_cut() } else { reader };
        let mut intake = Intake::default();
        while let Some(record) = reader.read()? {
            intake.take(decoder, &record, reader.line());
        }
        let cut = reader.cut_line().map(|line| (line, FaultKind::Cut));
        intake.finish(name.into(), decoder, cut.into_iter().collect())
    }

    /// Reads a log from an MCAP file's bytes; `name` is its name in errors.
    ///
    /// # Errors
    /// [`GapError::Recording`] or [`GapError::Silent`].
    pub fn read_mcap(
        input: impl Read,
        name: &str,
        decoder: &Decoder,
        accept_cut: bool,
    ) -> Result<Self, GapError> {
        let mut intake = Intake::default();
        let remains = recorded::read(input, name, accept_cut, |record, number| {
            intake.take(decoder, record, number);
        })?;
        let cut = remains.cut.map(|number| (number, FaultKind::Cut));
        let broken = remains
            .broken
            .map(|(number, problem, messages)| (number, FaultKind::Broken { problem, messages }));
        intake.finish(name.into(), decoder, cut.into_iter().chain(broken).collect())
    }

    /// A log of `series` that nobody recorded, `duration_s` s long.
    pub(crate) fn of_series(
        name: &str,
        series: BTreeMap<Channel, Series>,
        duration_s: f64,
    ) -> Self {
        Self { name: name.into(), series, faults: Vec::new(), frames: 0, duration_s }
    }

    /// The log's name, as in errors.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The samples of `channel`, `None` if the log has none.
    #[must_use]
    pub fn series(&self, channel: Channel) -> Option<&Series> {
        self.series.get(&channel)
    }

    /// All channels that the log has samples of.
    #[must_use]
    pub fn all_series(&self) -> &BTreeMap<Channel, Series> {
        &self.series
    }

    /// What is wrong with the log, by line.
    #[must_use]
    pub fn faults(&self) -> &[LogFault] {
        &self.faults
    }

    /// Frames read, of any message.
    #[must_use]
    pub fn frames(&self) -> u64 {
        self.frames
    }

    /// Time from the first frame to the last, s.
    #[must_use]
    pub fn duration_s(&self) -> f64 {
        self.duration_s
    }
}

/// Identifiers that an error names, of those that a DBC has not.
const STRANGE_SHOWN: usize = 5;

/// A log while it is read.
#[derive(Default)]
struct Intake {
    series: BTreeMap<Channel, Series>,
    first: Option<SimTime>,
    latest: SimTime,
    frames: u64,
    known_frames: u64,
    strange: BTreeSet<CanId>,
    back: Option<(u64, f64, u64)>,
    ahead: Option<(u64, f64, u64)>,
    messages: BTreeMap<CanId, Attendance>,
    refused: BTreeMap<Channel, (u64, ValueError, u64)>,
}

/// How well a message keeps its period and length.
#[derive(Default)]
struct Attendance {
    last: Option<SimTime>,
    gaps: u64,
    lost: u64,
    longest_s: f64,
    gap_line: u64,
    wrong_length: Option<(u64, usize, u64)>,
}

impl Intake {
    fn take(&mut self, decoder: &Decoder, record: &Record, line: u64) {
        self.frames += 1;
        let first = *self.first.get_or_insert(record.at);
        if record.at < self.latest {
            let by_s = (self.latest - record.at).as_secs_f64();
            let (worst_line, most_s, frames) = self.back.get_or_insert((line, by_s, 0));
            if by_s > *most_s {
                (*worst_line, *most_s) = (line, by_s);
            }
            *frames += 1;
            return;
        }
        self.note_pause(record.at, line);
        self.latest = record.at;
        let Some(tap) = decoder.tap(record.frame.id()) else {
            if self.strange.len() < STRANGE_SHOWN {
                self.strange.insert(record.frame.id());
            }
            return;
        };
        self.known_frames += 1;
        let attendance = self.messages.entry(record.frame.id()).or_default();
        attendance.note(tap, record, line);
        let at_s = (record.at - first).as_secs_f64();
        for (channel, value) in tap.values(&record.frame) {
            match value {
                Ok(value) => {
                    self.series.entry(channel).or_default().push(at_s, value);
                }
                Err(error) => self.refused.entry(channel).or_insert((line, error, 0)).2 += 1,
            }
        }
    }

    /// Sees whether the bus was silent before a frame.
    fn note_pause(&mut self, at: SimTime, line: u64) {
        if self.frames < 2 {
            return;
        }
        let by_s = (at - self.latest).as_secs_f64();
        if by_s > PAUSE_S {
            let (longest_line, longest_s, times) = self.ahead.get_or_insert((line, 0.0, 0));
            if by_s > *longest_s {
                (*longest_line, *longest_s) = (line, by_s);
            }
            *times += 1;
        }
    }

    /// What says that this is another bus's log: none of its frames is known.
    fn stranger(&self, log: &str) -> GapError {
        let ids: Vec<String> = self.strange.iter().map(ToString::to_string).collect();
        GapError::Stranger { log: log.to_owned(), frames: self.frames, ids: ids.join(", ") }
    }

    fn finish(
        self,
        name: Arc<str>,
        decoder: &Decoder,
        mut kinds: Vec<(u64, FaultKind)>,
    ) -> Result<FieldLog, GapError> {
        if let Some((line, by_s, left_out)) = self.back
            && left_out > self.frames / 2
        {
            // Not what came after is out of time, but what came before.
            return Err(GapError::ClockSteps { log: name.to_string(), line, by_s: -by_s });
        }
        if self.known_frames == 0 && self.frames > 0 {
            return Err(self.stranger(&name));
        }
        for channel in Channel::all() {
            if channel.need() == Need::Required && !self.series.contains_key(&channel) {
                return Err(GapError::Silent {
                    log: name.to_string(),
                    message: decoder.message_of(channel).unwrap_or_default().to_owned(),
                    channel: channel.to_string(),
                    known: self.known_frames,
                    frames: self.frames,
                });
            }
        }
        if let Some((line, by_s, frames)) = self.back {
            kinds.push((line, FaultKind::ClockBack { by_s, frames }));
        }
        if let Some((line, by_s, times)) = self.ahead {
            kinds.push((line, FaultKind::ClockAhead { by_s, times }));
        }
        for (id, attendance) in &self.messages {
            if let Some(tap) = decoder.tap(*id) {
                kinds.extend(attendance.faults(tap));
            }
        }
        for (channel, (line, error, values)) in self.refused {
            let (channel, problem) = (channel.to_string(), error.to_string());
            kinds.push((line, FaultKind::Unbelievable { channel, problem, values }));
        }
        kinds.sort_by_key(|(line, _)| *line);
        let fault = |(line, kind)| LogFault { log: name.clone(), line, kind };
        Ok(FieldLog {
            faults: kinds.into_iter().map(fault).collect(),
            series: self.series,
            frames: self.frames,
            duration_s: (self.latest - self.first.unwrap_or_default()).as_secs_f64(),
            name,
        })
    }
}

impl Attendance {
    fn note(&mut self, tap: &Tap, record: &Record, line: u64) {
        let found = record.frame.data().len();
        if found != tap.bytes() {
            self.wrong_length.get_or_insert((line, found, 0)).2 += 1;
        }
        if let (Some(last), Some(period)) = (self.last, tap.period()) {
            let away_s = (record.at - last).as_secs_f64();
            let periods = away_s / period.as_secs_f64();
            if periods > GAP_PERIODS {
                if self.gaps == 0 {
                    self.gap_line = line;
                }
                self.gaps += 1;
                // A whole number of periods, some tens of thousands at most.
                #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
                {
                    self.lost += (periods.round() as u64).saturating_sub(1).max(1);
                }
                self.longest_s = self.longest_s.max(away_s);
            }
        }
        self.last = Some(record.at);
    }

    fn faults(&self, tap: &Tap) -> impl Iterator<Item = (u64, FaultKind)> {
        let message = || tap.name().to_owned();
        let dropped = (self.gaps > 0).then(|| {
            let (gaps, frames, longest_s) = (self.gaps, self.lost, self.longest_s);
            (self.gap_line, FaultKind::Dropped { message: message(), gaps, frames, longest_s })
        });
        let length = self.wrong_length.map(|(line, found, frames)| {
            let wanted = tap.bytes();
            (line, FaultKind::WrongLength { message: message(), found, wanted, frames })
        });
        dropped.into_iter().chain(length)
    }
}
