//! Phrases that every form of a verdict shares.

use xt28_machine::{Axle, Side};
use xt28_sim::effects::Scope;

use crate::diagnosis::{Cause, Diagnosis, Shrink, WORTH_TELLING};

/// Wheels that a cause may be at of which each is told.
const ELSEWHERE: usize = 4;

/// The answers beside the causes, each with its probability.
pub(super) fn without_a_name(diagnosis: &Diagnosis) -> impl Iterator<Item = (f64, &'static str)> {
    let unseen = diagnosis.probability_unseen;
    [
        Some((diagnosis.probability_none, "nothing beyond ordinary tolerances")),
        Some((unseen, "an effect of which these logs show nothing"))
            .filter(|_| unseen >= WORTH_TELLING),
        Some((diagnosis.probability_unknown, "something that is not in the catalogue")),
    ]
    .into_iter()
    .flatten()
}

/// On which runs a shrink was told, after "the gap shrinks on".
pub(super) const fn judged_on(held_out_runs: &[String]) -> &'static str {
    if held_out_runs.is_empty() {
        "the runs that were fitted, as none was held out"
    } else {
        "runs that were not fitted"
    }
}

/// The wheels of a scope, in words.
pub(super) fn on(scope: Scope) -> String {
    match scope {
        Scope::All => "all wheels".to_owned(),
        Scope::Axle(Axle::Front) => "the front axle".to_owned(),
        Scope::Axle(Axle::Middle) => "the middle axle".to_owned(),
        Scope::Axle(Axle::Rear) => "the rear axle".to_owned(),
        Scope::Side(Side::Left) => "the left side".to_owned(),
        Scope::Side(Side::Right) => "the right side".to_owned(),
        Scope::Wheel(wheel) => format!("wheel {wheel}"),
    }
}

/// All wheels that a cause may be at, the likeliest first: its size is told at those that fit best, and
/// others may be likelier.
pub(super) fn by_share(cause: &Cause) -> Vec<(Scope, f64)> {
    let mut scopes = cause.scopes.clone();
    scopes.sort_by(|(_, a), (_, b)| b.total_cmp(a));
    scopes
}

/// The likeliest of the same, each with its share of the probability.
pub(super) fn elsewhere(cause: &Cause) -> String {
    let each = |(scope, share): (Scope, f64)| format!("{} ({})", on(scope), percent(share));
    let mut told: Vec<String> = by_share(cause).into_iter().map(each).collect();
    let left = told.len().saturating_sub(ELSEWHERE);
    if left > 1 {
        told.truncate(ELSEWHERE);
        told.push(format!("{left} others"));
    }
    told.join(", ")
}

/// Whether it is worth telling at which wheels a cause may be: not of one that is as good as ruled out.
pub(super) fn is_elsewhere(cause: &Cause) -> bool {
    cause.scopes.len() > 1 && cause.probability >= WORTH_TELLING
}

/// As at the beginning of a sentence.
pub(super) fn capitalised(words: &str) -> String {
    let mut letters = words.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

/// A share of one in percent; never a certainty that a finite log cannot give, for or against.
pub(super) fn percent(share: f64) -> String {
    if share > 0.99 && share < 1.01 {
        "above 99 %".to_owned()
    } else if share < 0.01 {
        "below 1 %".to_owned()
    } else {
        format!("{:.0} %", share * 100.0)
    }
}

/// A share of a gap in percent; it may be negative.
pub(super) fn shrinks(share: f64) -> String {
    // A whole number and zero: what is left of a negative share that rounds to none is no minus.
    format!("{:.0} %", (share * 100.0).round() + 0.0)
}

/// Three significant digits.
pub(super) fn short(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{value}");
    }
    // The decimal exponent of any f64 is within a few hundred of zero.
    #[allow(clippy::cast_possible_truncation)]
    let exponent = value.abs().log10().floor() as i32;
    if !(-4..=6).contains(&exponent) {
        return format!("{value:.2e}");
    }
    let decimals = usize::try_from(2 - exponent).unwrap_or(0);
    format!("{value:.decimals$}")
}

/// A shrink over its three horizons.
pub(super) fn shrink(shrink: &Shrink) -> String {
    let one = |share: f64, [low, high]: [f64; 2]| {
        format!("{} ({} to {})", shrinks(share), shrinks(low), shrinks(high))
    };
    format!(
        "{} one step ahead, {} over 5 s, {} over whole runs",
        one(shrink.one_step, shrink.interval[0]),
        one(shrink.five_s, shrink.interval[1]),
        one(shrink.run, shrink.interval[2])
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_keep_three_digits() {
        assert_eq!(short(0.21), "0.210");
        assert_eq!(short(-12.345), "-12.3");
        assert_eq!(short(41_234.0), "41234");
        assert_eq!(short(1.2e-7), "1.20e-7");
        assert_eq!(short(0.0), "0");
    }

    #[test]
    fn no_probability_is_said_to_be_one() {
        assert_eq!(percent(1.0), "above 99 %");
        assert_eq!(percent(0.93), "93 %");
        assert_eq!(percent(1e-6), "below 1 %");
        assert_eq!(percent(0.0), "below 1 %");
    }

    #[test]
    fn no_shrink_is_less_than_nothing_by_nothing() {
        assert_eq!(shrinks(-0.004), "0 %");
        assert_eq!(shrinks(-0.2), "-20 %");
    }
}
