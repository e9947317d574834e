//! What the logs say of every hypothesis, before it is judged.

use super::super::candidate::Candidate;
use super::super::evidence::{Echo, Left, Uneven};
use super::super::knob::Knob;
use super::super::scales::Grounds;

/// What the logs say of every hypothesis.
#[derive(Clone, Debug, Default)]
pub struct Findings {
    /// What each signal leaves.
    pub signals: Vec<SignalFindings>,
    /// Whether what the best cause or pair explains of a signal is another share of what is there in one half of all
    /// runs than in the other; a signal may be halved in several ways.
    pub unevens: Vec<Uneven>,
    /// Single causes, best first.
    pub single: Vec<Candidate>,
    /// Pairs of causes, best first; empty where one is enough.
    pub pair: Vec<[Candidate; 2]>,
    /// What may be the first of the best pair, sought anew beside its second, best first.
    pub firsts: Vec<Candidate>,
    /// Where the tolerances go beside the best cause or pair, each by how many of its own.
    pub shifts: Vec<(Knob, f64)>,
    /// What the runs say that were held out.
    pub held_out: HeldOut,
}

/// What one signal leaves of the runs fitted, by what is believed.
#[derive(Clone, Copy, Debug)]
pub struct SignalFindings {
    /// While nothing is believed to be wrong, tolerances where they are believed to be.
    pub unbent: Left,
    /// The same with the tolerances where they are while nothing is believed, none further than one of its
    /// own: what parts on a machine that nobody can name the fault of.
    pub alone: Left,
    /// The same with the tolerances where they are once the best cause or pair is believed.
    pub apart: Left,
    /// Under the best cause or pair; under nothing where no cause was found.
    pub after: Left,
    /// How much of that is what they explain, moved in time; nothing where no cause was found.
    pub echo: Option<Echo>,
}

/// What runs that were held out say of the best cause or pair; nothing where there are none.
#[derive(Clone, Debug, Default)]
pub struct HeldOut {
    /// What each signal leaves of them.
    pub signals: Vec<HeldOutSignal>,
    /// [`Findings::shifts`] of them.
    pub shifts: Vec<(Knob, f64)>,
}

/// What one signal leaves of the runs held out.
#[derive(Clone, Copy, Debug)]
pub struct HeldOutSignal {
    /// [`SignalFindings::unbent`] there.
    pub unbent: Left,
    /// [`SignalFindings::after`] there, tolerances at their best there.
    pub after: Left,
}

impl Findings {
    /// How far the worst signal lies above what a right answer leaves, or its echo above that of one, or
    /// the tolerances, all together or the one that goes furthest, above what it takes; about one where
    /// all is explained.
    #[must_use]
    pub fn left_over(&self) -> f64 {
        self.objection().times
    }

    /// What [`Self::left_over`] is about, after `because`.
    #[must_use]
    pub fn left_over_why(&self) -> String {
        self.objection().why
    }

    /// The same of the runs held out alone, and what speaks loudest there; nothing without any.
    #[must_use]
    pub fn left_over_held(&self) -> Option<(f64, String)> {
        let loudest = self.held_left().max_by(|a, b| a.times.total_cmp(&b.times))?;
        Some((loudest.times, loudest.why))
    }

    /// What a verdict on them rests on.
    #[must_use]
    pub fn grounds(&self) -> Grounds {
        Grounds { evidence_nats: self.evidence(), left_over: self.left_over() }
    }

    /// The best pair, or the best cause where one is enough.
    pub(super) fn believed(&self) -> impl Iterator<Item = &Candidate> {
        let alone = self.single.first().filter(|_| self.pair.is_empty());
        self.pair.first().into_iter().flatten().chain(alone)
    }

    /// Evidence of the best cause, nats.
    #[must_use]
    pub fn evidence(&self) -> f64 {
        self.single.first().map_or(0.0, |best| best.score().max(0.0))
    }
}

impl SignalFindings {
    /// Signal by signal what lists say that are all in the order of the generators' signals; `echoes` may be none.
    pub(in crate::diagnosis) fn each(
        [unbent, alone, apart, after]: [&[Left]; 4],
        echoes: &[Echo],
    ) -> Vec<Self> {
        let signal = |k: usize| Self {
            unbent: unbent[k],
            alone: alone[k],
            apart: apart[k],
            after: after[k],
            echo: echoes.get(k).copied(),
        };
        (0..after.len()).map(signal).collect()
    }

    /// Mean square of what the best cause or pair explains of it, in units of the floor.
    pub(super) fn explained_square(&self) -> f64 {
        self.echo.as_ref().map_or(0.0, Echo::square)
    }
}

#[cfg(test)]
impl SignalFindings {
    /// A signal that leaves `before` wherever the tolerances are, `after` under the best cause, and no echo.
    pub(super) const fn of([before, after]: [Left; 2]) -> Self {
        Self { unbent: before, alone: before, apart: before, after, echo: None }
    }
}
