//! What is wrong with a log without making it unreadable: frames lost, repeated, cut short, or out of
//! order; readings that froze.

mod told;

use std::fmt;
use std::sync::Arc;

use xt28_bus::candump::Skipped;

pub(crate) use told::{each_told, told};

/// Something a reader of the result must know of its log. Displays as one line with file and line.
#[derive(Clone, Debug, PartialEq)]
pub struct LogFault {
    /// The log's name.
    pub log: Arc<str>,
    /// Line of the first occurrence, from 1; of an MCAP file, which has none, the message.
    pub line: u64,
    /// What it is.
    pub kind: FaultKind,
}

/// Kinds of [`LogFault`].
#[derive(Clone, Debug, PartialEq)]
pub enum FaultKind {
    /// The log ends in the middle of its last line, which is left out.
    Cut,
    /// Bytes follow a gzip stream that are none.
    Trailing,
    /// Frames come later than merged sources do, but soon enough to be put in order.
    OutOfOrder {
        /// The largest step back, s.
        by_s: f64,
        /// Frames put in order.
        frames: u64,
    },
    /// Times go back; the frames up to the time before are left out.
    ClockBack {
        /// The largest step back, s.
        by_s: f64,
        /// Frames left out.
        frames: u64,
    },
    /// Times go ahead by more than any message is ever away: the logger paused, or its clock jumped.
    ClockAhead {
        /// The longest time without any frame, s.
        by_s: f64,
        /// How often.
        times: u64,
    },
    /// Messages of a recording are no CAN frames, though of their type; they are left out.
    Broken {
        /// What is wrong with the first.
        problem: String,
        /// Messages left out.
        messages: u64,
    },
    /// Frames of a cyclic message are not there.
    Dropped {
        /// Message.
        message: String,
        /// Times the message was away for more than one and a half periods.
        gaps: u64,
        /// Periods without a frame, over all gaps.
        frames: u64,
        /// Frames that should be there, those included.
        due: u64,
        /// The longest time without, s.
        longest_s: f64,
    },
    /// Frames of a cyclic message are there more than once; the repeats are left out.
    Repeated {
        /// Message.
        message: String,
        /// Frames left out.
        frames: u64,
        /// Frames in the log, those included.
        of: u64,
    },
    /// Frames have fewer bytes than the DBC says; they are left out.
    WrongLength {
        /// Message.
        message: String,
        /// Bytes in the first such frame.
        found: usize,
        /// Bytes in the DBC.
        wanted: usize,
        /// Frames left out.
        frames: u64,
    },
    /// Frames have more bytes than the DBC says; those are taken for padding.
    Padded {
        /// Message.
        message: String,
        /// Bytes in the first such frame.
        found: usize,
        /// Bytes in the DBC.
        wanted: usize,
        /// Such frames.
        frames: u64,
    },
    /// The CRC of frames is not that of their data; they are left out.
    BadCrc {
        /// Message.
        message: String,
        /// When the first came, s from the log's first frame.
        at_s: f64,
        /// Frames left out.
        frames: u64,
    },
    /// Frames of other kinds than classic data frames, of which nothing is read.
    PassedOver {
        /// Remote frames.
        remote: u64,
        /// Error frames: the bus was disturbed.
        error: u64,
        /// CAN FD frames.
        fd: u64,
    },
    /// A reading stood perfectly still while its part moved.
    Frozen {
        /// Channel.
        channel: String,
        /// What it read, in `unit`.
        value: f64,
        /// Its SI unit.
        unit: &'static str,
        /// When it stopped, s from the log's first frame.
        from_s: f64,
        /// When it last read so.
        to_s: f64,
        /// What says that its part moved.
        meanwhile: String,
        /// How often it stood so; this is the longest.
        times: u64,
    },
    /// A value is not a number, or is outside the range that the DBC gives; it is left out.
    Unbelievable {
        /// Channel.
        channel: String,
        /// What is wrong with the first.
        problem: String,
        /// Values left out.
        values: u64,
    },
}

impl FaultKind {
    pub(crate) const fn passed_over(skipped: Skipped) -> Self {
        Self::PassedOver { remote: skipped.remote, error: skipped.error, fd: skipped.fd }
    }

