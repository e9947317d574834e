//! A field log as time series: candump, plain or gzipped, or MCAP, read through the log's own DBC.

mod attendance;
mod gaps;
mod gzip;
mod in_turn;
mod intake;
mod interfaces;
mod order;
mod packed;
mod stillness;
mod thinned;

use std::cell::Cell;
use std::collections::BTreeMap;
use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::path::Path;
use std::rc::Rc;
use std::sync::Arc;

use xt28_bus::candump::Reader;

use crate::log_fault::{each_told, told};
use crate::recorded::{self, MAGIC};
use crate::{Channel, Decoder, FaultKind, GapError, LogFault, Series};
pub use gaps::Gap;
use gzip::{Failed, Gzip};
use intake::Intake;
use thinned::is_thinned;

/// A clock that goes ahead by more leaves two logs in one file, and which is meant is not for us to say.
const AHEAD_MAX_S: f64 = 1.0;

/// What a log measured and what it commanded, against seconds from its first frame.
#[derive(Clone, Debug)]
pub struct FieldLog {
    name: Arc<str>,
    series: BTreeMap<Channel, Series>,
    faults: Vec<LogFault>,
    frames: u64,
    duration_s: f64,
    /// Stamp of its first frame, s; none where nobody recorded it.
    begun_s: Option<f64>,
    /// Whether frames of every message, whoever sent it, are missing alike.
    is_thinned: bool,
}

impl FieldLog {
    /// Refuses two logs in one file.
    ///
    /// # Errors
    /// [`GapError::ClockSteps`], where the clock was set back, or ahead by more than a second: what the machine did
    /// meanwhile is left out, and what came next is a jump of every signal, which nothing tells from a fault.
    pub fn ensure_one_clock(&self) -> Result<(), GapError> {
        for fault in &self.faults {
            let by_s = match fault.kind {
                FaultKind::ClockBack { by_s, .. } => -by_s,
                FaultKind::ClockAhead { by_s, .. } if by_s > AHEAD_MAX_S => by_s,
                _ => continue,
            };
            return Err(GapError::ClockSteps {
                log: self.name.to_string(),
                line: fault.line,
                by_s,
            });
        }
        Ok(())
    }

    /// Reads the log at `path`: candump's or an MCAP file, gzipped or not, as its content says. With
    /// `accept_cut`, a log that ends in the middle of a line is taken as ending before it, and says so
    /// in [`FieldLog::faults`].
    ///
    /// # Errors
    /// As [`FieldLog::read`] and [`FieldLog::read_mcap`], and [`GapError::Read`].
    pub fn load(path: &Path, decoder: &Decoder, accept_cut: bool) -> Result<Self, GapError> {
        let file = File::open(path).map_err(|source| GapError::read(path, source))?;
        let mut input = BufReader::new(file);
        let head = input.fill_buf().map_err(|source| GapError::read(path, source))?;
        let name = path.display().to_string();
        if !head.starts_with(&gzip::MAGIC) {
            return Self::of_bytes(input, &name, decoder, accept_cut)?.finish(&name, decoder);
        }
        let trailing = Rc::new(Cell::new(false));
        let input = BufReader::new(Gzip::new(input, Rc::clone(&trailing)));
        let mut intake = Self::of_bytes(input, &name, decoder, accept_cut)?;
        if trailing.get() {
            intake.fault_at_end(FaultKind::Trailing);
        }
        intake.finish(&name, decoder)
    }

    /// What it holds between two instants, with the first of them as zero, and what is wrong with that; of faults
    /// that have no time what is wrong with the whole of it.
    #[must_use]
    pub fn within(self, span_s: [f64; 2]) -> Self {
        let cut = |channel: &Channel, all: &Series| {
            if channel.is_fix() { all.told_within(span_s) } else { all.within(span_s) }
        };
        let series = self.series.iter().map(|(channel, all)| (*channel, cut(channel, all)));
        let duration_s = span_s[1] - span_s[0];
        let share = duration_s / self.duration_s;
        let faults: Vec<LogFault> =
            self.faults.iter().filter_map(|fault| fault.within(span_s, share)).collect();
        let [before, lost] = [&self.faults, &faults].map(|faults| losses(faults));
        let is_thinned = self.is_thinned && lost.len() == before.len() && is_thinned(&lost);
        let begun_s = self.begun_s.map(|begun_s| begun_s + span_s[0]);
        Self { series: series.collect(), duration_s, begun_s, faults, is_thinned, ..self }
    }

    /// The same without a word on what `messages` lost, where nothing is read of them.
    #[must_use]
    pub(crate) fn without_losses_of(mut self, messages: &[&str]) -> Self {
        self.faults.retain(|fault| match &fault.kind {
            FaultKind::Dropped { message, .. } => !messages.contains(&message.as_str()),
            _ => true,
        });
        self
    }

    /// The same without some channels, as if nobody had logged them.
    #[must_use]
    pub fn without(mut self, channels: &[Channel]) -> Self {
        self.series.retain(|channel, _| !channels.contains(channel));
        self
    }

