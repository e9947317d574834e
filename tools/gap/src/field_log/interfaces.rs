//! Messages that say one thing on one interface and another on the next: two machines in one log.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::Duration;

use xt28_bus::candump::Record;
use xt28_dbc::{CanId, Frame};
use xt28_machine::SimTime;

/// So many frames of a message on either interface, while the other speaks too, are no strays.
const FRAMES_MIN: u64 = 50;
/// So many messages are more than an ECU copies from one of its buses to another, perhaps from another tick.
pub(super) const MESSAGES_MIN: usize = 3;
/// Share of a message's frames that the other interface did not say, either way round: a bridge hands on what it
/// hears, some of it late, but one of the two then says what the other said.
const STRANGE_MAX: f64 = 0.2;
/// Frames that an interface said last, among which one of the other is looked for: 0.16 s of a fast message.
const RECENT: usize = 16;
/// So long after its last frame an interface speaks no more.
const SPEAKS: Duration = Duration::from_millis(200);

/// Where each message was heard.
#[derive(Default)]
pub(super) struct Interfaces(BTreeMap<CanId, [Option<Side>; 2]>);

/// A message on one interface.
struct Side {
    name: Arc<str>,
    first_line: u64,
    last_at: SimTime,
    recent: [Option<Frame>; RECENT],
    count: usize,
    /// Frames while the other interface spoke too, and those that it had not said.
    frames: u64,
    strange: u64,
}

/// A message that says another thing on one interface than on the other.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct TwoVoiced {
    pub(super) id: CanId,
    pub(super) interfaces: [Arc<str>; 2],
    /// The first line of the second.
    pub(super) line: u64,
}

impl Side {
    fn new(record: &Record, line: u64) -> Self {
        Self {
            name: Arc::clone(&record.interface),
            first_line: line,
            last_at: record.at,
            recent: [None; RECENT],
            count: 0,
            frames: 0,
            strange: 0,
        }
    }

    fn said(&self, frame: &Frame) -> bool {
        self.recent.iter().flatten().any(|one| one.data() == frame.data())
    }

    fn speaks_at(&self, at: SimTime) -> bool {
        // Written late, a frame may be older than the other's last.
        at.as_nanos() <= self.last_at.as_nanos().saturating_add(SPEAKS.as_nanos() as u64)
    }

    #[allow(clippy::cast_precision_loss)] // frames of a log
    fn says_its_own(&self) -> bool {
        self.frames >= FRAMES_MIN && self.strange as f64 > STRANGE_MAX * self.frames as f64
    }
}

impl Interfaces {
    pub(super) fn note(&mut self, record: &Record, line: u64) {
        let sides = self.0.entry(record.frame.id()).or_default();
        let is_own =
            |side: &Option<Side>| side.as_ref().is_none_or(|side| side.name == record.interface);
        // Of a third interface nothing is asked.
        let Some(own) = sides.iter().position(is_own) else { return };
        let other = sides[1 - own].as_ref().filter(|other| other.speaks_at(record.at));
        let strange = other.map(|other| !other.said(&record.frame));
        let side = sides[own].get_or_insert_with(|| Side::new(record, line));
        side.frames += u64::from(strange.is_some());
        side.strange += u64::from(strange == Some(true));
        side.recent[side.count % RECENT] = Some(record.frame);
        (side.count, side.last_at) = (side.count + 1, record.at);
    }

    /// The messages, of those that are `known`, that say another thing on one interface than on the other, in the
    /// order in which the second interface has them: are they [`MESSAGES_MIN`], those of two machines.
    pub(super) fn two_voiced(&self, known: impl Fn(CanId) -> bool) -> Vec<TwoVoiced> {
        let twice = |(id, sides): (&CanId, &[Option<Side>; 2])| {
            let [Some(one), Some(other)] = sides else { return None };
            let interfaces = [&one.name, &other.name].map(Arc::clone);
            let two = TwoVoiced { id: *id, interfaces, line: other.first_line };
            (one.says_its_own() && other.says_its_own()).then_some(two)
        };
        let mut twice: Vec<_> =
            self.0.iter().filter(|(id, _)| known(**id)).filter_map(twice).collect();
        twice.sort_by_key(|two| two.line);
        twice
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is found of so many messages, of which `said(i, interface)` is what comes on an interface at `i` times 10 ms;
    /// nothing where there is none.
    fn found(messages: u16, said: impl Fn(usize, usize) -> Option<usize>) -> Vec<TwoVoiced> {
        let mut interfaces = Interfaces::default();
        let mut line = 0;
        for i in 0..300 {
            for message in 0..messages {
                for (k, name) in ["can0", "can1"].into_iter().enumerate() {
                    let Some(word) = said(i, k) else { continue };
                    line += 1;
                    let data = u32::try_from(word).unwrap().to_le_bytes();
                    let frame = Frame::new(CanId::Standard(message), &data).unwrap();
                    let (at, interface) = (SimTime::from_millis(10 * i as u64), name.into());
                    interfaces.note(&Record { at, interface, frame, direction: None }, line);
                }
            }
        }
        interfaces.two_voiced(|_| true)
    }

    #[test]
    fn two_that_differ_are_two_machines() {
        let all = found(5, |i, k| Some(2 * i + k));
        assert_eq!(all.iter().map(|two| two.line).collect::<Vec<_>>(), [2, 4, 6, 8, 10]);
        let two = &all[0];
        assert_eq!(two.id, CanId::Standard(0));
        assert_eq!(two.interfaces.each_ref().map(|name| name.to_string()), ["can0", "can1"]);
        assert!(found(2, |i, k| Some(2 * i + k)).len() < MESSAGES_MIN, "an ECU may copy some");
    }

    #[test]
    fn one_that_is_heard_twice_is_one() {
        // Handed on at once, late, or before, where the log begins between the two.
        for late in [0, 1, 12] {
            assert_eq!(found(5, |i, k| i.checked_sub(late * k)), []);
            assert_eq!(found(5, |i, k| i.checked_sub(late * (1 - k))), []);
        }
        // Strays of another, and one interface after the other.
        assert_eq!(found(5, |i, k| (k == 0 || i == 7).then_some(2 * i + k)), []);
        assert_eq!(found(5, |i, k| ((i < 150) == (k == 0)).then_some(2 * i + k)), []);
    }
}
