//! Why a log cannot be read or replayed: one line each, with file, line and remedy.

mod disagreement;

use std::path::{Path, PathBuf};

use xt28_bus::candump::ReadError;

use crate::Voices;
use crate::diagnosis::Swap;

pub use disagreement::Disagreement;

/// Why a log cannot be read or replayed.
#[derive(Debug, thiserror::Error)]
pub enum GapError {
    /// A file could not be read.
    #[error("{path}: cannot read: {source}; give an existing, readable file")]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// A file could not be written.
    #[error("{path}: cannot write: {problem}; give a folder that exists and has room")]
    Write {
        /// The file.
        path: PathBuf,
        /// What went wrong.
        problem: String,
    },
    /// A TOML file is not what it should be.
    #[error("{path}:{line}: {problem}")]
    Toml {
        /// The file.
        path: PathBuf,
        /// Line, from 1.
        line: usize,
        /// What is wrong there, and what would be right.
        problem: String,
    },
    /// A file that is said to be a DBC is something else.
    #[error(
        "{path}: is no DBC, as no line of it declares a message (BO_); give the database that the log was sent with"
    )]
    NoDatabase {
        /// The file.
        path: PathBuf,
    },
    /// The DBC is no database.
    #[error("{problem}")]
    Dbc {
        /// File, line and problem.
        problem: String,
    },
    /// The DBC lacks a message or a signal that a replay needs.
    #[error(
        "{path}: no {what}, which {channels} should come from; use the DBC that the log was sent with, or name its signals in a mapping file"
    )]
    Missing {
        /// The DBC.
        path: PathBuf,
        /// "message `PosFront`", or "signal `FR` in message `PosFront`".
        what: String,
        /// Channels that need it.
        channels: String,
    },
    /// A channel's signal cannot be read as the DBC has it.
    #[error("{place}: {problem}; so {channel} cannot be read")]
    Layout {
        /// The DBC, with the line where one is known.
        place: String,
        /// What is wrong, and what to do.
        problem: String,
        /// The channel.
        channel: String,
    },
    /// A mapping file names what the DBC has not.
    #[error(
        "{path}:{line}: {channel} should come from {what}, and there is none in {dbc}; mend the name, or leave the line out"
    )]
    Misnamed {
        /// The mapping file.
        path: PathBuf,
        /// Line, from 1.
        line: usize,
        /// The channel.
        channel: String,
        /// "message `PosFront`", or "signal `FR` in message `PosFront`".
        what: String,
        /// The DBC.
        dbc: PathBuf,
    },
    /// A signal's unit is not one of its channel.
    #[error(
        "{place}: signal `{signal}` is in `{unit}`, which is no unit of {channel} ({known}); give the right one in a mapping file"
    )]
    Unit {
        /// The DBC, or the line of the mapping that says so.
        place: String,
        /// Message and signal.
        signal: String,
        /// The unit found.
        unit: String,
        /// The channel.
        channel: String,
        /// Units that would do.
        known: &'static str,
    },
    /// The log is not candump's.
    #[error(transparent)]
    Log(ReadError),
    /// The log ends in the middle of a line, or of the stream it is packed in.
    #[error(
        "{log}:{line}: log is cut in the middle of this line; say --accept-cut to take what is there, or copy the log again"
    )]
    Cut {
        /// The log.
        log: String,
        /// Line, from 1.
        line: u64,
    },
    /// An MCAP file that cannot be read, or holds no CAN frames.
    #[error("{log}: at message {message}: {problem}")]
    Recording {
        /// The file.
        log: String,
        /// Message in it, from 1.
        message: u64,
        /// What is wrong there, and what to do.
        problem: String,
    },
    /// The log holds no sample of something that a replay needs.
    #[error(
        "{log}: no frame `{message}` in the log, which {channel} comes from, though {known} of its {frames} frames are known; check that log and DBC belong together{why}"
    )]
    Silent {
        /// The log.
        log: String,
        /// The message's name in the DBC.
        message: String,
        /// The channel.
        channel: String,
        /// Frames of the log that the DBC and the mapping know.
        known: u64,
        /// Frames of the log.
        frames: u64,
        /// A fault of the log that may have cost it those frames; empty without one.
        why: String,
    },
    /// The log holds frames for something that a replay needs, and none can be believed.
    #[error("{fault}; nothing is left of {channel}, which a replay needs")]
    AllLeftOut {
        /// Why the first of them was left out, with log and line.
        fault: String,
        /// The channel.
        channel: String,
    },
    /// The log holds no frame that could be read.
    #[error("{log}: is empty: no classic CAN data frame in it{why}")]
    Empty {
        /// The log.
        log: String,
        /// What it holds instead; empty without anything.
        why: String,
    },
    /// No frame of the log is of a message that the DBC and the mapping know.
    #[error(
        "{log}: none of its {frames} frames ({ids} and the like) is of a message that DBC and mapping know; give the DBC that the log was sent with{why}"
    )]
    Stranger {
        /// The log.
        log: String,
        /// Its frames.
        frames: u64,
        /// Some of their identifiers.
        ids: String,
        /// A fault of the log that may have cost it others; empty without one.
        why: String,
    },
    /// `about.toml` does not speak of this log.
    #[error("{path}: no [[run]] with file = \"{log}\"; add it, or give the terrain with --terrain")]
    NoRun {
        /// The file.
        path: PathBuf,
        /// The log's file name.
        log: String,
    },
    /// Logs of several folders, and what was found beside the first speaks of the first's folder alone.
    #[error(
        "{about} lies beside the first log and {log} elsewhere, so it would be given another day's ground; say --about FILE with a [[run]] for each (file = \"FOLDER/NAME\" where two have one name), or give runs of one folder"
    )]
    OtherFolder {
        /// The file found.
        about: PathBuf,
        /// The first log that lies elsewhere.
        log: PathBuf,
    },
    /// A command of the log is none that this bench's bus can say.
    #[error("{log}: command at {at_s:.3} s: {problem}; check its unit and scale in the mapping")]
    Command {
        /// The log.
        log: String,
        /// Seconds from the log's first frame.
        at_s: f64,
        /// What is wrong with it.
        problem: String,
    },
    /// The log lacks what diagnosis drives the blocks with.
    #[error(
        "{log}: diagnosis needs {channels}, and log or DBC has none; record them too, or say with --mapping what they are called"
    )]
    Unmeasured {
        /// Name of the log.
        log: String,
        /// Names of the channels.
        channels: String,
    },
    /// The log lacks what only a replay needs.
    #[error(
        "{log}: a replay needs {channel}, and log or DBC has none; record it too, or say with --mapping what it is called"
    )]
    Undriven {
        /// The log.
        log: String,
        /// The channel.
        channel: String,
    },
    /// There is too little of a log.
    #[error(
        "{log}: only {duration_s:.2} s of it have every signal, and a diagnosis needs {least_s:.0} s of one run; leave the log out or record longer"
    )]
    TooShort {
        /// The log.
        log: String,
        /// The longest stretch of it with every signal, s.
        duration_s: f64,
        /// The least, s.
        least_s: f64,
    },
    /// A log is two, at the same time.
    #[error("{log}:{line}: {}", voices.of_machines(message))]
    TwoMachines {
        /// The log.
        log: String,
        /// The first line of the second.
        line: u64,
        /// A message that both send.
        message: String,
        /// How both show.
        voices: Voices,
    },
    /// A log is two, one after the other.
    #[error(
        "{log}:{line}: {}; cut the log before this line and give both parts, or one",
        step(*by_s)
    )]
    ClockSteps {
        /// The log.
        log: String,
        /// Line after the step, from 1.
        line: u64,
        /// Its size, s; ahead > 0.
        by_s: f64,
    },
    /// A channel reads what no such machine can have.
    #[error(
        "{log}: {channel} ({signal}) reads {} to {} {unit}, and such a machine has {} to {} {unit} at the most; check DBC and mapping (signal, unit, scale)",
        read(found[0]), read(found[1]), possible[0], possible[1]
    )]
    Impossible {
        /// The log.
        log: String,
        /// The channel.
        channel: String,
        /// Message and signal.
        signal: String,
        /// Least and greatest value, SI.
        found: [f64; 2],
        /// Least and greatest that can be, SI.
        possible: [f64; 2],
        /// SI unit.
        unit: &'static str,
    },
    /// Two sensors tell one thing differently.
    #[error(transparent)]
    Disagreement(#[from] Disagreement),
    /// Commands and readings are not of the same wheels.
    #[error(
        "wheels look swapped: {swap}; nothing is put in order by itself: mend the mapping, or say --accept-wheel-order if the machine itself is wired so"
    )]
    WheelOrder {
        /// Which.
        swap: Swap,
    },
    /// The ground cannot be built.
    #[error(transparent)]
    Terrain(#[from] xt28_sim::TerrainError),
    /// A log is packed by a program, or written by a logger, whose files are not read.
    #[error("{path}: {problem}")]
    OtherForm {
        /// The file.
        path: PathBuf,
        /// What it is, and how to make a log of it.
        problem: String,
    },
    /// Two files hold one log.
    #[error("{again}: the same log as {first}; give each log once, or it counts twice")]
    SameLog {
        /// The log given first.
        first: String,
        /// The log that is the same.
        again: String,
    },
    /// Two files hold parts of one log that overlap.
    #[error(
        "{again}: its {:.1} to {:.1} s are {:.1} to {:.1} s of {first}, reading by reading; cut them from one of the two, or leave one out, for what is fitted on cannot be held out as well",
        again_s[0], again_s[1], first_s[0], first_s[1]
    )]
    SharedTime {
        /// The log given first.
        first: String,
        /// From when to when in it, s.
        first_s: [f64; 2],
        /// The log that holds the same time.
        again: String,
        /// From when to when in it, s.
        again_s: [f64; 2],
    },
    /// No run goes by a name.
    #[error("no run `{name}`; there are {known}: give a file name, a number or a scenario")]
    NoSuchRun {
        /// The name.
        name: String,
        /// The runs there are, each by all of its names.
        known: String,
    },
    /// Several runs go by a name that should mean one.
    #[error(
        "`{name}` may mean {runs}; give the file name, with its folder where two have one name"
    )]
    AmbiguousRun {
        /// The name.
        name: String,
        /// The runs it may mean.
        runs: String,
    },
    /// A run is to be fitted on and held out.
    #[error("{runs}: both to fit on and to hold out; name each run in one of --fit and --held")]
    FittedAndHeld {
        /// The runs.
        runs: String,
    },
    /// No run is left to fit on.
    #[error("no run is left to fit causes on ({why}); name at least one with --fit")]
    NothingFitted {
        /// Who chose so.
        why: String,
    },
}

/// A value as it is read; one beyond all measure by its power of ten, not by its digits.
fn read(value: f64) -> String {
    if value.abs() < 1e7 { format!("{value:.3}") } else { format!("{value:.2e}") }
}

/// What a step of the clock looks like: ahead nobody can tell it from a logger that paused.
fn step(by_s: f64) -> String {
    if by_s > 0.0 {
        format!("no frames for {by_s:.1} s, or a clock step")
    } else {
        format!("clock steps by {by_s:+.3} s")
    }
}

impl From<ReadError> for GapError {
    fn from(error: ReadError) -> Self {
        match error {
            ReadError::Cut { log, line } => Self::Cut { log: log.to_string(), line },
            error => Self::Log(error),
        }
    }
}

impl GapError {
    pub(crate) fn read(path: &Path, source: std::io::Error) -> Self {
        Self::Read { path: path.to_owned(), source }
    }
}