    /// Reads a log from `input`; `name` is its name in errors.
    ///
    /// # Errors
    /// [`GapError::Log`] or [`GapError::Cut`]; [`GapError::Empty`], [`GapError::Stranger`],
    /// [`GapError::Silent`] or [`GapError::AllLeftOut`] for one that lacks what a replay needs;
    /// [`GapError::ClockSteps`].
    pub fn read(
        input: impl BufRead,
        name: &str,
        decoder: &Decoder,
        accept_cut: bool,
    ) -> Result<Self, GapError> {
        Self::of_candump(input, name, decoder, accept_cut)?.finish(name, decoder)
    }

    /// Reads a log from an MCAP file's bytes; `name` is its name in errors.
    ///
    /// # Errors
    /// [`GapError::Recording`], and for what it lacks as [`FieldLog::read`].
    pub fn read_mcap(
        input: impl Read,
        name: &str,
        decoder: &Decoder,
        accept_cut: bool,
    ) -> Result<Self, GapError> {
        Self::of_mcap(input, name, decoder, accept_cut)?.finish(name, decoder)
    }

    /// All of a log that is candump's or an MCAP file, as its first bytes say.
    fn of_bytes(
        mut input: impl BufRead,
        name: &str,
        decoder: &Decoder,
        accept_cut: bool,
    ) -> Result<Intake, GapError> {
        match input.fill_buf() {
            Ok(head) if head.starts_with(MAGIC) => Self::of_mcap(input, name, decoder, accept_cut),
            Ok(head) => {
                packed::ensure_readable(Path::new(name), head)?;
                Self::of_candump(input, name, decoder, accept_cut)
            }
            // It says so only once; what it means is for whoever reads the lines.
            Err(error) => {
                let input = BufReader::new(Failed(Some(error)));
                Self::of_candump(input, name, decoder, accept_cut)
            }
        }
    }

    fn of_candump(
        input: impl BufRead,
        name: &str,
        decoder: &Decoder,
        accept_cut: bool,
    ) -> Result<Intake, GapError> {
        let reader = Reader::new(input, name);
        let mut reader = if accept_cut { reader.accepting_cut() } else { reader };
        let mut intake = Intake::default();
        while let Some(record) = reader.read()? {
            intake.take(decoder, &record, reader.line());
        }
        if let Some(line) = reader.skipped_line() {
            intake.fault(line, FaultKind::passed_over(reader.skipped()));
        }
        if let Some(line) = reader.dropped_line() {
            intake.fault(line, FaultKind::Overrun { dropped: reader.skipped().dropped });
        }
        if let Some(line) = reader.cut_line() {
            intake.fault(line, FaultKind::Cut);
        }
        Ok(intake)
    }

    fn of_mcap(
        input: impl Read,
        name: &str,
        decoder: &Decoder,
        accept_cut: bool,
    ) -> Result<Intake, GapError> {
        let mut intake = Intake::default();
        let remains = recorded::read(input, name, accept_cut, |record, number| {
            intake.take(decoder, record, number);
        })?;
        for (number, kind) in remains.faults() {
            intake.fault(number, kind);
        }
        Ok(intake)
    }

    /// A log of `series` that nobody recorded, `duration_s` s long.
    pub(crate) fn of_series(
        name: &str,
        series: BTreeMap<Channel, Series>,
        duration_s: f64,
    ) -> Self {
        let faults = Vec::new();
        let (frames, begun_s, is_thinned) = (0, None, false);
        Self { name: name.into(), series, faults, frames, duration_s, begun_s, is_thinned }
    }

    /// The same log with other samples, as it would be had its sensors read something else.
    #[must_use]
    pub fn with_series(self, series: BTreeMap<Channel, Series>) -> Self {
        Self { series, ..self }
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

    /// The same for people, a line each: what befell many messages alike is one line.
    #[must_use]
    pub fn told_faults(&self) -> Vec<String> {
        told(&self.faults, self.is_thinned)
    }

    /// The same fault by fault, each with whom to suspect where it befell all messages alike.
    #[must_use]
    pub fn each_fault(&self) -> Vec<String> {
        each_told(&self.faults, self.is_thinned)
    }

    /// Whether frames of every message are missing alike, so that no node lost them, but the bus or who wrote the log.
    #[must_use]
    pub const fn is_thinned(&self) -> bool {
        self.is_thinned
    }

    /// Frames read, of any message.
    #[must_use]
    pub fn frames(&self) -> u64 {
        self.frames
    }

    /// What the first frame was stamped with, s; none where nobody recorded the log.
    #[must_use]
    pub fn begun_s(&self) -> Option<f64> {
        self.begun_s
    }

    /// Time from the first frame to the last, s.
    #[must_use]
    pub fn duration_s(&self) -> f64 {
        self.duration_s
    }
}

/// Frames that each message lost, and of how many, where it lost any.
fn losses(faults: &[LogFault]) -> Vec<[u64; 2]> {
    let of = |fault: &LogFault| match &fault.kind {
        FaultKind::Dropped { gaps, due, .. } => {
            Some([gaps.iter().map(|gap| gap.frames).sum(), *due])
        }
        _ => None,
    };
    faults.iter().filter_map(of).collect()
}
