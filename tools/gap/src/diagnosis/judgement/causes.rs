//! How likely each cause is, at which wheels, and which others look like it.

use std::collections::BTreeMap;

use super::Findings;
use crate::diagnosis::beginning::Beginning;
use crate::diagnosis::candidate::Candidate;
use crate::diagnosis::hypothesis::Hypothesis;
use crate::diagnosis::scales::turned;
use crate::diagnosis::verdict::{Cause, Estimate};

/// Evidence of a second cause beside the first at which it and nothing are as likely, nats, and how
/// sharply that turns; and the share of the first's evidence by which that rises where another law of
/// the first could explain all of the second's: what a large cause leaves, another law takes for a
/// second one.
const SECOND: [f64; 2] = [20.0, 5.0];
const SECOND_SHARE: f64 = 0.08;
/// Share of the best evidence, nats, by which evidence is taken to be uncertain.
const TEMPERATURE_SHARE: f64 = 0.03;
/// Effects this much less likely than the best, as a factor, are in its class.
const CLASS: f64 = 0.2;
/// Share of a cause's probability below which wheels that it may be at are not told.
const ELSEWHERE: f64 = 0.05;
/// Causes that are listed.
const LISTED: usize = 10;

/// Causes with their probabilities, which come to `known` for what may be first.
///
/// Where a second cause may be there, what may be first is weighed twice: beside the second, and as if it were not
/// there, each by how likely that is.
pub(super) fn causes(findings: &Findings, known: f64) -> Vec<Cause> {
    let alone = odds(&findings.single.iter().collect::<Vec<_>>());
    let mut causes = match findings.pair.first() {
        None => told(&alone, known),
        Some([first, second]) => {
            let is_there = is_second(second, findings.evidence());
            let beside = odds(&firsts(findings, first));
            let mut causes = told(&mixed([beside, alone], is_there), known);
            let seconds: Vec<_> = findings.pair.iter().map(|[_, second]| second).collect();
            let seconds = told(&odds(&seconds), known * is_there);
            seconds.into_iter().for_each(|cause| join(&mut causes, cause, known));
            causes
        }
    };
    causes.sort_by(|a, b| b.probability.total_cmp(&a.probability));
    causes.truncate(LISTED);
    causes
}

/// What may be first beside the second: as it was found there or, where it was not sought beside this one, `first`
/// and its other wheels as they were found alone.
fn firsts<'a>(findings: &'a Findings, first: &'a Candidate) -> Vec<&'a Candidate> {
    let Hypothesis { effect, scope } = first.fit.hypothesis;
    let is_elsewhere =
        |c: &&Candidate| c.fit.hypothesis.effect == effect && c.fit.hypothesis.scope != scope;
    match &findings.firsts[..] {
        [] => std::iter::once(first).chain(findings.single.iter().filter(is_elsewhere)).collect(),
        again => again.iter().collect(),
    }
}

/// Candidates with the share of a probability that each has.
type Odds<'a> = Vec<(&'a Candidate, f64)>;

/// How a probability is shared among `rank`.
fn odds<'a>(rank: &[&'a Candidate]) -> Odds<'a> {
    let best = rank.iter().map(|c| c.score()).fold(f64::NEG_INFINITY, f64::max);
    let temperature = temperature(best);
    let weight = |c: &Candidate| ((c.score() - best) / temperature).exp();
    let total: f64 = rank.iter().map(|c| weight(c)).sum();
    rank.iter().map(|c| (*c, weight(c) / total)).collect()
}

/// Odds that are the former with this probability, and the latter else; a hypothesis of both is as in the former.
fn mixed<'a>([former, latter]: [Odds<'a>; 2], is_former: f64) -> Odds<'a> {
    let mut all: Odds<'a> = former.into_iter().map(|(c, share)| (c, share * is_former)).collect();
    for (candidate, share) in latter {
        let share = share * (1.0 - is_former);
        match all.iter_mut().find(|(c, _)| c.fit.hypothesis == candidate.fit.hypothesis) {
            Some((_, known)) => *known += share,
            None => all.push((candidate, share)),
        }
    }
    all
}

