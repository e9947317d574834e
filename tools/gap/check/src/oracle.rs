//! How far the gap shrinks for who knows the cause: what a diagnosis can reach at best.

use xt28_gap::diagnosis::{Beginning, Cause, Estimate, HowFar, Inquiry, Onset, Shrink};

use crate::CheckError;
use crate::source::Source;
use crate::truth::{Fact, Truth};

/// The shrink with the true effects at their true scopes, fitted by the same code from the true values
/// where the catalogue has them. `None` where the truth is in no catalogue.
///
/// # Errors
/// [`CheckError`] for logs that cannot be made, read or replayed.
pub(crate) fn oracle(source: &Source, truth: &Truth) -> Result<Option<Shrink>, CheckError> {
    if !truth.is_nameable() {
        return Ok(None);
    }
    let inquiry = source.inquiry()?;
    let mut causes = Vec::new();
    for fact in &truth.facts {
        causes.extend(cause(fact, onset(fact, truth, &inquiry)?));
    }
    Ok(Some(HowFar::new(&inquiry)?.refit(&causes).shrink))
}

/// A true effect as a cause that one is sure of.
fn cause(fact: &Fact, onset: Onset) -> Option<Cause> {
    let effect = fact.effect?;
    let known = |name: &str| fact.parameters.iter().find(|(p, _)| p.name == name);
    let estimate = |p: &'static xt28_sim::effects::Parameter| {
        // Another plant's number may be of another quantity: then from one tolerance off neutral.
        let value = known(p.name).map_or(p.neutral + p.tolerance, |(_, value)| *value);
        Estimate { name: p.name, value: [value; 3] }
    };
    Some(Cause {
        effect,
        scope: fact.scope,
        scopes: vec![(fact.scope, 1.0)],
        values: Vec::new(),
        probability: 1.0,
        parameters: effect.parameters.iter().map(estimate).collect(),
        class: vec![effect.name],
        begins: Beginning::of(onset),
        shrink: None,
    })
}

/// When it sets in, in every run or in one of those of `inquiry`.
fn onset(fact: &Fact, truth: &Truth, inquiry: &Inquiry) -> Result<Onset, CheckError> {
    let Some(name) = &fact.start_run else { return Ok(Onset::in_every_run(fact.start_s)) };
    match inquiry.runs.iter().find(|run| run.file() == *name) {
        Some(run) => Ok(Onset::once(run.signals.began_s + fact.start_s)),
        None => Err(CheckError::NoRun { case: truth.case.clone(), run: name.clone() }),
    }
}
