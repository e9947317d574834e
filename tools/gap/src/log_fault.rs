//! What is wrong with a log without making it unreadable: frames lost, repeated, cut short, or out of
//! order; readings that froze.

mod told;

use std::fmt;
use std::sync::Arc;

use xt28_bus::candump::Skipped;

use crate::{Gap, Voices};
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
        /// From when to when, each, s from the log's first frame.
        pauses_s: Vec<[f64; 2]>,
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
        /// Each time that the message was away for more than one and a half periods.
        gaps: Vec<Gap>,
        /// Frames that should be there, those that would have filled the gaps included.
        due: u64,
        /// Whether the value before stands in for what is missing; a fix does not.
        is_held: bool,
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
    /// A message has two senders, which say different things; both are taken, as they come.
    TwoVoiced {
        /// Message.
        message: String,
        /// How both show.
        voices: Voices,
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
    /// All bits of frames are one: not available, as J1939 has it. They are left out.
    Unavailable {
        /// Message.
        message: String,
        /// Frames left out.
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
    /// The recorder says that it dropped frames.
    Overrun {
        /// Frames that are not in the log.
        dropped: u64,
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

/// Frames that would have filled `gaps`.
fn frames_of(gaps: &[Gap]) -> u64 {
    gaps.iter().map(|gap| gap.frames).sum()
}

/// What `message` lacks, and what stands in for it.
fn dropped(message: &str, gaps: &[Gap], is_held: bool) -> String {
    let (frames, times) = (frames_of(gaps), gaps.len());
    let s = if times == 1 { "" } else { "s" };
    let longest = longest_told(gaps);
    let meanwhile = if is_held { "the value before is held" } else { "nothing stands in for them" };
    format!(
        "{message} is missing {frames} frames in {times} gap{s} from here on, the longest {longest}; {meanwhile}"
    )
}

/// That it is the longest of so many times, where it is.
fn again(times: u64) -> String {
    if times > 1 { format!(" (the longest of {times} times)") } else { String::new() }
}

/// So many error, remote and CAN FD frames.
fn passed(frames: [u64; 3]) -> String {
    let kinds = frames.into_iter().zip(["error", "remote", "CAN FD"]);
    let there = kinds.filter(|(frames, _)| *frames > 0);
    there.map(|(n, kind)| format!("{n} {kind} frames")).collect::<Vec<_>>().join(", ")
}

/// That so many frames were dropped by who wrote the log.
fn overrun(dropped: u64) -> String {
    let s = if dropped == 1 { "" } else { "s" };
    format!(
        "from here on {dropped} frame{s} came faster than candump took them, and are not in the log; record again on a \
         host with less to do"
    )
}

/// The longest of `gaps`, with when that is.
fn longest_told<'a>(gaps: impl IntoIterator<Item = &'a Gap>) -> String {
    let longest = gaps.into_iter().max_by(|a, b| a.length_s().total_cmp(&b.length_s()));
    longest.map_or_else(String::new, |gap| {
        let [from_s, to_s] = gap.span_s;
        format!("{:.1} ms, from {from_s:.2} to {to_s:.2} s", gap.length_s() * 1e3)
    })
}

impl LogFault {
    /// What of it is in a part of its log, which is this share of the whole; `None` where nothing is. What has no
    /// time is everywhere.
    pub(crate) fn within(&self, [from_s, to_s]: [f64; 2], share: f64) -> Option<Self> {
        let is_in = |[begins_s, ends_s]: [f64; 2]| begins_s < to_s && ends_s > from_s;
        match &self.kind {
            FaultKind::Dropped { message, gaps, due, is_held } => {
                let gaps = gaps.iter().filter_map(|gap| gap.within([from_s, to_s]));
                let gaps: Vec<Gap> = gaps.collect();
                let line = gaps.first()?.line;
                // It comes as often all along.
                #[allow(
                    clippy::cast_possible_truncation,
                    clippy::cast_sign_loss,
                    clippy::cast_precision_loss
                )]
                let due = (share * *due as f64).round() as u64;
                let (due, message) = (due.max(frames_of(&gaps)), message.clone());
                let kind = FaultKind::Dropped { message, gaps, due, is_held: *is_held };
                Some(Self { line, kind, ..self.clone() })
            }
            FaultKind::ClockAhead { pauses_s, .. } => {
                pauses_s.iter().any(|pause_s| is_in(*pause_s)).then(|| self.clone())
            }
            FaultKind::Frozen { from_s: stands_s, to_s: until_s, .. } => {
                is_in([*stands_s, *until_s]).then(|| self.clone())
            }
            _ => Some(self.clone()),
        }
    }
}

