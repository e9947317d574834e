//! Messages that say one thing on one interface and another on the next: two machines in one log.

use std::collections::BTreeMap;
use std::sync::Arc;

use xt28_bus::candump::Record;
use xt28_dbc::{CanId, Frame};

/// So many frames of a message on a second interface are no stray.
const FRAMES_MIN: u64 = 50;
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

    /// The first message, of those that are `known`, that two machines send.
    #[allow(clippy::cast_precision_loss)] // frames of a log
    pub(super) fn two_machines(&self, known: impl Fn(CanId) -> bool) -> Option<TwoMachines> {
        self.0.iter().filter(|(id, _)| known(**id)).find_map(|(id, heard)| {
            let other = heard.other.as_ref().filter(|other| other.frames >= FRAMES_MIN)?;
            let is_strange = other.strange as f64 > STRANGE_MAX * other.frames as f64;
            let interfaces = [Arc::clone(&heard.name), Arc::clone(&other.name)];
            is_strange.then_some(TwoMachines { id: *id, interfaces, line: other.line })
        })
    }
}

#[cfg(test)]
mod tests {
    use xt28_machine::SimTime;

    use super::*;

    /// A message of a hundred frames on two interfaces, of which each so manieth differs on the second.
    fn heard(differs: usize) -> Option<TwoMachines> {
        let mut interfaces = Interfaces::default();
        for i in 0..100_usize {
            let frame = |byte: usize| Frame::new(CanId::Standard(1), &[byte as u8]).unwrap();
            let own = frame(i);
            let other = if i % differs == 0 { frame(i + 1) } else { own };
            for (name, frame, line) in [("can0", own, 2 * i), ("can1", other, 2 * i + 1)] {
                let (at, interface) = (SimTime::from_millis(i as u64), name.into());
                let record = Record { at, interface, frame, direction: None };
                interfaces.note(&record, line as u64);
            }
        }
        interfaces.two_machines(|_| true)
    }

    #[test]
    fn a_bridge_is_one_machine_and_two_that_differ_are_two() {
        assert_eq!(heard(10), None);
        let found = heard(2).unwrap();
        assert_eq!((found.id, found.line), (CanId::Standard(1), 1));
        assert_eq!(found.interfaces.map(|name| name.to_string()), ["can0", "can1"]);
    }
}
