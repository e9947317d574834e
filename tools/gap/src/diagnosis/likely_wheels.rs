//! On which wheels the best cause is, where what it leaves tells and what it explains does not.
//!
//! Some blocks speak against an effect and not for it: what of a wheel's rolling resistance its arm feels is another
//! law on each make, so how the machine stands is no evidence of it. Its wheels are then as likely as one another by
//! what is explained; and the likeliest may leave what no right answer does, where others leave nothing.

use super::candidate::Candidate;
use super::judgement::{Findings, temperature};
use super::scales::Scales;

/// What is left over, as a judgement counts it, from which the best cause is more likely unknown than right.
const TOO_MUCH: f64 = Scales::IN_USE.unknown_times;
/// How many times what evidence is taken to be uncertain by others may be less likely, to be looked at.
const ALIKE: f64 = 2.0;
/// What is left over at most by one that is taken instead.
const LITTLE: f64 = 0.9;

/// What the logs say of the best of `single`, or of its effect on other wheels that are about as likely, where those
/// leave little and it leaves too much; `look` says it of each. Wheels of the effect on which it leaves too much are
/// no longer among the causes then.
pub(super) fn at_likely_wheels(
    single: Vec<Candidate>,
    look: &dyn Fn(&Candidate) -> Findings,
) -> Findings {
    let of = |candidate: &Candidate| {
        let alone = vec![candidate.clone()];
        Findings { single: alone, ..look(candidate) }
    };
    let best = of(&single[0]);
    if best.left_over() <= TOO_MUCH {
        return Findings { single, ..best };
    }
    // Another effect that explains more than these wheels would be told before them.
    let (is_its, score) = (|c: &&Candidate| c.name() == single[0].name(), single[0].score());
    let rival = single.iter().filter(|c| !is_its(c)).map(Candidate::score);
    let least = rival.fold(score - ALIKE * temperature(score), f64::max);
    let is_alike = |c: &&Candidate| is_its(c) && c.score() >= least;
    let looked: Vec<Findings> = single[1..].iter().filter(is_alike).map(of).collect();
    let leaves_least = looked.iter().min_by(|a, b| a.left_over().total_cmp(&b.left_over()));
    let Some(chosen) = leaves_least.filter(|least| least.left_over() < LITTLE) else {
        return Findings { single, ..best };
    };
    let is_of = |c: &Candidate, of: &Findings| c.fit.hypothesis == of.single[0].fit.hypothesis;
    let leaves_too_much = |c: &Candidate| {
        let mut all = looked.iter().chain([&best]);
        all.any(|of| is_of(c, of) && of.left_over() > TOO_MUCH)
    };
    let others = single.into_iter().filter(|c| !is_of(c, chosen) && !leaves_too_much(c));
    let single = chosen.single.iter().cloned().chain(others).collect();
    Findings { single, ..chosen.clone() }
}

#[cfg(test)]
mod tests {
    use xt28_machine::{Axle, Side, Wheel};
    use xt28_sim::effects::Scope;

    use super::super::evidence::Left;
    use super::super::floor::Signal;
    use super::super::generator::Generator;
    use super::super::judgement::SignalFindings;
    use super::*;

    /// What is said of `name` at each of these wheels, which is worth so many nats and leaves so much of the weight,
    /// as a square in floors.
    fn said(of: &[(&str, Scope, f64, f64)]) -> Findings {
        let single =
            of.iter().map(|(name, scope, nats, _)| Candidate::made_up(name, *scope, *nats));
        let square = |c: &Candidate| {
            let is = |(name, scope, ..): &&(&str, Scope, f64, f64)| {
                *name == c.name() && *scope == c.fit.hypothesis.scope
            };
            of.iter().find(is).map(|(.., square)| *square).unwrap()
        };
        at_likely_wheels(single.collect(), &|c| {
            let left = |square| Left::evenly(Generator::Stance, Signal::Weight, square, 100.0);
            let (unbent, after) = (left(40.0), left(square(c)));
            let signal = SignalFindings { unbent, alone: unbent, apart: unbent, after, echo: None };
            Findings { signals: vec![signal], ..Findings::default() }
        })
    }

    fn wheels(findings: &Findings) -> Vec<Scope> {
        findings.single.iter().map(|c| c.fit.hypothesis.scope).collect()
    }

    const ROLLS: &str = "rolling-resistance";
    const LEFT: Scope = Scope::Side(Side::Left);
    const FRONT: Scope = Scope::Axle(Axle::Front);
    const FR: Scope = Scope::Wheel(Wheel::Fr);

    #[test]
    fn wheels_that_leave_little_are_taken_for_ones_as_likely_that_leave_too_much() {
        let found = said(&[
            (ROLLS, Scope::All, 177.0, 30.0),
            (ROLLS, LEFT, 176.0, 25.0),
            (ROLLS, FRONT, 175.0, 0.3),
            ("drive-lag", Scope::All, 174.0, 30.0),
            (ROLLS, FR, 120.0, 0.2),
        ]);
        assert_eq!(wheels(&found), [FRONT, Scope::All, FR]);
        assert_eq!([found.single[1].name(), found.single[2].name()], ["drive-lag", ROLLS]);
        assert!(found.left_over() < LITTLE);
    }

    #[test]
    fn no_other_wheels_are_taken_where_nothing_is_left_or_they_are_less_likely_or_leave_much_too() {
        for [best, other] in [[(177.0, 0.8), (176.0, 0.1)], [(177.0, 30.0), (120.0, 0.3)]] {
            let found = said(&[(ROLLS, Scope::All, best.0, best.1), (ROLLS, FR, other.0, other.1)]);
            assert_eq!(wheels(&found), [Scope::All, FR]);
        }
        let found = said(&[(ROLLS, Scope::All, 177.0, 30.0), (ROLLS, FR, 176.0, 20.0)]);
        assert_eq!(wheels(&found), [Scope::All, FR]);
        assert!(found.left_over() > TOO_MUCH);
    }

    #[test]
    fn wheels_that_explain_less_than_another_effect_are_not_taken() {
        let lags = ("drive-lag", Scope::All, 176.0, 30.0);
        let found = said(&[(ROLLS, Scope::All, 177.0, 30.0), lags, (ROLLS, FR, 175.0, 0.3)]);
        assert_eq!(wheels(&found), [Scope::All, Scope::All, FR]);
    }

    #[test]
    fn another_effect_is_never_taken_for_what_it_leaves() {
        let found =
            said(&[(ROLLS, Scope::All, 177.0, 30.0), ("drive-lag", Scope::All, 176.5, 0.1)]);
        assert_eq!(found.single[0].name(), ROLLS);
        assert!(found.left_over() > TOO_MUCH);
    }
}