impl FaultKind {
    pub(crate) const fn passed_over(skipped: Skipped) -> Self {
        let Skipped { remote, error, fd, .. } = skipped;
        Self::PassedOver { remote, error, fd }
    }

    /// Whether it leaves out frames of `message` or values of `channel`.
    pub(crate) fn leaves_out(&self, message: &str, channel: &str) -> bool {
        match self {
            Self::WrongLength { message: of, .. }
            | Self::BadCrc { message: of, .. }
            | Self::Unavailable { message: of, .. } => of == message,
            Self::Unbelievable { channel: of, .. } => of == channel,
            _ => false,
        }
    }

    /// Whether it leaves out frames of which nobody knows what they were.
    pub(crate) const fn leaves_out_any(&self) -> bool {
        matches!(
            self,
            Self::Cut
                | Self::Broken { .. }
                | Self::PassedOver { .. }
                | Self::Overrun { .. }
                | Self::ClockBack { .. }
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
            FaultKind::ClockAhead { by_s, times, .. } => write!(
                f,
                "no frame of any kind for {by_s:.3} s before this line, {times} times so in this log; the values before are held, so cut the log there if the clock jumped"
            ),
            FaultKind::Broken { problem, messages } => {
                write!(f, "no CAN frame: {problem}; {messages} such messages are left out")
            }
            FaultKind::Dropped { message, gaps, is_held, .. } => {
                write!(f, "{}", dropped(message, gaps, *is_held))
            }
            FaultKind::Repeated { message, frames, of } => write!(
                f,
                "{message} is there twice from here on: {frames} of its {of} frames repeat the one before, long before the next is due; the repeats are left out, so check how the log was merged"
            ),
            FaultKind::TwoVoiced { message, voices } => write!(f, "{message} {voices}"),
            FaultKind::WrongLength { message, found, wanted, frames } => write!(
                f,
                "{message} has {found} bytes where the DBC says {wanted}; {frames} such frames are left out, so check that log and DBC belong together"
            ),
            FaultKind::Unavailable { message, frames } => write!(
                f,
                "{message} says of all its signals that they are not available, in {frames} frames from here on; they are left out"
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
                write!(
                    f,
                    "from here on {}; nothing is read from them",
                    passed([*error, *remote, *fd])
                )
            }
            FaultKind::Overrun { dropped } => f.write_str(&overrun(*dropped)),
            FaultKind::Frozen { channel, value, unit, from_s, to_s, meanwhile, times } => write!(
                f,
                "reading {channel} stood still at {value:.3} {unit} from {from_s:.1} s to {to_s:.1} s{} while {meanwhile}; it is taken as it is, so cut the log there if the sensor froze",
                again(*times)
            ),
            FaultKind::Unbelievable { channel, problem, values } => write!(
                f,
                "{channel} cannot be believed: {problem}; {values} such values are left out, so check the signal's range in the DBC"
            ),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_the_recorder_dropped_is_told_with_what_was_passed_over() {
        let told = |kind: FaultKind| {
            assert!(kind.leaves_out_any());
            LogFault { log: "a.log".into(), line: 7, kind }.to_string()
        };
        let dropped = told(FaultKind::Overrun { dropped: 3 });
        let wanted = "a.log:7: from here on 3 frames came faster than candump took them, and are not in the log";
        assert!(dropped.starts_with(wanted), "{dropped}");
        let error = told(FaultKind::passed_over(Skipped { error: 2, ..Skipped::default() }));
        assert_eq!(error, "a.log:7: from here on 2 error frames; nothing is read from them");
    }
}