    /// Whether it leaves out frames of `message` or values of `channel`.
    pub(crate) fn leaves_out(&self, message: &str, channel: &str) -> bool {
        match self {
            Self::WrongLength { message: of, .. } | Self::BadCrc { message: of, .. } => {
                of == message
            }
            Self::Unbelievable { channel: of, .. } => of == channel,
            _ => false,
        }
    }

    /// Whether it leaves out frames of which nobody knows what they were.
    pub(crate) const fn leaves_out_any(&self) -> bool {
        matches!(
            self,
            Self::Cut | Self::Broken { .. } | Self::PassedOver { .. } | Self::ClockBack { .. }
        )
    }
}

impl fmt::Display for LogFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}: ", self.log, self.line)?;
        match &self.kind {
            FaultKind::Cut => write!(f, "log is cut here; what is not whole is left out"),
            FaultKind::Trailing => write!(
                f,
                "behind the gzip stream that ends here the file goes on with something else, which is left out"
            ),
            FaultKind::OutOfOrder { by_s, frames } => write!(
                f,
                "times go back by up to {:.1} ms; {frames} frames are put in order, so cut the log there if the clock was set",
                by_s * 1e3
            ),
            FaultKind::ClockBack { by_s, frames } => write!(
                f,
                "clock jumps back by {by_s:.6} s; {frames} frames are left out until it has caught up, so cut the log there if they matter"
            ),
            FaultKind::ClockAhead { by_s, times } => write!(
                f,
                "no frame of any kind for {by_s:.3} s before this line, {times} times so in this log; the values before are held, so cut the log there if the clock jumped"
            ),
            FaultKind::Broken { problem, messages } => {
                write!(f, "no CAN frame: {problem}; {messages} such messages are left out")
            }
            FaultKind::Dropped { message, gaps, frames, longest_s, .. } => write!(
                f,
                "{message} is missing {frames} frames in {gaps} gap{} from here on, the longest {:.1} ms; the value before is held",
                if *gaps == 1 { "" } else { "s" },
                longest_s * 1e3
            ),
            FaultKind::Repeated { message, frames, of } => write!(
                f,
                "{message} is there twice from here on: {frames} of its {of} frames repeat the one before, long before the next is due; the repeats are left out, so check how the log was merged"
            ),
            FaultKind::WrongLength { message, found, wanted, frames } => write!(
                f,
                "{message} has {found} bytes where the DBC says {wanted}; {frames} such frames are left out, so check that log and DBC belong together"
            ),
            FaultKind::Padded { message, found, wanted, frames } => write!(
                f,
                "{message} has {found} bytes where the DBC says {wanted}; in {frames} such frames the rest is taken for padding, so check that the DBC is of this version"
            ),
            FaultKind::BadCrc { message, at_s, frames } => write!(
                f,
                "{message} has a wrong CRC, first at {at_s:.3} s; {frames} such frames are left out, so check E2eDataId in the DBC if those are all"
            ),
            FaultKind::PassedOver { remote, error, fd } => {
                let kinds = [(error, "error"), (remote, "remote"), (fd, "CAN FD")];
                let there = kinds.iter().filter(|(frames, _)| **frames > 0);
                let each: Vec<String> =
                    there.map(|(n, kind)| format!("{n} {kind} frames")).collect();
                write!(f, "from here on {}; nothing is read from them", each.join(", "))
            }
            FaultKind::Frozen { channel, value, unit, from_s, to_s, meanwhile, times } => {
                let again = if *times > 1 {
                    format!(" (the longest of {times} times)")
                } else {
                    String::new()
                };
                write!(
                    f,
                    "reading {channel} stood still at {value:.3} {unit} from {from_s:.1} s to {to_s:.1} s{again} while {meanwhile}; it is taken as it is, so cut the log there if the sensor froze"
                )
            }
            FaultKind::Unbelievable { channel, problem, values } => write!(
                f,
                "{channel} cannot be believed: {problem}; {values} such values are left out, so check the signal's range in the DBC"
            ),
        }
    }
}
