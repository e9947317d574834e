//! CAN frames out of an MCAP file, as ROS records them: channels of `can_msgs` frames, which
//! `ros2_socketcan` and the like publish on `/from_can_bus`.
//!
//! ROS 2 writes them as CDR, ROS 1 as packed bytes; both are read. Of several such channels all are,
//! as a candump of several interfaces is.

mod frame;

use std::collections::BTreeSet;
use std::io::{ErrorKind, Read};
use std::sync::Arc;

use mcap::io::MessageReader;
use mcap::sans_io::LinearReaderOptions;
use mcap::{Channel as Topic, McapError};
use xt28_bus::candump::{Record, Skipped};

use crate::{FaultKind, GapError};
use frame::{Encoding, Seen};

/// First bytes of an MCAP file (its specification); no candump line begins so.
pub(crate) const MAGIC: &[u8] = b"\x89MCAP0\r\n";

/// Longest chunk or record that is read: a damaged length must not take all memory. Recorders end a
/// chunk after a few MiB.
const RECORD_MAX_BYTES: usize = 256 << 20;

/// What an MCAP file held beside its frames.
#[derive(Debug, Default, PartialEq)]
pub(crate) struct Remains {
    /// Message, from 1, at which the file is cut.
    pub(crate) cut: Option<u64>,
    /// First message that is no frame, what is wrong with it, and how many there are.
    pub(crate) broken: Option<(u64, String, u64)>,
    /// First message that is a frame of a kind that is not read.
    pub(crate) skipped_at: Option<u64>,
    /// How many of those there are.
    pub(crate) skipped: Skipped,
}

impl Remains {
    /// The same as faults of a log.
    pub(crate) fn faults(self) -> Vec<(u64, FaultKind)> {
        let cut = self.cut.map(|number| (number, FaultKind::Cut));
        let broken = self
            .broken
            .map(|(number, problem, messages)| (number, FaultKind::Broken { problem, messages }));
        let skipped = self.skipped_at.map(|number| (number, FaultKind::passed_over(self.skipped)));
        [cut, broken, skipped].into_iter().flatten().collect()
    }
}

/// Hands every frame in `input` to `take`, with the number of its message in the file, from 1. `log`
/// is the file's name in errors. With `accept_cut`, a file that ends too early is taken as it is.
///
/// # Errors
/// [`GapError::Recording`].
pub(crate) fn read(
    input: impl Read,
    log: &str,
    accept_cut: bool,
    mut take: impl FnMut(&Record, u64),
) -> Result<Remains, GapError> {
    let refuse = |message: u64, problem: String| GapError::Recording {
        log: log.to_owned(),
        message,
        problem: problem.replace('\n', " "),
    };
    let options = LinearReaderOptions::default()
        .with_prevalidate_chunk_crcs(true)
        .with_record_length_limit(RECORD_MAX_BYTES);
    let stream = MessageReader::new_with_options(input, options);
    let (mut remains, mut number, mut frames) = (Remains::default(), 0, 0_u64);
    let mut others: BTreeSet<String> = BTreeSet::new();
    for message in stream {
        number += 1;
        let message = match message {
            Ok(message) => message,
            Err(error) if is_cut(&error) && accept_cut => {
                remains.cut = Some(number);
                break;
            }
            Err(error) if is_cut(&error) => {
                let problem =
                    "the file ends here, before its end; say --accept-cut to take what is there";
                return Err(refuse(number, problem.to_owned()));
            }
            Err(error) => return Err(refuse(number, format!("{error}; copy the file again"))),
        };
        let Some(encoding) = encoding(&message.channel) else {
            if is_fd(&message.channel) {
                remains.skipped.fd += 1;
                remains.skipped_at.get_or_insert(number);
            }
            others.insert(name(&message.channel));
            continue;
        };
        match frame::decode(&message.data, encoding, message.log_time) {
            Ok(Seen::Data(at, frame)) => {
                frames += 1;
                let interface = message.channel.topic.as_str().into();
                take(&Record { at, interface, frame, direction: None }, number);
            }
            Ok(kind @ (Seen::Remote | Seen::Error)) => {
                frames += 1;
                let skipped = &mut remains.skipped;
                *(if kind == Seen::Error { &mut skipped.error } else { &mut skipped.remote }) += 1;
                remains.skipped_at.get_or_insert(number);
            }
            Err(problem) => remains.broken.get_or_insert((number, problem, 0)).2 += 1,
        }
    }
    if frames == 0 && remains.broken.is_none() {
        let others: Vec<String> = others.into_iter().collect();
        let has = if others.is_empty() { "no message".to_owned() } else { others.join(", ") };
        return Err(refuse(number, format!("no message of type can_msgs/msg/Frame; it has {has}")));
    }
    Ok(remains)
}

/// Whether the input ends too early, as its own reader or a decompressor below says it.
fn is_cut(error: &McapError) -> bool {
    match error {
        McapError::UnexpectedEof => true,
        McapError::Io(error) => error.kind() == ErrorKind::UnexpectedEof,
        _ => false,
    }
}

/// Whether a channel has CAN FD frames, which are of a type of their own.
fn is_fd(topic: &Arc<Topic<'_>>) -> bool {
    topic.schema.as_ref().is_some_and(|schema| schema.name == "ros2_socketcan_msgs/msg/FdFrame")
}

/// How a channel writes CAN frames; `None` where it is none of those.
fn encoding(topic: &Arc<Topic<'_>>) -> Option<Encoding> {
    let schema = topic.schema.as_ref()?.name.as_str();
    match (topic.message_encoding.as_str(), schema) {
        ("cdr", "can_msgs/msg/Frame") => Some(Encoding::Cdr),
        ("ros1", "can_msgs/Frame") => Some(Encoding::Packed),
        _ => None,
    }
}

fn name(topic: &Arc<Topic<'_>>) -> String {
    let schema = topic.schema.as_ref().map_or("no type", |schema| schema.name.as_str());
    format!("{} ({schema}, {})", topic.topic, topic.message_encoding)
}
