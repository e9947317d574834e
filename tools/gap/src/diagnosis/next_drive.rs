//! What to drive next: the scripted manoeuvre that would best tell the remaining causes apart.
//!
//! Every manoeuvre is driven on our own machine under every leading cause at its fitted size. The
//! blocks are then driven with what that machine did, under its own cause and under each rival's. Half
//! the square of how far the two residuals lie apart, in floors and with correlated samples counted
//! once, is the logarithm of the odds that the drive is expected to give against the rival (the mean
//! log likelihood ratio of two Gaussians). A manoeuvre is worth what it gives in its worst case, the
//! pair that it tells apart least.

mod manoeuvre;

use rayon::prelude::*;
use xt28_sim::effects::Scope;
use xt28_sim::{Effects, Solver, Terrain};

use super::generator::Generator;
use super::inquiry::{FieldRun, Inquiry, file_name};
use super::signals::Signals;
use super::verdict::{Cause, Diagnosis, Drive, Next, WORTH_TELLING};
use crate::{FieldLog, GapError, Replay};

pub use manoeuvre::Manoeuvre;

/// Causes, or wheels of one, that are told apart, at most.
const RIVALS: usize = 3;
/// Beyond this probability an answer has no rivals worth a drive.
const SURE: f64 = 0.95;
/// A drive that is expected to give less, nats, is not worth its time.
const WORTH_MIN: f64 = 1.0;

/// A hypothesis in the running.
struct Rival {
    /// What people are told of it.
    name: String,
    effects: Effects,
}

/// A cause at some wheels, and how likely it is to be there.
struct Place<'a> {
    cause: &'a Cause,
    scope: Scope,
    values: Vec<f64>,
    probability: f64,
}

/// The manoeuvre worth most of those that no run is of already, with what it separates; `None` where no
/// two hypotheses remain, or none of those would tell them apart.
///
/// # Errors
/// [`GapError::Command`] where our own bus could not say a manoeuvre's command.
pub fn next_drive(
    inquiry: &Inquiry,
    diagnosis: &Diagnosis,
) -> Result<Option<(Next, Manoeuvre)>, GapError> {
    let rivals = rivals(inquiry, diagnosis);
    if rivals.len() < 2 {
        return Ok(None);
    }
    let worth = |manoeuvre: Manoeuvre| Ok((worth(inquiry, &rivals, &manoeuvre)?, manoeuvre));
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
    let told = |run: &FieldRun| run.scenario.clone().unwrap_or_else(|| run.log.name().to_owned());
    let made = |m: &Manoeuvre| inquiry.runs.iter().any(|run| is_of(&told(run), m.name));
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

/// Whether the log at `path`, or a scenario of that name, is of the drive `name`, by its own name:
/// `run-3-s_turn.log.gz`, `s_turn`.
fn is_of(path: &str, name: &str) -> bool {
    let file = file_name(path).to_lowercase().replace('_', "-");
    let stem = file.split('.').next().unwrap_or_default();
    stem.strip_suffix(name).is_some_and(|before| before.is_empty() || before.ends_with('-'))
}

/// The least certain of the causes stood by, or the likeliest of all, at each of the wheels that it may be at, and
/// what may be in its place; the other causes stood by are believed. Fewer than two where nothing is left to
/// tell apart.
fn rivals(inquiry: &Inquiry, diagnosis: &Diagnosis) -> Vec<Rival> {
    let stood: Vec<&Cause> = diagnosis.stood_by().collect();
    let Some(leader) = stood.last().copied().or_else(|| diagnosis.causes.first()) else {
        return Vec::new();
    };
    let wheels = leader.scopes.first().map_or(1.0, |(_, share)| *share);
    // What shows in nothing is no rival: no drive is known to show it.
    let none = diagnosis.probability_none + diagnosis.probability_unseen;
    if leader.probability * wheels > SURE || none > SURE {
        return Vec::new();
    }
    let mut base = inquiry.believed.clone();
    for other in stood.iter().filter(|cause| cause.effect != leader.effect) {
        Place::likeliest(other).apply(&mut base);
    }
    let others = diagnosis.causes.iter().filter(|cause| {
        let stands = stood.iter().any(|stood| stood.effect == cause.effect);
        !stands && cause.effect != leader.effect
    });
    let mut places = Place::all(leader);
    places.extend(others.map(Place::likeliest));
    places.retain(|place| place.probability >= WORTH_TELLING);
    places.sort_by(|a, b| b.probability.total_cmp(&a.probability));
    places.truncate(RIVALS);
    let mut rivals: Vec<Rival> = places.iter().map(|place| place.rival(&base, &places)).collect();
    if diagnosis.probability_none >= WORTH_TELLING {
        rivals.push(Rival { name: "none".to_owned(), effects: base });
    }
    rivals
}

impl<'a> Place<'a> {
    /// A cause at the wheels at which it is told.
    fn likeliest(cause: &'a Cause) -> Self {
        let values = cause.parameters.iter().map(|estimate| estimate.value[0]).collect();
        Self { cause, scope: cause.scope, values, probability: cause.probability }
    }

    /// A cause at each of the wheels that it may be at.
    fn all(cause: &'a Cause) -> Vec<Self> {
        let each = cause.scopes.iter().zip(&cause.values).map(|(&(scope, share), values)| Self {
            cause,
            scope,
            values: values.clone(),
            probability: share * cause.probability,
        });
        let all: Vec<Self> = each.collect();
        if all.len() > 1 { all } else { vec![Self::likeliest(cause)] }
    }

    fn apply(&self, effects: &mut Effects) {
        for (parameter, value) in self.cause.effect.parameters.iter().zip(&self.values) {
            let [low, high] = parameter.range;
            parameter.set(effects, self.scope, value.clamp(low, high));
        }
    }

    /// The rival that it is beside `base`, called by its wheels too where `all` has others of its effect.
    fn rival(&self, base: &Effects, all: &[Self]) -> Rival {
        let mut effects = base.clone();
        self.apply(&mut effects);
        let name = self.cause.effect.name;
        let is_alone = all.iter().filter(|other| other.cause.effect.name == name).count() == 1;
        let name = if is_alone { name.to_owned() } else { format!("{name} ({})", self.scope) };
        Rival { name, effects }
    }
}

/// The least that a manoeuvre is expected to give between any two rivals, nats.
fn worth(inquiry: &Inquiry, rivals: &[Rival], manoeuvre: &Manoeuvre) -> Result<f64, GapError> {
    let log = manoeuvre.commands();
    let mut least = f64::INFINITY;
    for truth in rivals {
        let signals = driven(inquiry, &log, &truth.effects)?;
        for other in rivals.iter().filter(|other| other.name != truth.name) {
            least = least.min(apart(inquiry, &signals, &truth.effects, &other.effects));
        }
    }
    Ok(least)
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

/// Half the squared distance of every block's residuals under two beliefs, nats.
fn apart(inquiry: &Inquiry, signals: &Signals, own: &Effects, other: &Effects) -> f64 {
    let of = |generator: Generator| -> f64 {
        let residuals = |effects| generator.residuals(signals, &inquiry.machine, effects);
        let pairs = residuals(own).into_iter().zip(residuals(other));
        pairs
            .map(|(own, other)| {
                let steps = own.values.iter().zip(&other.values).map(|(a, b)| a - b);
                let squares = steps.filter(|step| step.is_finite()).map(|step| step * step);
                own.signal.weight() * squares.sum::<f64>()
            })
            .sum()
    };
    0.5 * Generator::all().into_iter().map(of).sum::<f64>()
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
