//! Every frame of our database held to it: length, ranges, names of values, CRC and alive counter, whether or not
//! anything is read from it.

use std::collections::BTreeMap;
use std::sync::LazyLock;

use xt28_dbc::model::{CodecError, Message, Signal};
use xt28_dbc::{Frame, e2e};

/// What is wrong with a frame.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub(crate) enum FrameProblem {
    #[error(transparent)]
    Codec(#[from] CodecError),
    #[error("{message}.{signal}: {raw} has no meaning")]
    Meaning { message: &'static str, signal: &'static str, raw: u64 },
    #[error("{message}: crc {got:02X} instead of {want:02X}")]
    Crc { message: &'static str, want: u8, got: u8 },
    #[error("{message}: alive counter {counter} after {before}, {after_ms:.1} ms later")]
    Alive { message: &'static str, counter: u64, before: u64, after_ms: f64 },
}

/// A message, with what of it can be wrong.
struct Held {
    message: Message,
    /// Indices of the signals that may not have every value that their bits can hold.
    narrow: Vec<usize>,
    /// Indices of the signals of which only some values have a meaning.
    named: Vec<usize>,
}

static MESSAGES: LazyLock<BTreeMap<u32, Held>> = LazyLock::new(|| {
    let held = xt28_dbc::database().messages().iter().cloned().map(Held::new).collect::<Vec<_>>();
    held.into_iter().map(|held| (held.message.id, held)).collect()
});

impl Held {
    fn new(message: Message) -> Self {
        let which = |is: fn(&Signal) -> bool| {
            let signals = message.signals.iter().enumerate();
            signals.filter(|(_, signal)| is(signal)).map(|(index, _)| index).collect()
        };
        let narrow = which(|signal| {
            let (least, greatest) = signal.field.physical_range();
            !(signal.field.min <= least && greatest <= signal.field.max)
        });
        let named = which(|signal| !signal.values.is_empty());
        Self { message, narrow, named }
    }

    fn signals<'a>(&'a self, which: &'a [usize]) -> impl Iterator<Item = &'a Signal> {
        which.iter().map(|&index| &self.message.signals[index])
    }

    /// What is wrong with the bytes, whatever was before them.
    fn check(&'static self, data: &[u8]) -> Result<(), FrameProblem> {
        let message = &self.message;
        let name = message.name.as_str();
        let is_of_length = data.len() == usize::from(message.len);
        if message.is_protected() && is_of_length {
            let (payload, crc) = data.split_at(data.len() - 1);
            let (want, got) = (e2e::crc(message.data_id, payload), crc[0]);
            if want != got {
                return Err(FrameProblem::Crc { message: name, want, got });
            }
        }
        let is_narrow_sound = |signal: &Signal| signal.field.read(data).is_ok();
        if !is_of_length || !self.signals(&self.narrow).all(is_narrow_sound) {
            // Most frames are sound; only this one need be read in full.
            message.decode(data)?;
        }
        let meaningless = self.signals(&self.named).find_map(|signal| {
            let raw = signal.field.raw(data);
            let is_named = signal.values.iter().any(|(value, _)| u64::try_from(*value) == Ok(raw));
            (!is_named).then_some((signal.name.as_str(), raw))
        });
        match meaningless {
            Some((signal, raw)) => Err(FrameProblem::Meaning { message: name, signal, raw }),
            None => Ok(()),
        }
    }
}

/// A counter that was on the bus, and how the row that it is of keeps its time.
#[derive(Clone, Copy, Debug)]
struct Counted {
    at_s: f64,
    counter: u64,
    /// Steps since the row began.
    steps: u64,
    /// When the row began by the frame of it that came earliest for its step, s.
    begun_s: f64,
}

impl Counted {
    const fn first(at_s: f64, counter: u64) -> Self {
        Self { at_s, counter, steps: 0, begun_s: at_s }
    }
}

/// Checks frames in bus order.
#[derive(Clone, Debug, Default)]
pub(crate) struct FrameCheck {
    /// By message.
    alive: BTreeMap<u32, Counted>,
}

/// Counters go round in so many steps.
const ROUND: u64 = 16;
/// After so many periods of silence a sender may have begun anew.
const SILENCE_PERIODS: f64 = 7.0;
/// A step comes no more periods before its time by the earliest so far. One that goes back seems to come most of a
/// round too early.
const EARLY_PERIODS: f64 = 1.5;

impl FrameCheck {
    /// Takes in a frame that ended at `at_s`; one that is not of our database is never wrong.
    ///
    /// # Errors
    /// What is wrong with it.
    pub(crate) fn push(&mut self, at_s: f64, frame: &Frame) -> Result<(), FrameProblem> {
        let Some(held) = MESSAGES.get(&frame.id().dbc()) else { return Ok(()) };
        held.check(frame.data())?;
        self.count(at_s, &held.message, frame.data())
    }

    /// A counter goes one up with each frame. Frames may be missing from a log and others come late, several at once, so
    /// that it may go up by more, but none is ahead of its row's time; and a sender that fell silent may have begun anew.
    fn count(
        &mut self,
        at_s: f64,
        message: &'static Message,
        data: &[u8],
    ) -> Result<(), FrameProblem> {
        let Some(signal) = message.signal("Counter").filter(|_| message.alive) else {
            return Ok(());
        };
        let counter = signal.field.raw(data);
        let anew = Counted::first(at_s, counter);
        let Some(before) = self.alive.insert(message.id, anew) else { return Ok(()) };
        let period_s = f64::from(message.period_ms) * 1e-3;
        let after_s = at_s - before.at_s;
        if after_s > SILENCE_PERIODS * period_s {
            return Ok(());
        }
        let step = (counter + ROUND - before.counter) % ROUND;
        let steps = before.steps + step;
        #[allow(clippy::cast_precision_loss)] // a run has some thousands
        let begun_s = at_s - steps as f64 * period_s;
        if step > 0 && begun_s > before.begun_s - EARLY_PERIODS * period_s {
            let begun_s = begun_s.min(before.begun_s);
            self.alive.insert(message.id, Counted { at_s, counter, steps, begun_s });
            return Ok(());
        }
        let (message, before, after_ms) = (message.name.as_str(), before.counter, after_s * 1e3);
        Err(FrameProblem::Alive { message, counter, before, after_ms })
    }
}
