//! What the runs that were fitted cannot show, and what is then not said of it.

use xt28_sim::effects::Effect;

use crate::diagnosis::excitation::Shown;
use crate::diagnosis::inquiry::{FieldRun, Inquiry};
use crate::diagnosis::verdict::{Diagnosis, NotTestable};

/// Fills in the effects that stay in the dark, but for those stood by, which have been tested; of causes among
/// them no size is told, as it rests on runs that were held out or on nothing.
pub(super) fn tell_untested(diagnosis: &mut Diagnosis, inquiry: &Inquiry) {
    let of = |runs: &[&FieldRun]| Shown::of(runs.iter().map(|run| &run.signals), &inquiry.machine);
    let (fitted, held): (Vec<&FieldRun>, Vec<&FieldRun>) =
        inquiry.runs.iter().partition(|run| run.fit);
    let shown = of(&fitted);
    let is_driven = |name: &str| fitted.iter().any(|run| run.is_of_drive(name));
    let mut all = shown.not_testable_in(&inquiry.catalogue, is_driven);
    let stood: Vec<&Effect> = diagnosis.stood_by().map(|cause| cause.effect).collect();
    all.retain(|one| !stood.contains(&one.effect));
    if !all.is_empty() {
        let each: Vec<(String, Shown)> =
            held.iter().map(|run| (run.file(), shown.with(&of(&[run])))).collect();
        all.iter_mut().for_each(|one| one.fit = to_fit(one, &each, || shown.with(&of(&held))));
    }
    for cause in &mut diagnosis.causes {
        let is_dark = all.iter().any(|one| one.effect == cause.effect);
        if is_dark && !shown.tests(cause.effect, cause.scope) {
            let parameters = cause.parameters.iter().zip(cause.effect.parameters);
            cause.parameters = parameters.map(|(one, of)| one.untold(of)).collect();
        }
    }
    diagnosis.not_testable = all;
}

/// The first of the runs held out that has what is lacking, or all of them where they have it together.
fn to_fit(
    one: &NotTestable,
    each: &[(String, Shown)],
    together: impl Fn() -> Shown,
) -> Vec<String> {
    let shows = |shown: &Shown| shown.tests_everywhere(one.effect);
    if let Some((run, _)) = each.iter().find(|(_, shown)| shows(shown)) {
        return vec![run.clone()];
    }
    let are_enough = each.len() > 1 && shows(&together());
    if are_enough { each.iter().map(|(run, _)| run.clone()).collect() } else { Vec::new() }
}
