//! The scores: what was said of every case against what is so.

mod calibration;
mod curve;
mod rate;
mod suited;

use calibration::scope_statement;
pub use calibration::{
    Bin, Statement, calibration_error, error_by_chance, reliability, statements,
};
pub use curve::curve;
pub use rate::Score;
pub(crate) use rate::average;
pub use suited::{Outcome, Suited, suited};

use xt28_gap::diagnosis::Verdict;

use crate::reply::Reply;
use crate::truth::{Kind, Truth};

/// Share of cases with nothing unknown that may be called unknown.
const FALSE_UNKNOWN: f64 = 0.05;

/// Every score by the name it is printed under, in the order printed.
pub type Scores = Vec<(&'static str, Score)>;

/// All scores of one who replied. Each reply with the truth about its case.
#[must_use]
pub fn scores(cases: &[(&Truth, &Reply)]) -> Scores {
    let nameable: Vec<_> = cases.iter().filter(|(truth, _)| truth.is_nameable()).collect();
    let of_kind = |kind| cases.iter().filter(move |(truth, _)| truth.kind == kind);
    let all: Vec<Vec<Statement>> = cases.iter().map(|(t, r)| statements(t, r)).collect();
    let wheels: Vec<Vec<Statement>> =
        nameable.iter().map(|(t, r)| scope_statement(t, r).into_iter().collect()).collect();
    vec![
        ("top-1", Score::share(nameable.iter().map(|(t, r)| first(t, r, 1)))),
        (
            "top-1, or a class that holds it",
            Score::share(nameable.iter().map(|(t, r)| first_class(t, r))),
        ),
        ("top-3", Score::share(nameable.iter().map(|(t, r)| first(t, r, 3)))),
        ("effect and scope", Score::share(nameable.iter().map(|(t, r)| first_at(t, r)))),
        ("stood by, first and true", Score::share(nameable.iter().map(|(t, r)| stood_by(t, r)))),
        (
            "probability on the true cause",
            Score::mean(nameable.iter().filter_map(|(t, r)| probability(t, r))),
        ),
        (
            "null false alarms",
            Score::share(of_kind(Kind::Null).map(|(_, r)| r.verdict != Verdict::None)),
        ),
        (
            "effects passed over as none",
            Score::share(nameable.iter().map(|(_, r)| r.verdict == Verdict::None)),
        ),
        ("unknown recall at 5 % false", recall(cases)),
        (
            "unknown recall, own verdict",
            Score::share(of_kind(Kind::Unknown).map(|(_, r)| r.verdict == Verdict::Unknown)),
        ),
        (
            "unknown false, own verdict",
            Score::share(
                cases
                    .iter()
                    .filter(|(t, _)| t.kind != Kind::Unknown)
                    .map(|(_, r)| r.verdict == Verdict::Unknown),
            ),
        ),
        ("pairs, both stood by", Score::share(of_kind(Kind::Pair).map(|(t, r)| both(t, r, true)))),
        (
            "pairs, both in the first two",
            Score::share(of_kind(Kind::Pair).map(|(t, r)| both(t, r, false))),
        ),
        ("calibration error", Score::raised(&all, calibration_error)),
        ("calibration error of wheels", Score::raised(&wheels, calibration_error)),
    ]
}

/// Whether one of the first `places` causes is true.
fn first(truth: &Truth, reply: &Reply, places: usize) -> bool {
    reply.causes.iter().take(places).any(|cause| truth.has(cause.effect))
}

fn first_class(truth: &Truth, reply: &Reply) -> bool {
    reply.cause(0).is_some_and(|cause| {
        truth.has(cause.effect) || cause.like.iter().any(|effect| truth.has(effect))
    })
}

fn first_at(truth: &Truth, reply: &Reply) -> bool {
    reply.cause(0).is_some_and(|cause| truth.has_at(cause.effect, cause.scope))
}

fn stood_by(truth: &Truth, reply: &Reply) -> bool {
    reply.verdict == Verdict::Effect
        && reply.cause(0).is_some_and(|c| c.stands && truth.has(c.effect))
}

/// Mean over the true causes of a case.
fn probability(truth: &Truth, reply: &Reply) -> Option<f64> {
    let effects = truth.facts.iter().filter_map(|fact| fact.effect);
    let stated: Option<Vec<f64>> = effects.map(|effect| reply.probability_of(effect)).collect();
    stated.filter(|all| !all.is_empty()).map(|all| rate::average(&all))
}

fn both(truth: &Truth, reply: &Reply, stood_by: bool) -> bool {
    let told = |effect| {
        let mut two = reply.causes.iter().take(2);
        two.any(|cause| cause.effect == effect && (cause.stands || !stood_by))
    };
    (!stood_by || reply.verdict == Verdict::Effect)
        && truth.facts.iter().filter_map(|fact| fact.effect).all(told)
}

/// Share of unknown cases whose probability of being unknown is above a threshold that one in twenty
/// of the others passes.
#[allow(clippy::cast_precision_loss, clippy::cast_possible_truncation, clippy::cast_sign_loss)]
fn recall(cases: &[(&Truth, &Reply)]) -> Score {
    let stated = |is_unknown: bool| -> Vec<f64> {
        let those = cases.iter().filter(|(t, _)| (t.kind == Kind::Unknown) == is_unknown);
        those.filter_map(|(_, reply)| reply.unknown).collect()
    };
    let mut others = stated(false);
    others.sort_by(|a, b| b.total_cmp(a));
    let may_pass = (FALSE_UNKNOWN * others.len() as f64) as usize;
    let threshold = others.get(may_pass).copied().unwrap_or(0.0);
    let unknown = stated(true);
    if unknown.is_empty() {
        return Score::unsaid();
    }
    Score::share(unknown.into_iter().map(|stated| stated > threshold))
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use xt28_sim::effects::{Scope, find};

    use super::*;
    use crate::reply::Named;

    fn truth(kind: &str, effects: &[&str]) -> Truth {
        let facts =
            effects.iter().map(|e| format!("[[truth]]\neffect = \"{e}\"\nscope = \"front\"\n"));
        let text = format!("case = \"c\"\nkind = \"{kind}\"\n{}", facts.collect::<String>());
        Truth::parse(&text, Path::new("c.toml")).unwrap()
    }

    fn reply(verdict: Verdict, causes: &[(&str, &str, f64)], unknown: f64) -> Reply {
        let named = |&(effect, scope, p): &(&str, &str, f64)| Named {
            effect: find(effect).unwrap(),
            scope: scope.parse::<Scope>().unwrap(),
            scope_share: Some(0.9),
            probability: Some(p),
            stands: p > 0.5,
            like: Vec::new(),
        };
        let causes: Vec<Named> = causes.iter().map(named).collect();
        Reply { verdict, causes, none: Some(0.1), unknown: Some(unknown) }
    }

    fn value(of: &Scores, name: &str) -> f64 {
        of.iter().find(|(n, _)| *n == name).unwrap().1.value
    }

    #[test]
    fn a_right_name_at_the_wrong_scope_is_half_right() {
        let truth = truth("single", &["arm-delay"]);
        let reply =
            reply(Verdict::Effect, &[("arm-delay", "rear", 0.6), ("arm-delay", "front", 0.3)], 0.0);
        let scores = scores(&[(&truth, &reply)]);
        assert_eq!(value(&scores, "top-1"), 1.0);
        assert_eq!(value(&scores, "effect and scope"), 0.0);
        assert!((value(&scores, "calibration error of wheels") - 0.9).abs() < 1e-12);
        assert!((value(&scores, "probability on the true cause") - 0.9).abs() < 1e-12);
        assert!(value(&scores, "null false alarms").is_nan());
    }

    #[test]
    fn third_place_is_top_3_and_a_class_is_counted_apart() {
        let truth = truth("single", &["arm-delay"]);
        let mut third = reply(
            Verdict::Unknown,
            &[
                ("valve-lag", "front", 0.3),
                ("valve-gain", "front", 0.2),
                ("arm-delay", "front", 0.1),
            ],
            0.4,
        );
        third.causes[0].like = vec![find("arm-delay").unwrap()];
        let scores = scores(&[(&truth, &third)]);
        for (name, wanted) in [
            ("top-1", 0.0),
            ("top-1, or a class that holds it", 1.0),
            ("top-3", 1.0),
            ("stood by, first and true", 0.0),
            ("unknown false, own verdict", 1.0),
        ] {
            assert_eq!(value(&scores, name), wanted, "{name}");
        }
    }

    #[test]
    fn a_pair_needs_both() {
        let truth = truth("pair", &["arm-delay", "payload"]);
        let half =
            reply(Verdict::Effect, &[("payload", "all", 0.9), ("arm-delay", "front", 0.4)], 0.0);
        let whole =
            reply(Verdict::Effect, &[("payload", "all", 0.9), ("arm-delay", "rear", 0.7)], 0.0);
        let scores = scores(&[(&truth, &half), (&truth, &whole)]);
        assert_eq!(value(&scores, "pairs, both stood by"), 0.5);
        assert_eq!(value(&scores, "pairs, both in the first two"), 1.0);
        assert_eq!(value(&scores, "effect and scope"), 1.0, "payload has no wheel");
    }

    #[test]
    fn recall_is_at_the_threshold_that_one_in_twenty_of_the_others_passes() {
        let (strange, sound) = (truth("unknown", &["haunted-gearbox"]), truth("null", &[]));
        let others: Vec<Reply> =
            (0..20).map(|i| reply(Verdict::None, &[], f64::from(i) / 40.0)).collect();
        let found: Vec<Reply> =
            [0.1, 0.45, 0.46, 0.9].iter().map(|p| reply(Verdict::Unknown, &[], *p)).collect();
        let mut cases: Vec<_> = others.iter().map(|reply| (&sound, reply)).collect();
        cases.extend(found.iter().map(|reply| (&strange, reply)));
        // One of twenty passes above 0.45; three of four unknown ones would above 0.44.
        let scores = scores(&cases);
        assert_eq!(value(&scores, "unknown recall at 5 % false"), 0.5);
        assert_eq!(value(&scores, "unknown recall, own verdict"), 1.0);
        assert_eq!(value(&scores, "null false alarms"), 0.0);
    }
}
