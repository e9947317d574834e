//! The verdict in one sentence, no surer than the logs make it.

use super::words::{by_share, on, percent};
use crate::diagnosis::{Cause, Diagnosis, Spot, Verdict};

/// How likely, beside the likeliest, other wheels have to be to be in the headline.
const SAID_ABOVE: f64 = 0.25;
/// How likely another answer has to be to be told beside the verdict.
const BESIDE_ABOVE: f64 = 0.25;
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
    let largest = diagnosis.places.first().map(|place| &place.spot);
    diagnosis.unexplained.as_ref().or(largest).map(of_wheels)
}

fn of_wheels(spot: &Spot) -> String {
    let wheels = if spot.has_wheels() { format!(" ({})", on(spot.scope)) } else { String::new() };
    format!("{}{wheels}", spot.residual)
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

/// An effect with its wheels and probability.
fn cause(cause: &Cause) -> String {
    let scopes = by_share(cause);
    let likely = scopes.first().map_or(1.0, |(_, share)| *share);
    let told: Vec<String> = scopes
        .iter()
        .filter(|(_, share)| *share > SAID_ABOVE * likely)
        .map(|(scope, _)| on(*scope))
        .collect();
    let whose = match &told[..] {
        _ if !cause.effect.has_scope() => String::new(),
        [] => format!(" at {}", on(cause.scope)),
        [one] => format!(" at {one}"),
        [one, other] => format!(" at {one} or {other}"),
        [first, ..] => format!(" at wheels that these logs do not tell apart, {first} foremost"),
    };
    format!("{}{whose} (probability {})", cause.effect.name, percent(cause.probability))
}
