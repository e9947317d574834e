//! A question put to the logs of one machine: what is known, what was driven, what may be the matter.

use rayon::prelude::*;
use xt28_machine::Machine;
use xt28_sim::Effects;
use xt28_sim::effects::{CATALOGUE, Effect};

use super::excitation::not_testable;
use super::generator::share_resistance;
use super::noise::with_noise_of;
use super::onset::put_in_order;
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
    /// What was driven, where somebody says; else the log's name may tell.
    pub scenario: Option<String>,
}

/// What is asked.
#[derive(Clone, Debug)]
pub struct Inquiry {
    /// The machine as one believes it to be.
    pub machine: Machine,
    /// Effects that one knows to be there.
    pub believed: Effects,
    /// Its runs.
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
        let name = file_name(log.name());
        Ok(Self { log, signals, fit, scenario: None }.called(name))
    }

    /// The same run of the drive `scenario`.
    #[must_use]
    pub fn driven(self, scenario: Option<String>) -> Self {
        Self { scenario, ..self }
    }

    /// The same run under `name`, where its file's is another's as well.
    #[must_use]
    pub fn called(mut self, name: String) -> Self {
        self.signals.name = name;
        self
    }

    /// Whether it is of the scripted drive `name`, by what is said of it or by its own name.
    #[must_use]
    pub(super) fn is_of_drive(&self, name: &str) -> bool {
        is_of(self.scenario.as_deref().unwrap_or_else(|| self.log.name()), name)
    }

    /// What it is called: its log's file, without folders where it needs none.
    #[must_use]
    pub fn file(&self) -> String {
        self.signals.name.clone()
    }
}

impl Inquiry {
    /// The nominal machine with every effect of the catalogue in question. Floors become those of the
    /// logs' own noise, what resists the wheels is known to all runs, and stamps say which was driven first.
    #[must_use]
    pub fn new(machine: Machine, mut runs: Vec<FieldRun>) -> Self {
        runs.par_iter_mut().for_each(|run| {
            run.signals = with_noise_of(run.signals.clone(), run.log.all_series(), &machine);
        });
        let stamped = runs.iter_mut().map(|run| (&mut run.signals, run.log.begun_s()));
        put_in_order(&mut stamped.collect::<Vec<_>>());
        share_resistance(runs.iter_mut().map(|run| &mut run.signals), &machine);
        Self {
            believed: Effects::none_on(&machine),
            catalogue: CATALOGUE.iter().map(|effect| effect.on(&machine)).collect(),
            runs,
            machine,
            how_far: true,
        }
    }

    /// Of runs that nobody chose a use for, holds out a third: the last ones without which the others show
    /// every effect that all of them do. A fault that only runs held out show is fitted on nothing, and so
    /// never named.
    pub fn hold_out_what_others_show(&mut self) {
        let count = self.runs.len();
        let most = if count < 2 { 0 } else { count.div_ceil(3) };
        self.runs.iter_mut().for_each(|run| run.fit = true);
        let least = self.not_shown();
        let mut held = 0;
        for i in (0..count).rev() {
            if held == most {
                break;
            }
            self.runs[i].fit = false;
            if self.not_shown() > least {
                self.runs[i].fit = true;
            } else {
                held += 1;
            }
        }
    }

    /// How many effects the runs that are fitted cannot show.
    fn not_shown(&self) -> usize {
        let fitted = self.runs.iter().filter(|run| run.fit).map(|run| &run.signals);
        not_testable(fitted, &self.machine, &self.catalogue).len()
    }

    /// The same without `effect` in the catalogue: what it does must then come out as unknown.
    #[must_use]
    pub fn without(mut self, effect: &Effect) -> Self {
        self.catalogue.retain(|other| *other != effect);
        self
    }
}

/// The last part of a path, whichever way its folders are parted.
pub(super) fn file_name(path: &str) -> String {
    path.rsplit(['/', '\\']).next().unwrap_or(path).to_owned()
}

/// Whether the log at `path`, or a scenario of that name, is of the drive `name`, by its own name:
/// `run-3-s_turn.log.gz`, `s_turn`.
pub(super) fn is_of(path: &str, name: &str) -> bool {
    let file = file_name(path).to_lowercase().replace('_', "-");
    let stem = file.split('.').next().unwrap_or_default();
    stem.strip_suffix(name).is_some_and(|before| before.is_empty() || before.ends_with('-'))
}