/// Adds `cause` to `causes`: one that is there already, as the first or as the second, is there either way, and no
/// likelier than `known`.
fn join(causes: &mut Vec<Cause>, cause: Cause, known: f64) {
    let Some(there) = causes.iter_mut().find(|there| there.effect == cause.effect) else {
        causes.push(cause);
        return;
    };
    let probability = (there.probability + cause.probability).min(known);
    if cause.probability > there.probability {
        *there = cause;
    }
    there.probability = probability;
}

/// Probability that a second cause is there beside a first of so many nats.
fn is_second(second: &Candidate, first_nats: f64) -> f64 {
    let shared = SECOND_SHARE * (1.0 - second.own_share) * first_nats;
    turned(second.second_score(), [SECOND[0] + shared, SECOND[1]])
}

/// By what evidence is divided before it is odds, where the best has so many nats.
pub(in crate::diagnosis) fn temperature(best_nats: f64) -> f64 {
    1.0 + TEMPERATURE_SHARE * best_nats.max(0.0)
}

/// One cause for each effect, at its likeliest scope, with the probability of all its scopes: `known` is shared as
/// the odds say.
fn told(odds: &Odds<'_>, known: f64) -> Vec<Cause> {
    let mut of: BTreeMap<&'static str, Odds<'_>> = BTreeMap::new();
    for (candidate, share) in odds {
        of.entry(candidate.name()).or_default().push((*candidate, *share));
    }
    // Of two that are as likely, the one that came first.
    of.values_mut().for_each(|at| at.sort_by(|(_, a), (_, b)| b.total_cmp(a)));
    let weights: Vec<(&'static str, f64)> =
        of.iter().map(|(name, at)| (*name, at.iter().map(|(_, share)| share).sum())).collect();
    let cause = |(at, (name, weight)): (&Odds<'_>, &(&'static str, f64))| {
        let fit = &at[0].0.fit;
        Cause {
            effect: fit.hypothesis.effect,
            scope: fit.hypothesis.scope,
            scopes: scopes(at, *weight).map(|(c, share)| (c.fit.hypothesis.scope, share)).collect(),
            values: scopes(at, *weight).map(|(c, _)| c.fit.values.clone()).collect(),
            probability: known * weight,
            parameters: estimates(at[0].0),
            class: class(name, *weight, &weights),
            begins: Beginning::of(fit.onset),
            shrink: None,
        }
    };
    of.values().zip(&weights).map(cause).collect()
}

/// A cause at each of the wheels that it may be at, of odds that come to `total`, the likeliest first.
fn scopes<'a>(at: &'a Odds<'a>, total: f64) -> impl Iterator<Item = (&'a Candidate, f64)> {
    let share = move |(c, share): &(&'a Candidate, f64)| (*c, share / total);
    let (first, others) = (at.iter().take(1).map(share), at.iter().skip(1).map(share));
    first.chain(others.filter(|(_, share)| *share > ELSEWHERE))
}

/// Effects about as likely as `name`, itself first.
fn class(name: &'static str, weight: f64, of: &[(&'static str, f64)]) -> Vec<&'static str> {
    let near = |other: f64| other > CLASS * weight && weight > CLASS * other;
    let others = of.iter().filter(|(other, at)| *other != name && near(*at));
    std::iter::once(name).chain(others.map(|(other, _)| *other)).collect()
}

fn estimates(candidate: &Candidate) -> Vec<Estimate> {
    let fit = &candidate.fit;
    let effect = fit.hypothesis.effect;
    let parameters = effect.parameters.iter().zip(fit.values.iter().zip(&fit.sigma));
    parameters.map(|(p, (value, sigma))| Estimate::new(effect, p, *value, *sigma)).collect()
}

#[cfg(test)]
mod tests {
    use xt28_machine::{Axle, Side};
    use xt28_sim::effects::Scope;

    use super::*;

