//! How likely each cause is, at which wheels, and which others look like it.

use std::collections::BTreeMap;

use super::Findings;
use crate::diagnosis::candidates::Candidate;
use crate::diagnosis::scales::turned;
use crate::diagnosis::verdict::{Beginning, Cause, Estimate};

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

/// Causes with their probabilities; `known` is shared among those of one rank.
pub(super) fn causes(findings: &Findings, known: f64) -> Vec<Cause> {
    let ranks: Vec<Vec<&Candidate>> = match findings.pair.first() {
        None => vec![findings.single.iter().collect()],
        Some([first, _]) => {
            let name = first.fit.hypothesis.effect;
            // The first may have moved beside the second: it is listed as it is there.
            let at = first.fit.hypothesis.scope;
            let own = findings.single.iter().filter(|c| c.fit.hypothesis.effect == name);
            let elsewhere = own.filter(|c| c.fit.hypothesis.scope != at);
            let firsts = std::iter::once(first).chain(elsewhere).collect();
            vec![firsts, findings.pair.iter().map(|[_, second]| second).collect()]
        }
    };
    let rank = |(k, rank): (usize, &Vec<&Candidate>)| {
        let is_there = if k == 0 { 1.0 } else { is_second(rank[0], findings.evidence()) };
        shares(rank, known * is_there)
    };
    let mut causes: Vec<Cause> = ranks.iter().enumerate().flat_map(rank).collect();
    causes.sort_by(|a, b| b.probability.total_cmp(&a.probability));
    causes.truncate(LISTED);
    causes
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

/// One cause for each effect, at its best scope, with the probability of all its scopes: `known` is shared
/// among them.
fn shares(rank: &[&Candidate], known: f64) -> Vec<Cause> {
    let best = rank.first().map_or(0.0, |best| best.score());
    let temperature = temperature(best);
    let mut of: BTreeMap<&'static str, Vec<(f64, &Candidate)>> = BTreeMap::new();
    for candidate in rank {
        let weight = ((candidate.score() - best) / temperature).exp();
        of.entry(candidate.name()).or_default().push((weight, candidate));
    }
    let weights: Vec<(&'static str, f64)> =
        of.iter().map(|(name, at)| (*name, at.iter().map(|(weight, _)| weight).sum())).collect();
    let total: f64 = weights.iter().map(|(_, weight)| weight).sum();
    let cause = |(at, (name, weight)): (&Vec<(f64, &Candidate)>, &(&'static str, f64))| {
        let fit = &at[0].1.fit;
        Cause {
            effect: fit.hypothesis.effect,
            scope: fit.hypothesis.scope,
            scopes: scopes(at, *weight).map(|(c, share)| (c.fit.hypothesis.scope, share)).collect(),
            values: scopes(at, *weight).map(|(c, _)| c.fit.values.clone()).collect(),
            probability: known * weight / total,
            parameters: estimates(at[0].1),
            class: class(name, *weight, &weights),
            begins: (fit.from_s > 0.0)
                .then(|| Beginning { run: "every run".to_owned(), at_s: fit.from_s }),
            shrink: None,
        }
    };
    of.values().zip(&weights).map(cause).collect()
}

/// A cause at each of the wheels that it may be at, of candidates whose weights come to `total`, the likeliest first.
fn scopes<'a>(
    at: &'a [(f64, &Candidate)],
    total: f64,
) -> impl Iterator<Item = (&'a Candidate, f64)> {
    let share = move |(weight, c): &(f64, &'a Candidate)| (*c, weight / total);
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
        let [cause] = &shares(&all.each_ref(), 1.0)[..] else { panic!("one effect, one cause") };
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
