//! The logs of one machine that belong together: each read once, with the ground it was driven on.

mod attended;
mod choice;
mod claims;
mod names;
mod shared_time;
mod soundness;

use std::path::{Path, PathBuf};

use rayon::prelude::*;
use xt28_machine::Machine;
use xt28_sim::Terrain;

use crate::diagnosis::{
    FieldRun, Inquiry, Signals, ensure_motions_agreeing, ensure_pressures_agreeing,
    ensure_valves_agreeing, swapped_wheels,
};
use crate::{About, Decoder, FieldLog, GapError};

use attended::attended;
pub use choice::{Choice, Use};
use names::{ensure_each_once, ensure_told_apart, names};
use shared_time::{SharedTime, shared_time};

/// Logs of one machine, in the order given, no two the same.
#[derive(Clone, Debug)]
pub struct RunSet {
    runs: Vec<KnownRun>,
    notes: Vec<String>,
    warnings: Vec<String>,
}

/// One log with what is known of it.
#[derive(Clone, Debug)]
pub struct KnownRun {
    /// File name, with its folder where another run has the same.
    pub file: String,
    /// What was driven, where `about.toml` says.
    pub scenario: Option<String>,
    /// Whether `about.toml` advises to fit on it; `None` without one.
    pub advised: Option<bool>,
    /// The ground it was driven on, as far as one knows.
    pub terrain: Terrain,
    /// The log.
    pub log: FieldLog,
}

/// What is said of the ground, beside the logs.
#[derive(Clone, Copy, Debug, Default)]
pub struct Known<'a> {
    /// What is known of the logs: the file that speaks of each.
    pub about: Option<&'a Path>,
    /// Whether that was asked for, and so has to speak of every log; what was found beside them need not.
    pub is_asked: bool,
    /// The ground of every run, instead of what `about` says.
    pub terrain: Option<&'a Path>,
}

impl RunSet {
    /// Reads the logs at `paths`. With `accept_cut`, a log that ends in the middle of a line is taken
    /// as ending before it.
    ///
    /// # Errors
    /// [`GapError`]: what cannot be read, what cannot be diagnosed (too short, without a signal, on a
    /// clock that steps, with values that cannot be), and two files that hold one log or parts of it that overlap.
    pub fn load(
        paths: &[PathBuf],
        decoder: &Decoder,
        known: Known<'_>,
        accept_cut: bool,
    ) -> Result<Self, GapError> {
        ensure_each_once(paths)?;
        let about = known.about.map(About::load).transpose()?;
        let one_ground = known.terrain.map(Terrain::load).transpose()?;
        if let (Some(about), Some(file)) = (&about, known.about) {
            ensure_told_apart(about, file, paths)?;
        }
        let read = |(path, file): (&PathBuf, String)| {
            let told = match (&about, known.about) {
                (Some(about), Some(file)) => {
                    let told = about.run_of(path);
                    if told.is_none() && one_ground.is_none() && known.is_asked {
                        let log = file_name(path);
                        return Err(GapError::NoRun { path: file.to_owned(), log });
                    }
                    told
                }
                _ => None,
            };
            let ground = match (&one_ground, told) {
                (Some(ground), _) => ground.clone(),
                (None, Some(_)) => About::terrain_of(known.about.unwrap_or(path), path)?,
                (None, None) => Terrain::Flat,
            };
            let log = FieldLog::load(path, decoder, accept_cut)?;
            log.ensure_one_clock()?;
            let claims = match (&about, known.about, told) {
                (Some(about), Some(file), Some(run)) => claims::denied(about, file, run, &log),
                _ => Vec::new(),
            };
            let (log, left_out) = attended(log, decoder);
            soundness::check(&log, decoder)?;
            let run = KnownRun {
                file,
                scenario: told.and_then(|run| run.scenario.clone()),
                advised: told.map(|run| run.fit),
                terrain: ground,
                log,
            };
            Ok((run, claims.into_iter().chain(left_out).collect()))
        };
        let called = names(paths);
        let read: Vec<_> =
            paths.par_iter().zip(called).map(read).collect::<Result<_, GapError>>()?;
        let (runs, told): (Vec<KnownRun>, Vec<Vec<String>>) = read.into_iter().unzip();
        let mut notes = told.concat();
        if one_ground.is_none() && about.is_none() {
            notes.push(
                "No word on the ground: every run is taken as driven on level ground.".to_owned(),
            );
        }
        let unnamed = about.as_ref().map_or_else(Vec::new, |about| {
            let unnamed = paths.iter().zip(&runs).filter(|(path, _)| about.run_of(path).is_none());
            unnamed.map(|(_, run)| run.file.as_str()).collect()
        });
        let warning =
            known.about.and_then(|file| passed_over(file, &unnamed, one_ground.is_some()));
        let warnings = warning.into_iter().collect();
        Ok(Self { warnings, ..Self::new(runs, notes)? })
    }

