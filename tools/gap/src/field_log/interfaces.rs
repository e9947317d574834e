//! Messages that say one thing on one interface and another on the next: two machines in one log.

use std::collections::BTreeMap;
use std::sync::Arc;

use xt28_bus::candump::Record;
use xt28_dbc::{CanId, Frame};

/// So many frames of a message on a second interface are no stray.
const FRAMES_MIN: u64 = 50;
/// So many messages are more than an ECU copies from one of its buses to another, perhaps from another tick.
const MESSAGES_MIN: usize = 3;
/// Share of them that says what the first interface did not: a bridge hands on what it hears, some of it late.
const STRANGE_MAX: f64 = 0.2;

/// Where each message was heard.
#[derive(Default)]
pub(super) struct Interfaces(BTreeMap<CanId, Heard>);

struct Heard {
    name: Arc<str>,
    /// What it said there last.
    last: Frame,
    other: Option<Other>,
}

struct Other {
    name: Arc<str>,
    line: u64,
    frames: u64,
    /// Those that are not the last of the first interface.
    strange: u64,
}

/// A message that comes from two machines.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct TwoMachines {
    pub(super) id: CanId,
    pub(super) interfaces: [Arc<str>; 2],
    /// The first line of the second.
    pub(super) line: u64,
}

impl Interfaces {
    pub(super) fn note(&mut self, record: &Record, line: u64) {
        let frame = record.frame;
        let new = || Heard { name: Arc::clone(&record.interface), last: frame, other: None };
        let heard = self.0.entry(frame.id()).or_insert_with(new);
        if heard.name == record.interface {
            heard.last = frame;
            return;
        }
        let name = || Arc::clone(&record.interface);
        let new = || Other { name: name(), line, frames: 0, strange: 0 };
        let other = heard.other.get_or_insert_with(new);
        other.frames += 1;
        other.strange += u64::from(frame.data() != heard.last.data());
    }

    /// The message, of those that are `known` and that two machines send, that the second sends first.
    #[allow(clippy::cast_precision_loss)] // frames of a log
    pub(super) fn two_machines(&self, known: impl Fn(CanId) -> bool) -> Option<TwoMachines> {
        let twice = |(id, heard): (&CanId, &Heard)| {
            let other = heard.other.as_ref().filter(|other| other.frames >= FRAMES_MIN)?;
            let is_strange = other.strange as f64 > STRANGE_MAX * other.frames as f64;
            let interfaces = [Arc::clone(&heard.name), Arc::clone(&other.name)];
            is_strange.then_some(TwoMachines { id: *id, interfaces, line: other.line })
        };
        let twice: Vec<_> = self.0.iter().filter(|(id, _)| known(**id)).filter_map(twice).collect();
        let is_second = twice.len() >= MESSAGES_MIN;
        twice.into_iter().min_by_key(|two| two.line).filter(|_| is_second)
    }
}

#[cfg(test)]
mod tests {
    use xt28_machine::SimTime;

    use super::*;

    /// So many messages of a hundred frames on two interfaces, of which each so manieth differs on the second.
    fn heard(messages: u16, differs: usize) -> Option<TwoMachines> {
        let mut interfaces = Interfaces::default();
        let mut line = 0;
        for (i, message) in (0..100_usize).flat_map(|i| (0..messages).map(move |id| (i, id))) {
            let frame = |byte: usize| Frame::new(CanId::Standard(message), &[byte as u8]).unwrap();
            let own = frame(i);
            let other = if i % differs == 0 { frame(i + 1) } else { own };
            for (name, frame) in [("can0", own), ("can1", other)] {
                line += 1;
                let (at, interface) = (SimTime::from_millis(i as u64), name.into());
                let record = Record { at, interface, frame, direction: None };
                interfaces.note(&record, line);
            }
        }
        interfaces.two_machines(|_| true)
    }

    #[test]
    fn a_bridge_is_one_machine_and_two_that_differ_are_two() {
        assert_eq!(heard(5, 10), None);
        assert_eq!(heard(2, 2), None, "an ECU may copy some");
        let found = heard(5, 2).unwrap();
        assert_eq!((found.id, found.line), (CanId::Standard(0), 2));
        assert_eq!(found.interfaces.map(|name| name.to_string()), ["can0", "can1"]);
    }
}
