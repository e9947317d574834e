//! Faults of a log as people are told of them: what befell many messages at once is one line.

use super::{FaultKind, LogFault, frames_of, longest_told};
use crate::Gap;

/// Faults of one log, a line each; lost frames of several messages share one line, and so do repeated
/// ones. It stands where the first of them stood. With `is_thinned`, all lack as many alike.
pub(crate) fn told(faults: &[LogFault], is_thinned: bool) -> Vec<String> {
    let [mut lost, mut repeated] =
        [Tally::of(faults, Mishap::Lost), Tally::of(faults, Mishap::Repeated)];
    let mut lines = Vec::new();
    for fault in faults {
        let tally = match Mishap::of(fault) {
            Some((Mishap::Lost, ..)) => &mut lost,
            Some((Mishap::Repeated, ..)) => &mut repeated,
            None => {
                lines.push(fault.to_string());
                continue;
            }
        };
        lines.extend(tally.take().map(|tally| tally.line(fault, is_thinned)));
    }
    lines
}

/// Faults of one log, each as it is, with whom to suspect of frames that all messages lose alike: who reads one of
/// them alone would lay it to a device.
pub(crate) fn each_told(faults: &[LogFault], is_thinned: bool) -> Vec<String> {
    let lost = Tally::of(faults, Mishap::Lost);
    let suspect = lost.and_then(|tally| tally.suspect(is_thinned)).map_or("", Suspect::why);
    let told = |fault: &LogFault| match Mishap::of(fault) {
        Some((Mishap::Lost, ..)) => format!("{fault}{suspect}"),
        _ => fault.to_string(),
    };
    faults.iter().map(told).collect()
}

/// Messages from which on frames that all lose alike are lost where all pass.
const MANY: usize = 5;
/// Least share of the frames, %, of which that is said.
const MUCH_PERCENT: f64 = 1.0;
/// How many times the mean share a message may lose where all lose alike.
const ALIKE: f64 = 2.0;

/// What befalls all messages of a bus alike.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Mishap {
    Lost,
    Repeated,
}

impl Mishap {
    /// What befell which message: how many of its frames, and of how many.
    fn of(fault: &LogFault) -> Option<(Self, &str, u64, u64)> {
        match &fault.kind {
            FaultKind::Dropped { message, gaps, due, .. } => {
                Some((Self::Lost, message, frames_of(gaps), *due))
            }
            FaultKind::Repeated { message, frames, of } => {
                Some((Self::Repeated, message, *frames, *of))
            }
            _ => None,
        }
    }
}

/// Who lost what all messages lack.
#[derive(Clone, Copy)]
enum Suspect {
    /// All lack as many alike: whether the bus lost them or who wrote the log, no log of the bus can tell.
    Everybody,
    LoggerOrBus,
}

impl Suspect {
    /// Why it is the one, to go on a line with.
    const fn why(self) -> &'static str {
        match self {
            Self::Everybody => {
                "; all messages lack as many alike, whoever sent them, so it was the bus or the logger that lost \
                 them, which this log cannot tell, and commands that are missing count as lost on the bus"
            }
            Self::LoggerOrBus => {
                "; all lose about as many, so suspect the logger or the bus before the machine"
            }
        }
    }

    /// That, and what to do about it.
    fn told(self) -> String {
        let why = self.why();
        format!(
            "{why}. What is held looks late: record again without loss before an unknown cause is believed"
        )
    }
}

/// One mishap over all messages of a log.
struct Tally<'a> {
    mishap: Mishap,
    messages: usize,
    frames: u64,
    of: u64,
    /// The message with the most frames: its name, how many, and of how many.
    worst: (&'a str, u64, u64),
    /// The greatest share of its frames that any message has of it.
    most_share: f64,
    gaps: Vec<&'a Gap>,
}

impl<'a> Tally<'a> {
    /// `None` where no message has it.
    #[allow(clippy::cast_precision_loss)]
    fn of(faults: &'a [LogFault], mishap: Mishap) -> Option<Self> {
        let (worst, most_share, gaps) = (("", 0, 0), 0.0, Vec::new());
        let mut tally = Self { mishap, messages: 0, frames: 0, of: 0, worst, most_share, gaps };
        for fault in faults {
            let Some((found, message, frames, of)) = Mishap::of(fault) else { continue };
            if found != mishap {
                continue;
            }
            tally.messages += 1;
            tally.frames += frames;
            tally.of += of;
            tally.most_share = tally.most_share.max(frames as f64 / of as f64);
            if frames > tally.worst.1 {
                tally.worst = (message, frames, of);
            }
            if let FaultKind::Dropped { gaps, .. } = &fault.kind {
                tally.gaps.extend(gaps);
            }
        }
        (tally.messages > 0).then_some(tally)
    }

