//! What speaks against the best cause or pair: a signal that it leaves, an echo of itself in that, or
//! tolerances that would have to bend.

use super::super::candidates::Candidate;
use super::super::evidence::Echo;
use super::Findings;
use super::allowed::{echoing, excess};

/// Squares of the tolerances' shifts, each by its own, that a right answer may take, all together: what
/// is not in the catalogue bends them by more.
const SHIFTS: f64 = 53.0;
/// The share of the best evidence, nats, by which that rises: what a law leaves of a large gap bends
/// tolerances too.
const SHIFTS_SHARE: f64 = 0.01;
/// How far the one that goes furthest may go, by its own.
const SHIFT: f64 = 4.4;

/// Something that a right answer would not leave so large.
#[derive(Clone, Debug)]
pub(super) struct Objection {
    /// How large it is beside the largest that a right answer leaves.
    pub(super) times: f64,
    /// What it is, after `because`.
    pub(super) why: String,
}

impl Findings {
    /// The strongest objection to the best cause or pair; about one, or less, where it is right.
    pub(super) fn objection(&self) -> Objection {
        let of_signals = self.signals_left().chain(self.echoing());
        let all = of_signals.chain(self.furthest()).chain([self.bending()]);
        all.max_by(|a, b| a.times.total_cmp(&b.times)).expect("tolerances are always there")
    }

    /// The causes that are believed where this is said.
    fn names(&self) -> Vec<&'static str> {
        let pair = self.pair.first().into_iter().flatten();
        self.single.first().into_iter().chain(pair).map(Candidate::name).collect()
    }

    fn signals_left(&self) -> impl Iterator<Item = Objection> {
        let names = self.names();
        let explained = self.echoes.iter().map(Echo::square).chain(std::iter::repeat(0.0));
        let signals = self.unbent.iter().zip(&self.after).zip(explained);
        signals.map(move |((before, after), explained)| Objection {
            times: excess(&names, [before, after], explained),
            why: format!(
                "it leaves {:.1} floors of {:.1} of the {} of {}",
                after.square.sqrt(),
                before.square.sqrt(),
                after.signal,
                after.generator
            ),
        })
    }

    fn echoing(&self) -> impl Iterator<Item = Objection> {
        let names = self.names();
        self.echoes.iter().map(move |echo| Objection {
            times: echoing(&names, echo),
            why: format!(
                "what it leaves of the {} of {} is what it explains of it, moved in time ({:.0} nats)",
                echo.signal, echo.generator, echo.nats
            ),
        })
    }

    /// The tolerance that goes furthest.
    fn furthest(&self) -> Option<Objection> {
        let furthest = self.shifts.iter().max_by(|(_, a), (_, b)| a.abs().total_cmp(&b.abs()));
        furthest.map(|(knob, by)| Objection {
            times: (by / SHIFT).powi(2),
            why: format!("a tolerance, {knob}, would have to be {:.1} times as wide", by.abs()),
        })
    }

    /// All tolerances together.
    fn bending(&self) -> Objection {
        let taken = SHIFTS + SHIFTS_SHARE * self.evidence();
        let squares: f64 = self.shifts.iter().map(|(_, by)| by * by).sum();
        Objection {
            times: squares / taken,
            why: format!(
                "all tolerances together would have to move by {squares:.0} squares of their own"
            ),
        }
    }
}
