//! The verdict in one sentence, no surer than the logs make it.

use xt28_sim::effects::Scope;

use super::words::{by_share, capitalised, on, percent};
use crate::diagnosis::{Cause, Diagnosis, Spot, Verdict};

/// How likely, beside the likeliest, other wheels have to be to be in the headline.
const SAID_ABOVE: f64 = 0.25;
/// How likely another answer has to be to be told beside the verdict.
pub(super) const BESIDE_ABOVE: f64 = 0.25;
/// How many floors a gap has to be to be told beside one that nothing explains.
const LARGER: f64 = 5.0;

/// The verdict in one sentence.
#[must_use]
pub fn headline(diagnosis: &Diagnosis) -> String {
    let other = beside(diagnosis);
    let said = match diagnosis.verdict {
        Verdict::Effect => {
            let each: Vec<String> = diagnosis.stood_by().map(cause).collect();
            if each.is_empty() {
                return undecided(diagnosis);
            }
            each.join(", and ")
        }
        Verdict::None => nothing(diagnosis, true),
        Verdict::Unknown => unknown(diagnosis, other.is_some()),
    };
    let beside = match (diagnosis.verdict, diagnosis.not_testable.len()) {
        (Verdict::None, untested @ 1..) => format!("; effects that they cannot: {untested}"),
        (Verdict::Unknown, _) => larger(diagnosis).unwrap_or_default(),
        _ => String::new(),
    };
    match other {
        Some(other) => format!("{said}, or {other}: these logs do not tell which{beside}."),
        None => format!("{said}{beside}."),
    }
}

/// Whether another answer is too likely to go unsaid.
pub(super) fn is_open(diagnosis: &Diagnosis) -> bool {
    beside(diagnosis).is_some()
}

/// The likeliest answer beside the verdict, where that is not sure.
fn beside(diagnosis: &Diagnosis) -> Option<String> {
    let verdict = diagnosis.verdict;
    let (none, strange) = (diagnosis.probability_none, diagnosis.probability_unknown);
    let named = diagnosis.causes.first().filter(|_| verdict != Verdict::Effect);
    let others = [
        named.map(|named| (named.probability, cause(named))),
        (verdict != Verdict::None).then(|| (none, nothing(diagnosis, false))),
        (verdict != Verdict::Unknown).then(|| (strange, unknown(diagnosis, true))),
    ];
    let likeliest = others.into_iter().flatten().max_by(|(a, _), (b, _)| a.total_cmp(b));
    let (_, words) = likeliest.filter(|(probability, _)| *probability > BESIDE_ABOVE)?;
    // In the middle of a sentence, unless it begins with an effect's name, which is small anyway.
    Some(words.replacen("Nothing", "nothing", 1).replacen("Something", "something", 1))
}

/// Nothing is the matter, as far as the logs go; with `limits`, whether they go all the way.
fn nothing(diagnosis: &Diagnosis, limits: bool) -> String {
    let limits = limits && !diagnosis.not_testable.is_empty();
    let within = if limits { " in what these logs can show" } else { "" };
    let sure = percent(diagnosis.probability_none);
    format!("Nothing beyond ordinary tolerances{within} (probability {sure})")
}

fn unknown(diagnosis: &Diagnosis, perhaps: bool) -> String {
    let verb = if perhaps { "may be" } else { "is" };
    let place = spot(diagnosis).map_or_else(String::new, |spot| format!(", foremost in {spot}"));
    format!(
        "Something {verb} the matter that no effect of the catalogue explains{place} (probability {})",
        percent(diagnosis.probability_unknown)
    )
}

/// A gap far larger than that of the signal that nothing known explains: who looks for the fault would look
/// past it.
fn larger(diagnosis: &Diagnosis) -> Option<String> {
    let (strange, place) = (diagnosis.unexplained.as_ref()?, diagnosis.places.first()?);
    let is_larger = place.spot != *strange && place.gap_over_noise > LARGER;
    let best = diagnosis.causes.first().map(|cause| cause.effect.name);
    let best = best.map_or_else(String::new, |name| format!("; {name} fits best"));
    is_larger.then(|| {
        let gap = place.gap_over_noise;
        format!("; the largest gap, {gap:.0} floors, is in {}{best}", of_wheels(&place.spot))
    })
}

