//! How far the gap shrinks once a cause is in the simulator: the whole machine, ECUs and plant, on runs
//! that were not fitted.
//!
//! The gap is the mean over signals ([`Quantity`]) of the root mean square error in units of a floor,
//! over all held-out runs; the shrink is 1 - gap after / gap before. Three horizons: blocks on measured
//! inputs a tenth of a second ahead, the whole machine 5 s ahead of measured states, and over whole runs
//! from the first measured state. Without held-out runs, all runs are judged.

mod answer;
mod black_box;
mod folds;
mod free_step;
mod law;
mod machine_sample;
mod measured;
mod one_step;
mod reader;
mod refit;
mod shares;
mod squares;
mod traces;
mod twin;

use rayon::prelude::*;
use xt28_machine::Machine;
use xt28_sim::Effects;
use xt28_sim::effects::{Entry, Overlay, Scope};

pub use machine_sample::{Horizon, Quantity};
pub use refit::Refit;

use self::squares::Squares;
use self::twin::{Forecast, PreparedRun};
use super::inquiry::Inquiry;
use super::onset::FirstOnset;
use super::verdict::{Cause, Shrink};
use crate::{Channel, GapError, Series};

/// The logs of one machine, ready to be foretold under any belief.
#[derive(Clone, Debug)]
pub struct HowFar {
    machine: Machine,
    believed: Effects,
    runs: Vec<PreparedRun>,
    fit: Vec<bool>,
    before: HorizonErrors,
}

/// Squared errors on the judged runs at the three horizons.
#[derive(Clone, Debug, Default)]
struct HorizonErrors {
    ahead: Vec<one_step::OneStepErrors>,
    five_s: Vec<Squares>,
    run: Vec<Squares>,
}

/// What a run shows and what the machine is foretold to show, channel by channel.
#[derive(Clone, Debug, PartialEq)]
pub struct Traces {
    /// Name of the run.
    pub run: String,
    /// Channel, measured, foretold; SI over the log's seconds.
    pub channels: Vec<(Channel, Series, Series)>,
}

impl HowFar {
    /// Foretells every run under what is believed already.
    ///
    /// # Errors
    /// [`GapError::Command`] for a command that our bus cannot say.
    pub fn new(inquiry: &Inquiry) -> Result<Self, GapError> {
        let runs: Result<Vec<PreparedRun>, GapError> =
            inquiry.runs.iter().map(|run| PreparedRun::new(run, &inquiry.machine)).collect();
        let mut how_far = Self {
            machine: inquiry.machine.clone(),
            believed: inquiry.believed.clone(),
            runs: runs?,
            fit: inquiry.runs.iter().map(|run| run.fit).collect(),
            before: HorizonErrors::default(),
        };
        how_far.before = how_far.gaps(&how_far.believed, &FirstOnset::default());
        Ok(how_far)
    }

    /// Names of the runs that were not fitted, which a shrink is judged on; none where all were.
    #[must_use]
    pub fn held_out_runs(&self) -> Vec<String> {
        let each = self.runs.iter().zip(&self.fit).filter(|(_, fit)| !**fit);
        each.map(|(prepared, _)| prepared.signals.name.clone()).collect()
    }

    /// How far `effects` shrink the gap of what is believed.
    #[must_use]
    pub fn shrink(&self, effects: &Effects) -> Shrink {
        self.shrink_of(&self.gaps(effects, &FirstOnset::default()))
    }

    /// How far `causes` at their values shrink it, each run without them until they begin.
    #[must_use]
    pub fn shrink_by(&self, causes: &[Cause]) -> Shrink {
        self.shrink_of(&self.gaps(&self.with(causes), &since(causes)))
    }

    /// The gap on the judged runs under `effects` at a horizon of the whole machine: mean over signals,
    /// in floors.
    #[must_use]
    pub fn gap(&self, effects: &Effects, horizon: Horizon) -> f64 {
        squares::gap(&self.squares(effects, horizon, &FirstOnset::default(), |k| self.judges(k)))
    }

    /// The same signal by signal.
    #[must_use]
    pub fn gap_by_signal(&self, effects: &Effects, horizon: Horizon) -> Vec<(Quantity, f64)> {
        let squares = self.squares(effects, horizon, &FirstOnset::default(), |k| self.judges(k));
        Quantity::ALL.into_iter().zip(squares::by_signal(&squares)).collect()
    }