    /// The set of `runs`, with what there is to say of them.
    ///
    /// # Errors
    /// [`GapError::SameLog`] where two hold one log, [`GapError::SharedTime`] where they hold a part of one.
    pub fn new(runs: Vec<KnownRun>, notes: Vec<String>) -> Result<Self, GapError> {
        let before = |i: usize| runs[..i].iter().map(move |before| (before, i));
        let pairs: Vec<_> = (0..runs.len()).flat_map(before).collect();
        let apart = |(before, i): &(&KnownRun, usize)| each_its_own(&before.log, &runs[*i].log);
        // In order, so that of several errors it is always the same that is told.
        let answers: Vec<_> = pairs.par_iter().map(apart).collect();
        answers.into_iter().collect::<Result<(), GapError>>()?;
        Ok(Self { runs, notes, warnings: Vec::new() })
    }

    /// The runs, in the order given.
    #[must_use]
    pub fn runs(&self) -> &[KnownRun] {
        &self.runs
    }

    /// The same runs with each log as `seen`.
    #[must_use]
    pub fn map_logs(mut self, seen: impl Fn(FieldLog) -> FieldLog) -> Self {
        let again = |run: KnownRun| KnownRun { log: seen(run.log), ..run };
        self.runs = self.runs.into_iter().map(again).collect();
        self
    }

    /// What was taken for granted, and the faults of every log; whole sentences.
    #[must_use]
    pub fn notes(&self) -> Vec<String> {
        let faults = self.runs.iter().flat_map(|run| run.log.told_faults());
        self.warnings.iter().chain(&self.notes).cloned().chain(faults).collect()
    }

    /// Those of the notes that nobody may miss.
    #[must_use]
    pub fn warnings(&self) -> &[String] {
        &self.warnings
    }

    /// What is asked of the runs, about a machine of `machine`'s make, without those that `choice` leaves out.
    /// Where nobody chose which are held out, the last ones are without which the others show every effect
    /// that all of them do. With `any_order`, wheels may look swapped.
    ///
    /// # Errors
    /// As [`RunSet::into_field_runs`].
    pub fn into_inquiry(
        self,
        machine: Machine,
        choice: &Choice,
        any_order: bool,
    ) -> Result<Inquiry, GapError> {
        let runs = self.into_field_runs(&machine, choice, any_order)?;
        let mut inquiry = Inquiry::new(machine, runs);
        if !choice.is_advised {
            inquiry.hold_out_what_others_show();
        }
        Ok(inquiry)
    }

    /// The runs for an inquiry about a machine of `machine`'s make, without those that `choice` leaves out. With
    /// `any_order`, wheels may look swapped.
    ///
    /// # Errors
    /// [`GapError::Unmeasured`] names what a log has not, [`GapError::WheelOrder`] the wheels that look
    /// swapped; and as [`ensure_agreeing`](crate::diagnosis::ensure_agreeing).
    pub fn into_field_runs(
        self,
        machine: &Machine,
        choice: &Choice,
        any_order: bool,
    ) -> Result<Vec<FieldRun>, GapError> {
        let used = self.runs.into_iter().zip(&choice.uses).filter(|(_, used)| **used != Use::Left);
        let runs: Vec<FieldRun> = used
            .map(|(run, used)| {
                let field_run = FieldRun::new(run.log, run.terrain, *used == Use::Fit)?;
                Ok(field_run.driven(run.scenario).called(run.file))
            })
            .collect::<Result<_, GapError>>()?;
        let signals: Vec<Signals> = runs.iter().map(|run| run.signals.clone()).collect();
        ensure_pressures_agreeing(&signals, machine)?;
        ensure_valves_agreeing(&signals)?;
        // Before attitude is held against strokes: wheels in another order make a machine that leans the other
        // way, and are no fault of the unit that says so.
        match swapped_wheels(&signals, machine) {
            Some(swap) if !any_order => return Err(GapError::WheelOrder { swap }),
            _ => ensure_motions_agreeing(&signals, machine)?,
        }
        Ok(runs)
    }
}

/// What to say of logs `unnamed` in an `about` that was found beside them; nothing where it names all.
fn passed_over(about: &Path, unnamed: &[&str], is_ground_told: bool) -> Option<String> {
    let logs = unnamed.join(", ");
    let ground =
        if is_ground_told { "driven where --terrain says" } else { "driven on level ground" };
    (!unnamed.is_empty()).then(|| {
        format!(
            "IGNORED for {logs}: {} lies beside and has no [[run]] with that file; taken as {ground}, and nothing is \
             known of what was driven. Name it there, or say --about or --terrain.",
            about.display()
        )
    })
}

/// Refuses two logs that are one, or parts of one that overlap.
fn each_its_own(first: &FieldLog, again: &FieldLog) -> Result<(), GapError> {
    let [of_first, of_again] = [first, again].map(|log| log.name().to_owned());
    if same(first, again) {
        return Err(GapError::SameLog { first: of_first, again: of_again });
    }
    shared_time(first, again).map_or(Ok(()), |SharedTime { first_s, again_s }| {
        Err(GapError::SharedTime { first: of_first, first_s, again: of_again, again_s })
    })
}

/// One log under two names: the same samples at the same instants.
fn same(a: &FieldLog, b: &FieldLog) -> bool {
    a.frames() == b.frames() && a.duration_s() == b.duration_s() && a.all_series() == b.all_series()
}

fn file_name(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}
