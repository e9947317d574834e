//! What to drive next: the scripted manoeuvre that would best tell the remaining causes apart.
//!
//! Every manoeuvre is driven on our own machine under every leading cause at its fitted size. What that
//! shows is put beside the runs that were driven, and the causes are weighed on all of them as a diagnosis
//! would: each with its own parameters and all tolerances at their best, differences below a floor worth
//! nothing. By how much more the rivals then lie apart is what the drive is expected to give. A manoeuvre is
//! worth what it gives in its worst case, the pair that it tells apart least.

mod manoeuvre;
mod rivals;

use rayon::prelude::*;
use xt28_sim::{Effects, Solver, Terrain};

use super::evidence::{Ahead, Evidence};
use super::inquiry::{Inquiry, is_of};
use super::judgement::temperature;
use super::knob::Knob;
use super::signals::Signals;
use super::verdict::{Diagnosis, Drive, Next};
use crate::{FieldLog, GapError, Replay};

pub use manoeuvre::Manoeuvre;
use rivals::{Rival, rivals};

/// A drive that is expected to give less, nats, is not worth its time.
const WORTH_MIN: f64 = 1.0;

/// The manoeuvre worth most of those that no run is of already, with what it separates; `None` where no
/// two hypotheses remain, or none of those would tell them apart.
///
/// # Errors
/// [`GapError::Command`] where our own bus could not say a manoeuvre's command.
pub fn next_drive(
    inquiry: &Inquiry,
    diagnosis: &Diagnosis,
) -> Result<Option<(Next, Manoeuvre)>, GapError> {
    let (base, rivals) = rivals(inquiry, diagnosis);
    if rivals.len() < 2 {
        return Ok(None);
    }
    let runs = inquiry.runs.iter().filter(|run| run.fit).map(|run| run.signals.clone());
    let runs: Vec<Signals> = runs.collect();
    let temperature = temperature(diagnosis.grounds.evidence_nats);
    let footing = Footing::new(inquiry, &runs, (&base, &rivals), temperature);
    let worth = |manoeuvre: Manoeuvre| Ok((footing.worth(&manoeuvre)?, manoeuvre));
    let mut ranked: Vec<(f64, Manoeuvre)> =
        not_made(inquiry).into_par_iter().map(worth).collect::<Result<_, GapError>>()?;
    ranked.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut ranked = ranked.into_iter();
    Ok(ranked.next().filter(|(nats, _)| *nats >= WORTH_MIN).map(|(nats, best)| {
        let separates = rivals.iter().map(|rival| rival.name.clone()).collect();
        let others = ranked.map(|(nats, m)| drive(diagnosis, &m, Some(nats))).collect();
        let Drive { manoeuvre, nats, tests } = drive(diagnosis, &best, Some(nats));
        (Next { manoeuvre, separates, nats, tests, others }, best)
    }))
}

/// The manoeuvres that no run is of, fitted or held out: what a drive that was made could tell, it has told.
fn not_made(inquiry: &Inquiry) -> Vec<Manoeuvre> {
    let made = |m: &Manoeuvre| inquiry.runs.iter().any(|run| run.is_of_drive(m.name));
    Manoeuvre::all().into_iter().filter(|m| !made(m)).collect()
}

/// A manoeuvre, with what it would test beside.
fn drive(diagnosis: &Diagnosis, manoeuvre: &Manoeuvre, nats: Option<f64>) -> Drive {
    let untested = diagnosis.not_testable.iter().filter(|one| one.manoeuvre == manoeuvre.name);
    let tests = untested.map(|one| one.effect.name).collect();
    Drive { manoeuvre: manoeuvre.name.to_owned(), nats, tests }
}

/// The manoeuvre of those that no run is of already that would show most of what the logs could not, with
/// what it shows; `None` where there is none.
#[must_use]
pub fn untested_drive(inquiry: &Inquiry, diagnosis: &Diagnosis) -> Option<(Next, Manoeuvre)> {
    let all = not_made(inquiry).into_iter().map(|m| (drive(diagnosis, &m, None), m));
    let mut ranked: Vec<(Drive, Manoeuvre)> =
        all.filter(|(drive, _)| !drive.tests.is_empty()).collect();
    ranked.sort_by_key(|(drive, _)| core::cmp::Reverse(drive.tests.len()));
    let mut ranked = ranked.into_iter();
    let (Drive { manoeuvre, nats, tests }, best) = ranked.next()?;
    let others = ranked.map(|(drive, _)| drive).collect();
    Some((Next { manoeuvre, separates: Vec::new(), nats, tests, others }, best))
}

