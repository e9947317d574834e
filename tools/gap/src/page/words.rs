//! Phrases that every form of a verdict shares.

use xt28_machine::{Axle, Side};
use xt28_sim::effects::Scope;

use crate::diagnosis::{Cause, Diagnosis, Estimate, Place, Shrink, Together, Verdict};

/// How likely, beside the likeliest, other wheels have to be to be in the headline.
const SAID_ABOVE: f64 = 0.25;

/// The verdict in one sentence.
#[must_use]
pub fn headline(diagnosis: &Diagnosis) -> String {
    match diagnosis.verdict {
        Verdict::Effect => {
            let each: Vec<String> = diagnosis.stood_by().map(cause).collect();
            if each.is_empty() { undecided(diagnosis) } else { format!("{}.", each.join(", and ")) }
        }
        Verdict::None => {
            let sure = percent(diagnosis.probability_none);
            match diagnosis.not_testable.len() {
                0 => format!("Nothing beyond ordinary tolerances (probability {sure})."),
                untested => format!(
                    "Nothing beyond ordinary tolerances in what these logs can show (probability {sure}); \
                     effects that they cannot: {untested}."
                ),
            }
        }
        Verdict::Unknown => {
            let place = diagnosis.places.first().map_or_else(String::new, |place| {
                let wheels = wheels_of(place).map_or(String::new(), |on| format!(" ({on})"));
                format!(", foremost in {}{wheels}", place.residual)
            });
            format!(
                "Something is the matter that no effect of the catalogue explains{place} (probability {}).",
                percent(diagnosis.probability_unknown)
            )
        }
    }
}

/// Something is wrong, and nothing is likelier than not.
fn undecided(diagnosis: &Diagnosis) -> String {
    let likeliest: Vec<String> = diagnosis.causes.iter().take(2).map(cause).collect();
    format!(
        "Something parts from the simulator, and these logs do not tell what: {}, nothing beyond ordinary \
         tolerances (probability {}).",
        likeliest.join(", "),
        percent(diagnosis.probability_none)
    )
}

/// The wheels of a place, in words; none where its block has none.
fn wheels_of(place: &Place) -> Option<String> {
    place.has_wheels().then(|| on(place.scope))
}

/// On which runs a shrink was told, after "the gap shrinks on".
pub(super) const fn judged_on(together: &Together) -> &'static str {
    if together.held_out_runs.is_empty() {
        "the runs that were fitted, as none was held out"
    } else {
        "runs that were not fitted"
    }
}

/// An effect with its wheels and probability.
fn cause(cause: &Cause) -> String {
    let likely = cause.scopes.first().map_or(1.0, |(_, share)| *share);
    let others: Vec<String> = cause
        .scopes
        .iter()
        .skip(1)
        .filter(|(_, share)| *share > SAID_ABOVE * likely)
        .map(|(scope, _)| on(*scope))
        .collect();
    let first = on(cause.scope);
    let whose = match &others[..] {
        _ if !cause.effect.has_scope() => String::new(),
        [] => format!(" at {first}"),
        [other] => format!(" at {first} or {other}"),
        _ => format!(" at wheels that these logs do not tell apart, {first} foremost"),
    };
    format!("{}{whose} (probability {})", cause.effect.name, percent(cause.probability))
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

/// All wheels that a cause may be at, each with its share of the probability.
pub(super) fn elsewhere(cause: &Cause) -> String {
    let each = |(scope, share): &(Scope, f64)| format!("{} ({})", on(*scope), percent(*share));
    cause.scopes.iter().map(each).collect::<Vec<_>>().join(", ")
}

/// A share of one in percent; never a certainty that a finite log cannot give.
pub(super) fn percent(share: f64) -> String {
    if share > 0.99 && share < 1.01 {
        "above 99 %".to_owned()
    } else if share > 0.0 && share < 0.01 {
        "below 1 %".to_owned()
    } else {
        format!("{:.0} %", share * 100.0)
    }
}

/// A share of a gap in percent; it may be negative.
pub(super) fn shrinks(share: f64) -> String {
    format!("{:.0} %", share * 100.0)
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

/// A parameter with its 90 % interval.
pub(super) fn estimate(one: &Estimate) -> String {
    let [best, low, high] = one.value.map(short);
    format!("{} = {best} ({low} to {high})", one.name)
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
        assert_eq!(percent(0.0), "0 %");
    }
}
