//! A field log as time series: candump, plain or gzipped, or MCAP, read through the log's own DBC.

mod attendance;
mod intake;
mod order;

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::path::Path;
use std::sync::Arc;

use flate2::bufread::MultiGzDecoder;
use xt28_bus::candump::Reader;

use crate::recorded::{self, MAGIC};
use crate::{Channel, Decoder, FaultKind, GapError, LogFault, Series};
use intake::Intake;

/// First two bytes of gzip (RFC 1952); no candump line begins so.
const GZIP_MAGIC: [u8; 2] = [0x1F, 0x8B];

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
