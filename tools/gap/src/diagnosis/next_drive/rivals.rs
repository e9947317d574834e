//! The causes that another drive is to tell apart.

use xt28_sim::Effects;
use xt28_sim::effects::Scope;

use crate::diagnosis::belief::Belief;
use crate::diagnosis::generator::Generator;
use crate::diagnosis::hypothesis::Hypothesis;
use crate::diagnosis::inquiry::Inquiry;
use crate::diagnosis::onset::Onset;
use crate::diagnosis::verdict::{Cause, Diagnosis, WORTH_TELLING};

/// Causes, or wheels of one, that are told apart, at most.
const RIVALS: usize = 3;
/// Beyond this probability an answer has no rivals worth a drive.
const SURE: f64 = 0.95;

/// What a belief costs, and the generators that can differ from the base under it.
pub(super) type Cost<'c> = dyn Fn(Belief<'_>, &dyn Fn(Generator) -> bool) -> f64 + 'c;

/// A hypothesis in the running; without a cause it is that nothing else is there.
pub(super) struct Rival {
    /// What people are told of it.
    pub(super) name: String,
    /// All that is believed with it.
    pub(super) effects: Effects,
    cause: Option<(Hypothesis, Vec<f64>)>,
    /// When it begins in the runs driven.
    onset: Onset,
}

/// A cause at some wheels, and how likely it is to be there.
struct CauseAt<'a> {
    cause: &'a Cause,
    scope: Scope,
    values: Vec<f64>,
    probability: f64,
}

/// The least certain of the causes stood by, or the likeliest of all, at each of the wheels that it may be at, and
/// what may be in its place; the other causes stood by are believed. Fewer than two where nothing is left to
/// tell apart.
pub(super) fn rivals(inquiry: &Inquiry, diagnosis: &Diagnosis) -> (Effects, Vec<Rival>) {
    let mut base = inquiry.believed.clone();
    let stood: Vec<&Cause> = diagnosis.stood_by().collect();
    let Some(leader) = stood.last().copied().or_else(|| diagnosis.causes.first()) else {
        return (base, Vec::new());
    };
    let wheels = leader.scopes.first().map_or(1.0, |(_, share)| *share);
    // What shows in nothing is no rival: no drive is known to show it.
    let none = diagnosis.probability_none + diagnosis.probability_unseen;
    if leader.probability * wheels > SURE || none > SURE {
        return (base, Vec::new());
    }
    for other in stood.iter().filter(|cause| cause.effect != leader.effect) {
        CauseAt::likeliest(other).apply(&mut base);
    }
    let others = diagnosis.causes.iter().filter(|cause| {
        let stands = stood.iter().any(|stood| stood.effect == cause.effect);
        !stands && cause.effect != leader.effect
    });
    let mut places = CauseAt::all(leader);
    places.extend(others.map(CauseAt::likeliest));
    places.retain(|place| place.probability >= WORTH_TELLING);
    places.sort_by(|a, b| b.probability.total_cmp(&a.probability));
    places.truncate(RIVALS);
    let mut rivals: Vec<Rival> = places.iter().map(|place| place.rival(&base, &places)).collect();
    if diagnosis.probability_none >= WORTH_TELLING {
        let effects = base.clone();
        rivals.push(Rival { name: "none".to_owned(), effects, cause: None, onset: Onset::ALWAYS });
    }
    (base, rivals)
}

impl<'a> CauseAt<'a> {
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
        let hypothesis = Hypothesis { effect: self.cause.effect, scope: self.scope };
        let onset = self.cause.onset();
        Rival { name, effects, cause: Some((hypothesis, self.values.clone())), onset }
    }
}

impl Rival {
    /// It, as a belief on the runs driven.
    pub(super) fn belief(&self) -> Belief<'_> {
        Belief { onset: self.onset, ..(&self.effects).into() }
    }

    /// The least that `cost` makes of it beside `base`, with what one has to believe for its parameters.
    pub(super) fn least(&self, base: &Effects, cost: &Cost<'_>) -> f64 {
        let Some((hypothesis, values)) = &self.cause else {
            return cost(base.into(), &|_| false);
        };
        let Hypothesis { effect, scope } = *hypothesis;
        let only = |generator: Generator| generator.hears(effect, scope);
        let of = |values: &[f64]| {
            let effects = &hypothesis.applied(base, values);
            cost(Belief { onset: self.onset, ..effects.into() }, &only)
        };
        hypothesis.least(&of, values)
    }
}
