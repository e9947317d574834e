//! A question put to the logs of one machine: what is known, what was driven, what may be the matter.

use rayon::prelude::*;
use xt28_machine::Machine;
use xt28_sim::Effects;
use xt28_sim::effects::{CATALOGUE, Effect};

use super::generator::share_resistance;
use super::noise::with_noise_of;
use super::signals::Signals;
use crate::{FieldLog, GapError, Terrain};

/// One run of the machine.
#[derive(Clone, Debug)]
pub struct FieldRun {
    /// Its log.
    pub log: FieldLog,
    /// The log on the diagnosis's clock.
    pub signals: Signals,
    /// Whether causes may be fitted on it; the others are held out.
    pub fit: bool,
}

/// What is asked.
#[derive(Clone, Debug)]
pub struct Inquiry {
    /// The machine as one believes it to be.
    pub machine: Machine,
    /// Effects that one knows to be there.
    pub believed: Effects,
    /// Its runs, in the order driven.
    pub runs: Vec<FieldRun>,
    /// Effects that may be the cause.
    pub catalogue: Vec<&'static Effect>,
    /// Whether to say how far the gap shrinks: the longest part of the work.
    pub how_far: bool,
}

impl FieldRun {
    /// A run on `terrain`.
    ///
    /// # Errors
    /// [`GapError::Unmeasured`] names the channels that the log has not.
    pub fn new(log: FieldLog, terrain: Terrain, fit: bool) -> Result<Self, GapError> {
        let signals = Signals::new(&log, terrain)?;
        Ok(Self { log, signals, fit })
    }
}

impl Inquiry {
    /// The nominal machine with every effect of the catalogue in question. Floors become those of the
    /// logs' own noise, and what resists the wheels is known to all runs.
    #[must_use]
    pub fn new(machine: Machine, mut runs: Vec<FieldRun>) -> Self {
        runs.par_iter_mut().for_each(|run| {
            run.signals = with_noise_of(run.signals.clone(), run.log.all_series(), &machine);
        });
        share_resistance(runs.iter_mut().map(|run| &mut run.signals), &machine);
        Self {
            machine,
            believed: Effects::default(),
            runs,
            catalogue: CATALOGUE.iter().collect(),
            how_far: true,
        }
    }

    /// The same without `effect` in the catalogue: what it does must then come out as unknown.
    #[must_use]
    pub fn without(mut self, effect: &Effect) -> Self {
        self.catalogue.retain(|other| *other != effect);
        self
    }
}