    /// What run number `run` shows, and what it is foretold to show with `causes`, once they begin, from its
    /// first measured state.
    ///
    /// # Panics
    /// For a run that the inquiry does not have.
    #[must_use]
    pub fn traces(&self, run: usize, causes: &[Cause]) -> Traces {
        let prepared = &self.runs[run];
        let both = [&self.believed, &self.with(causes)];
        let foretold = prepared.foretell_since(&self.machine, both, &since(causes), Horizon::Run);
        Traces { run: prepared.signals.name.clone(), channels: traces::traces(prepared, &foretold) }
    }

    /// What is believed, with the parameters of `causes`.
    #[must_use]
    pub fn with(&self, causes: &[Cause]) -> Effects {
        let mut effects = self.believed.clone();
        overlay(causes).entries.iter().for_each(|entry| entry.apply(&self.machine, &mut effects));
        effects
    }

    /// A run is judged if it was not fitted, or if all were.
    fn judges(&self, run: usize) -> bool {
        !self.fit[run] || self.fit.iter().all(|fit| *fit)
    }

    fn shrink_of(&self, after: &HorizonErrors) -> Shrink {
        let before = &self.before;
        let steps = |gaps: &HorizonErrors| -> Vec<Squares> {
            let runs = gaps.ahead.iter().zip(&before.ahead);
            runs.flat_map(|(ahead, mask)| one_step::squares(ahead, mask)).collect()
        };
        let (one_step, one) = squares::shrink(&steps(before), &steps(after));
        let (five_s, five) = squares::shrink(&before.five_s, &after.five_s);
        let (run, whole) = squares::shrink_by_run(&before.run, &after.run);
        Shrink { one_step, five_s, run, interval: [one, five, whole] }
    }

    fn gaps(&self, effects: &Effects, since: &FirstOnset) -> HorizonErrors {
        let judged: Vec<&PreparedRun> =
            (0..self.runs.len()).filter(|&k| self.judges(k)).map(|k| &self.runs[k]).collect();
        let ahead = |prepared: &&PreparedRun| {
            let of = |effects| one_step::ahead(&prepared.signals, &self.machine, effects);
            let after = of(effects);
            let since_s = since.in_run(prepared.signals.began_s);
            if since_s > 0.0 { one_step::splice(of(&self.believed), after, since_s) } else { after }
        };
        let squares = |horizon| self.squares(effects, horizon, since, |k| self.judges(k));
        let ((ahead, five_s), run) = rayon::join(
            || (judged.par_iter().map(ahead).collect(), squares(Horizon::FiveSeconds)),
            || squares(Horizon::Run),
        );
        HorizonErrors { ahead, five_s, run }
    }

    /// Squared errors on the runs that `of` names, in order; with `effects` from `since` on.
    fn squares(
        &self,
        effects: &Effects,
        horizon: Horizon,
        since: &FirstOnset,
        of: impl Fn(usize) -> bool + Sync,
    ) -> Vec<Squares> {
        let both = [&self.believed, effects];
        let foretell =
            |prepared: &PreparedRun| prepared.foretell_since(&self.machine, both, since, horizon);
        self.squares_of(&foretell, horizon, of)
    }

    /// Squared errors of what is foretold of the runs that `of` names, in order.
    fn squares_of(
        &self,
        foretell: &(dyn Fn(&PreparedRun) -> Vec<Forecast> + Sync),
        horizon: Horizon,
        of: impl Fn(usize) -> bool + Sync,
    ) -> Vec<Squares> {
        let blocks = |(k, prepared): (usize, &PreparedRun)| {
            let forecasts = if of(k) { foretell(prepared) } else { Vec::new() };
            let blocks = |forecast| squares::of_forecast(&prepared.measured, forecast, horizon);
            let blocks = forecasts.iter().flat_map(blocks);
            blocks.map(|block| Squares { run: k, ..block }).collect::<Vec<_>>()
        };
        self.runs.par_iter().enumerate().flat_map_iter(blocks).collect()
    }
}

/// When the first of `causes` begins.
pub(super) fn since<'a>(causes: impl IntoIterator<Item = &'a Cause>) -> FirstOnset {
    FirstOnset::of(causes.into_iter().map(Cause::onset))
}

/// The overlay that puts `causes` into a simulator, each with the best value of its parameters.
#[must_use]
pub fn overlay<'a>(causes: impl IntoIterator<Item = &'a Cause>) -> Overlay {
    let entry = |cause: &Cause| Entry {
        effect: cause.effect,
        scope: if cause.effect.has_scope() { cause.scope } else { Scope::All },
        severity: 1.0,
        values: cause
            .parameters
            .iter()
            .filter_map(|e| {
                let parameter = cause.effect.parameter(e.name)?;
                let [low, high] = parameter.range;
                Some((parameter, e.value[0].clamp(low, high)))
            })
            .collect(),
    };
    Overlay { entries: causes.into_iter().map(entry).collect() }
}
