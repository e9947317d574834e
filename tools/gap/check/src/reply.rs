//! What someone says of a case, be it the diagnosis or a plain rule: the form that is scored.

use serde::Serialize;
use xt28_gap::diagnosis::{Cause, Diagnosis, Verdict};
use xt28_sim::effects::{Effect, Scope, find};

/// A verdict and causes, the likeliest first.
#[derive(Clone, Debug, Serialize)]
pub struct Reply {
    /// In one word.
    pub verdict: Verdict,
    /// Causes named, the likeliest first.
    pub causes: Vec<Named>,
    /// Probability that nothing is wrong; `None` from who states none.
    pub none: Option<f64>,
    /// Probability that something is wrong that is in no catalogue.
    pub unknown: Option<f64>,
}

/// One cause.
#[derive(Clone, Debug, Serialize)]
pub struct Named {
    /// The effect.
    #[serde(serialize_with = "name_of")]
    pub effect: &'static Effect,
    /// Its wheels.
    #[serde(serialize_with = "as_text")]
    pub scope: Scope,
    /// Share of its probability that is at these wheels; `None` from who states none.
    pub scope_share: Option<f64>,
    /// Its probability; `None` from who states none.
    pub probability: Option<f64>,
    /// Whether it is stood by.
    pub stands: bool,
    /// Effects that are said to look the same in these logs, beside itself.
    #[serde(skip_serializing_if = "Vec::is_empty", serialize_with = "names_of")]
    pub like: Vec<&'static Effect>,
}

impl Named {
    /// An effect named without a probability and not stood by.
    #[must_use]
    pub const fn without_probability(effect: &'static Effect, scope: Scope) -> Self {
        Self {
            effect,
            scope,
            scope_share: None,
            probability: None,
            stands: false,
            like: Vec::new(),
        }
    }
}

impl Reply {
    /// The `place`-th cause, from 0.
    #[must_use]
    pub fn cause(&self, place: usize) -> Option<&Named> {
        self.causes.get(place)
    }

    /// Probability that `effect` is at work, at any scope.
    #[must_use]
    pub fn probability_of(&self, effect: &Effect) -> Option<f64> {
        self.none?;
        let all = self.causes.iter().filter(|cause| cause.effect == effect);
        Some(all.filter_map(|cause| cause.probability).sum::<f64>().min(1.0))
    }
}

impl From<&Diagnosis> for Reply {
    fn from(diagnosis: &Diagnosis) -> Self {
        let named = |cause: &Cause| Named {
            effect: cause.effect,
            scope: cause.scope,
            scope_share: cause.scopes.first().map(|(_, share)| *share),
            probability: Some(cause.probability),
            stands: cause.stands(),
            like: cause
                .class
                .iter()
                .filter_map(|name| find(name))
                .filter(|e| *e != cause.effect)
                .collect(),
        };
        Self {
            verdict: diagnosis.verdict,
            causes: diagnosis.causes.iter().map(named).collect(),
            none: Some(diagnosis.probability_none),
            unknown: Some(diagnosis.probability_unknown),
        }
    }
}

#[allow(clippy::trivially_copy_pass_by_ref)] // The shape that serde asks for.
fn name_of<S: serde::Serializer>(effect: &&'static Effect, to: S) -> Result<S::Ok, S::Error> {
    to.serialize_str(effect.name)
}

fn names_of<S: serde::Serializer>(effects: &[&'static Effect], to: S) -> Result<S::Ok, S::Error> {
    to.collect_seq(effects.iter().map(|effect| effect.name))
}

fn as_text<S: serde::Serializer>(scope: &Scope, to: S) -> Result<S::Ok, S::Error> {
    to.serialize_str(&scope.to_string())
}
