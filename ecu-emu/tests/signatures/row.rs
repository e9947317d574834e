//! A row of the table: an effect in force, what it must show, what must stay.

use std::path::Path;

use xt28_dbc::CanId;
use xt28_machine::Machine;
use xt28_sim::Effects;
use xt28_sim::effects::Overlay;
use xt28_ubx::Message;

use crate::recording::{Recording, tick_at};

/// A number seen, and what the law has it be.
#[derive(Clone)]
pub(crate) struct Size {
    what: String,
    is: f64,
    wanted: f64,
    within: f64,
}

impl Size {
    pub(crate) fn new(what: impl ToString, is: f64, wanted: f64, within: f64) -> Self {
        Self { what: what.to_string(), is, wanted, within }
    }

    /// What is to say of it if it is not as wanted; what is no number never is.
    fn off(&self) -> Option<String> {
        let Self { what, is, wanted, within } = self;
        let holds = (is - wanted).abs() <= *within;
        (!holds).then(|| format!("{what}: {is}, not {wanted} within {within}"))
    }
}

/// What an effect must leave alone.
#[derive(Clone, Copy)]
pub(crate) enum Stay {
    /// All frames until this time, s, to the bit, but for these.
    Frames(f64, &'static [CanId]),
    /// All that the receiver sends, to the bit.
    Receiver,
    /// A signal between two times, s, by no more than this.
    Within(&'static str, fn(&Recording) -> Vec<f64>, [f64; 2], f64),
}

/// One effect, at one set of values.
#[derive(Clone, Copy)]
pub(crate) struct Row {
    pub(crate) effect: &'static str,
    /// As an overlay has them.
    pub(crate) values: &'static str,
    pub(crate) shows: fn(&Seen) -> Vec<Size>,
    pub(crate) stays: &'static [Stay],
}

/// The run without the effect and the one with it.
pub(crate) struct Seen<'a> {
    pub(crate) without: &'a Recording,
    pub(crate) with: &'a Recording,
}

impl Row {
    fn effects(&self) -> Effects {
        let text = format!("[[effect]]\nname = \"{}\"\n{}\n", self.effect, self.values);
        let overlay = Overlay::parse(&text, Path::new(self.effect)).unwrap();
        overlay.effects(&Machine::xt28()).unwrap()
    }

    /// What is not as the row has it.
    pub(crate) fn off(&self, without: &Recording) -> Vec<String> {
        let with = &Recording::of(&self.effects());
        let sizes = (self.shows)(&Seen { without, with });
        let off = sizes.iter().filter_map(Size::off);
        let off = off.chain(self.stays.iter().filter_map(|stay| stay.off(without, with)));
        off.map(|off| format!("{} {}: {off}", self.effect, self.values)).collect()
    }
}

impl Stay {
    fn off(&self, without: &Recording, with: &Recording) -> Option<String> {
        match *self {
            Self::Frames(until_s, but) => {
                let ticks = ..=tick_at(until_s).min(without.frames.len() - 1);
                let both = without.frames[ticks].iter().zip(&with.frames[ticks]);
                let differ = both.enumerate().flat_map(|(tick, (a, b))| {
                    assert_eq!(a.len(), b.len(), "frames of tick {tick}");
                    a.iter().zip(b).filter(|(a, b)| a != b).map(move |(a, _)| (tick, a.id()))
                });
                let mut differ = differ.filter(|(_, id)| !but.contains(id));
                differ.next().map(|(tick, id)| format!("frame {id:?} differs in tick {tick}"))
            }
            Self::Receiver => {
                let differs = without.messages != with.messages;
                differs.then(|| "the receiver's messages differ".to_owned())
            }
            Self::Within(what, signal, between_s, bound) => {
                let [from, to] = between_s.map(tick_at);
                let both = signal(without).into_iter().zip(signal(with));
                let apart = both.map(|(a, b)| (a - b).abs()).take(to).skip(from);
                let apart = apart.fold(0.0, f64::max);
                (apart > bound).then(|| format!("{what} is {apart} off"))
            }
        }
    }
}

/// Positions of the receiver, tick by tick, of the kind that `of` takes.
pub(crate) fn messages<M>(
    recording: &Recording,
    of: impl Fn(&Message) -> Option<M>,
) -> Vec<(usize, M)> {
    let each = recording.messages.iter();
    each.filter_map(|(tick, message)| of(message).map(|m| (*tick, m))).collect()
}

/// Mean of a series between two times, s.
pub(crate) fn mean(series: &[f64], between_s: [f64; 2]) -> f64 {
    let [from, to] = between_s.map(tick_at);
    series[from..to].iter().sum::<f64>() / (to - from) as f64
}

/// Largest size of any number.
pub(crate) fn most(of: impl IntoIterator<Item = f64>) -> f64 {
    of.into_iter().map(f64::abs).fold(0.0, f64::max)
}
