//! Whether intervals hold the truth as often as they say.

use xt28_gap::diagnosis::Cause;

use crate::examination::Judged;

/// For every number of a true effect that was named and estimated: whether its 90 % interval holds it.
///
/// The cause is the likeliest of that effect, at whatever scope; numbers that the catalogue measures
/// otherwise than the answer are left out.
#[must_use]
pub(crate) fn covered(judged: &Judged) -> Vec<bool> {
    let mut covered = Vec::new();
    for fact in &judged.truth.facts {
        let of_effect = |cause: &&Cause| Some(cause.effect) == fact.effect;
        let Some(cause) = judged.examined.diagnosis.causes.iter().find(of_effect) else { continue };
        for (parameter, value) in &fact.parameters {
            let estimate = cause.parameters.iter().find(|e| e.name == parameter.name);
            covered.extend(estimate.map(|e| (e.value[1]..=e.value[2]).contains(value)));
        }
    }
    covered
}