    /// Whom to suspect of the loss: no device drops its frames as all others do theirs.
    #[allow(clippy::cast_precision_loss)]
    fn suspect(&self, is_thinned: bool) -> Option<Suspect> {
        if is_thinned {
            return Some(Suspect::Everybody);
        }
        let mean = self.frames as f64 / self.of as f64;
        let alike = self.most_share <= ALIKE * mean;
        let is_shared = self.messages >= MANY && 100.0 * mean >= MUCH_PERCENT && alike;
        is_shared.then_some(Suspect::LoggerOrBus)
    }

    /// What is told in place of `first` and all that are like it.
    #[allow(clippy::cast_precision_loss)]
    fn line(&self, first: &LogFault, is_thinned: bool) -> String {
        if self.messages == 1 {
            return first.to_string();
        }
        let Self { messages, frames, of, worst: (worst, of_worst, worst_of), gaps, .. } = self;
        let percent = 100.0 * *frames as f64 / *of as f64;
        let (some, most) = (
            format!("from here on {frames} of {of} frames ({percent:.1} %) of {messages} messages"),
            format!("the most of {worst} ({of_worst} of {worst_of})"),
        );
        let place = format!("{}:{}", first.log, first.line);
        match self.mishap {
            Mishap::Lost => format!(
                "{place}: {some} are missing, {most}; the longest gap is {}, and the value before is held{}",
                longest_told(gaps.iter().copied()),
                self.suspect(is_thinned).map_or_else(String::new, Suspect::told)
            ),
            Mishap::Repeated => format!(
                "{place}: {some} are there twice, {most}; the repeats are left out, so check how the log was merged"
            ),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fault(line: u64, kind: FaultKind) -> LogFault {
        LogFault { log: "a.log".into(), line, kind }
    }

    fn dropped(message: &str, frames: u64) -> FaultKind {
        let gap = |k: u64| Gap { span_s: [k as f64, k as f64 + 0.02], frames: 1, line: 3 + k };
        let (message, gaps) = (message.to_owned(), (0..frames).map(gap).collect());
        FaultKind::Dropped { message, gaps, due: 100, is_held: true }
    }

    #[test]
    fn what_befell_many_messages_is_one_line_where_the_first_stood() {
        let faults = [
            fault(2, FaultKind::Trailing),
            fault(3, dropped("A", 5)),
            fault(4, dropped("B", 9)),
            fault(5, FaultKind::Repeated { message: "A".to_owned(), frames: 7, of: 70 }),
            fault(6, dropped("C", 4)),
            fault(7, FaultKind::Cut),
        ];
        let lines = told(&faults, false);
        assert_eq!(lines.len(), 4, "{lines:?}");
        assert_eq!((&lines[0], &lines[3]), (&faults[0].to_string(), &faults[5].to_string()));
        let wanted = "a.log:3: from here on 18 of 300 frames (6.0 %) of 3 messages are missing, \
                      the most of B (9 of 100); the longest gap is 20.0 ms";
        assert!(lines[1].starts_with(wanted), "{}", lines[1]);
        assert_eq!(lines[2], faults[3].to_string(), "what befell one message is told as it is");
    }

    #[test]
    fn a_loss_that_all_messages_share_is_not_laid_to_the_machine() {
        let of = |frames: [u64; 6]| {
            let names = ["A", "B", "C", "D", "E", "F"].into_iter().zip(frames);
            let faults: Vec<LogFault> =
                names.map(|(name, frames)| fault(3, dropped(name, frames))).collect();
            told(&faults, false).join("\n")
        };
        assert!(of([5, 4, 6, 5, 5, 7]).contains("suspect the logger or the bus"));
        assert!(!of([1, 1, 2, 1, 1, 60]).contains("suspect"), "one device's own");
        let faults = [fault(3, dropped("A", 5)), fault(4, dropped("B", 5))];
        assert!(
            told(&faults, true)[0].contains("the bus or the logger that lost"),
            "somebody counted them all"
        );
    }

    #[test]
    fn each_message_of_a_loss_that_all_share_has_the_suspect_with_it() {
        let faults =
            [fault(3, dropped("A", 5)), fault(4, dropped("B", 5)), fault(7, FaultKind::Cut)];
        let each = each_told(&faults, true);
        for (line, fault) in each.iter().zip(&faults[..2]) {
            assert!(line.starts_with(&fault.to_string()), "{line}");
            assert!(line.contains("the bus or the logger that lost them"), "{line}");
        }
        assert_eq!(each[2], faults[2].to_string());
        let alone: Vec<String> = faults.iter().map(ToString::to_string).collect();
        assert_eq!(each_told(&faults, false), alone, "two messages do not tell");
    }
}