/// The signal that nothing known explains: the one that speaks against the best of the catalogue, else
/// the one that parts most.
pub(super) fn spot(diagnosis: &Diagnosis) -> Option<String> {
    spot_of(diagnosis).map(of_wheels)
}

pub(super) fn spot_of(diagnosis: &Diagnosis) -> Option<&Spot> {
    let largest = diagnosis.places.first().map(|place| &place.spot);
    diagnosis.unexplained.as_ref().or(largest)
}

fn of_wheels(spot: &Spot) -> String {
    let wheels = if spot.has_wheels() { format!(" ({})", on(spot.scope)) } else { String::new() };
    format!("{}{wheels}", spot.residual)
}

/// The verdict in a clause that one reads at a glance; what it leaves out is in the headline.
pub(super) fn clause(diagnosis: &Diagnosis) -> String {
    let said = match diagnosis.verdict {
        Verdict::Effect if diagnosis.stood_by().next().is_none() => {
            return "Something parts from the simulator, and these logs do not tell what"
                .to_owned();
        }
        Verdict::Effect => stood(diagnosis),
        Verdict::None if diagnosis.not_testable.is_empty() => {
            "nothing beyond ordinary tolerances".to_owned()
        }
        Verdict::None => {
            "nothing beyond ordinary tolerances in what these logs can show".to_owned()
        }
        Verdict::Unknown => {
            let spot = spot(diagnosis);
            let place = spot.map_or_else(String::new, |spot| format!(", foremost in {spot}"));
            format!("something that no known effect explains{place}")
        }
    };
    match diagnosis.verdict {
        _ if is_open(diagnosis) => format!("Perhaps {said}"),
        // It begins with the effect's name, which is small anyway.
        Verdict::Effect => said,
        Verdict::None | Verdict::Unknown => capitalised(&said),
    }
}

/// The causes stood by, each with its wheels where these are one answer.
fn stood(diagnosis: &Diagnosis) -> String {
    let mut is_in_doubt = false;
    let mut each = Vec::new();
    for cause in diagnosis.stood_by() {
        let name = cause.effect.name;
        each.push(match &told_scopes(cause)[..] {
            _ if !cause.effect.has_scope() => name.to_owned(),
            [] => format!("{name} at {}", on(cause.scope)),
            [one] => format!("{name} at {}", on(*one)),
            _ => {
                is_in_doubt = true;
                name.to_owned()
            }
        });
    }
    let doubt = if is_in_doubt { ", wheels not told apart" } else { "" };
    format!("{}{doubt}", each.join(" and "))
}

/// Something is wrong, and nothing is likelier than not.
fn undecided(diagnosis: &Diagnosis) -> String {
    let likeliest: Vec<String> = diagnosis.causes.iter().take(2).map(cause).collect();
    format!(
        "Something parts from the simulator, and these logs do not tell what: {}, nothing beyond ordinary \
         tolerances (probability {}), something that no effect of the catalogue explains (probability {}).",
        likeliest.join(", "),
        percent(diagnosis.probability_none),
        percent(diagnosis.probability_unknown)
    )
}

/// The wheels that are likely enough to be told of a cause, the likeliest first.
pub(super) fn told_scopes(cause: &Cause) -> Vec<Scope> {
    let scopes = by_share(cause);
    let likely = scopes.first().map_or(1.0, |(_, share)| *share);
    let told = scopes.into_iter().filter(|(_, share)| *share > SAID_ABOVE * likely);
    told.map(|(scope, _)| scope).collect()
}

/// An effect with its wheels and probability.
fn cause(cause: &Cause) -> String {
    let told: Vec<String> = told_scopes(cause).into_iter().map(on).collect();
    let whose = match &told[..] {
        _ if !cause.effect.has_scope() => String::new(),
        [] => format!(" at {}", on(cause.scope)),
        [one] => format!(" at {one}"),
        [one, other] => format!(" at {one} or {other}"),
        [first, ..] => format!(" at wheels that these logs do not tell apart, {first} foremost"),
    };
    format!("{}{whose} (probability {})", cause.effect.name, percent(cause.probability))
}