/// The commands of the scripted drive that a log of this name, or a scenario, is of; `None` where it is of none.
pub(crate) fn scripted_drive(name: &str) -> Option<FieldLog> {
    Manoeuvre::all().into_iter().find(|m| is_of(name, m.name)).map(|m| m.commands())
}

/// What the rivals stand on: the runs fitted, with what each rival costs there.
struct Footing<'a> {
    inquiry: &'a Inquiry,
    rivals: &'a [Rival],
    base: &'a Effects,
    knobs: Vec<Knob>,
    evidence: Evidence<'a>,
    costs: Vec<f64>,
    /// By which evidence is divided before it becomes odds.
    temperature: f64,
}

impl<'a> Footing<'a> {
    fn new(
        inquiry: &'a Inquiry,
        driven: &'a [Signals],
        (base, rivals): (&'a Effects, &'a [Rival]),
        temperature: f64,
    ) -> Self {
        let knobs = Knob::of(&inquiry.catalogue);
        let evidence = Evidence::new(driven, &inquiry.machine, base.clone(), &knobs);
        let least = |rival: &Rival| rival.least(base, &|belief, only| evidence.cost(belief, only));
        let costs = rivals.par_iter().map(least).collect();
        Self { inquiry, rivals, base, knobs, evidence, costs, temperature }
    }

    /// The least that a manoeuvre is expected to give between any two rivals, nats.
    fn worth(&self, manoeuvre: &Manoeuvre) -> Result<f64, GapError> {
        let log = manoeuvre.commands();
        let each = (0..self.rivals.len()).into_par_iter().map(|truth| {
            let signals = [driven(self.inquiry, &log, &self.rivals[truth].effects)?];
            Ok(self.given(truth, &signals))
        });
        each.try_reduce(|| f64::INFINITY, |a, b| Ok(a.min(b)))
    }

    /// The least that `signals`, foretold with rival `truth`, give for it against any other, nats.
    fn given(&self, truth: usize, signals: &[Signals]) -> f64 {
        let Inquiry { machine, .. } = self.inquiry;
        let foretold = Evidence::new(signals, machine, self.base.clone(), &self.knobs);
        let ahead = Ahead::new(&self.evidence, &foretold, self.rivals[truth].belief());
        let cost = |rival: &Rival| rival.least(self.base, &|belief, only| ahead.cost(belief, only));
        let own = cost(&self.rivals[truth]) - self.costs[truth];
        let others = (0..self.rivals.len()).filter(|&k| k != truth);
        let gains = others.map(|k| 0.5 * (cost(&self.rivals[k]) - self.costs[k] - own));
        (gains.fold(f64::INFINITY, f64::min) / self.temperature).max(0.0)
    }
}

/// What our machine shows on a manoeuvre's commands.
fn driven(inquiry: &Inquiry, log: &FieldLog, effects: &Effects) -> Result<Signals, GapError> {
    let replay = Replay::run(log, &inquiry.machine, effects, Solver::Reduced, &Terrain::Flat)?;
    let mut series = replay.all_series().clone();
    for (channel, samples) in log.all_series() {
        if channel.is_command() {
            series.insert(*channel, samples.clone());
        }
    }
    Signals::of_series(log.name(), &series, log.duration_s(), Terrain::Flat)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_log_is_of_the_drive_that_its_name_ends_with() {
        for (path, drive) in [
            ("field/run-3-s_turn.log.gz", "s-turn"),
            ("S-Turn.mcap", "s-turn"),
            ("s_turn", "s-turn"),
            ("day.2/run-2-single_arm.log", "single-arm"),
        ] {
            assert!(is_of(path, drive), "{path}");
        }
        for (path, drive) in [
            ("straight-25m.log", "straight"),
            ("s-turn/run-1.log", "s-turn"),
            ("unmixed.log", "mixed"),
        ] {
            assert!(!is_of(path, drive), "{path}");
        }
    }
}