    #[test]
    fn wheels_that_the_logs_cannot_part_share_the_probability() {
        let all = [
            Candidate::made_up("rolling-resistance", Scope::All, 100.0),
            Candidate::made_up("rolling-resistance", Scope::Side(Side::Left), 99.0),
            Candidate::made_up("rolling-resistance", Scope::Axle(Axle::Rear), 40.0),
        ];
        let causes = told(&odds(&all.each_ref()), 1.0);
        let [cause] = &causes[..] else { panic!("one effect, one cause") };
        assert!((cause.probability - 1.0).abs() < 1e-12);
        let [(Scope::All, all), (Scope::Side(Side::Left), left)] = cause.scopes[..] else {
            panic!("{:?}", cause.scopes)
        };
        assert!(all > left && left > 0.4 && (all + left - 1.0).abs() < 1e-6, "{all} {left}");
    }

    #[test]
    fn a_first_cause_that_moved_beside_the_second_is_at_each_scope_once() {
        let of = |scope, score| Candidate::made_up("rolling-resistance", scope, score);
        let left = Scope::Side(Side::Left);
        let second = Candidate::made_up("payload", Scope::All, 80.0);
        let findings = Findings {
            single: vec![of(Scope::All, 100.0), of(left, 99.0)],
            pair: vec![[of(left, 99.0), second]],
            ..Findings::default()
        };
        let causes = causes(&findings, 1.0);
        let first = causes.iter().find(|cause| cause.effect.name == "rolling-resistance").unwrap();
        let mut scopes: Vec<String> = first.scopes.iter().map(|(s, _)| s.to_string()).collect();
        scopes.sort();
        assert_eq!(scopes, ["all", "left"]);
    }

    /// What the logs say of two that look alike does not change for a second that is hardly there, and is what they
    /// say beside it where it is.
    #[test]
    fn rivals_of_the_first_stay_as_likely_as_the_second_leaves_them() {
        let of = |name: &str, score| Candidate::made_up(name, Scope::All, score);
        let told = |second: f64| {
            let findings = Findings {
                single: vec![of("arm-delay", 80.0), of("valve-lag", 79.0)],
                pair: vec![[of("arm-delay", 80.0), of("payload", second)]],
                firsts: vec![of("arm-delay", 120.0), of("valve-lag", 60.0)],
                ..Findings::default()
            };
            let causes = causes(&findings, 1.0);
            let of = |name| causes.iter().find(|cause| cause.effect.name == name);
            let [first, rival] = ["arm-delay", "valve-lag"].map(of).map(Option::unwrap);
            (first.probability, rival.probability, first.class.clone())
        };
        let (first, rival, class) = told(13.0);
        assert!((0.5..0.7).contains(&first) && rival > 0.3, "{first} {rival}");
        assert_eq!(class, ["arm-delay", "valve-lag"]);
        let (first, rival, class) = told(60.0);
        assert!(first > 0.99 && rival < 0.01, "{first} {rival}");
        assert_eq!(class, ["arm-delay"]);
    }

    #[test]
    fn an_effect_that_may_be_first_or_second_is_one_cause() {
        let of = |name: &str, score| Candidate::made_up(name, Scope::All, score);
        let findings = Findings {
            single: vec![of("arm-delay", 80.0), of("payload", 79.0)],
            pair: vec![[of("arm-delay", 80.0), of("payload", 20.0)]],
            firsts: vec![of("arm-delay", 90.0)],
            ..Findings::default()
        };
        let causes = causes(&findings, 1.0);
        assert_eq!(causes.len(), 2);
        assert!(
            causes.iter().all(|cause| cause.probability.is_finite() && cause.probability <= 1.0)
        );
    }

    #[test]
    fn a_second_cause_has_to_foretell_what_it_explains() {
        let second = |held, most| Candidate {
            held_gain: Some(held),
            held_most: most,
            ..Candidate::made_up("pressure-bias", Scope::All, 35.0)
        };
        assert!(is_second(&second(2.0, 12.0), 110.0) < 0.5);
        assert!(is_second(&second(12.0, 12.0), 110.0) > 0.9);
        // Motors that hold at a standstill, where the machine of the runs held out never stands.
        assert!(is_second(&second(-0.5, 0.2), 110.0) > 0.8);
    }
}
