//! What was taken for granted, what would settle it, what is wrong with the logs.

use super::ahead::{after_that, how_well, purpose};
use super::svg::escape;
use super::words::capitalised;
use crate::diagnosis::{Details, Diagnosis, Knob};

/// Faults of logs listed.
const FAULTS: usize = 12;

/// What was assumed.
pub(super) fn assumed(diagnosis: &Diagnosis, details: &Details) -> String {
    let mut items = vec![
        format!("The machine file holds but for ordinary tolerances: {}.", tolerances()),
        format!(
            "Every effect of the catalogue but those of the bus may be there a little on a sound machine: \
             {} numbers, wheel by wheel, each by a share of its tolerance (`xt28 effects NAME` has the \
             parameters of each). What they explain together is no cause.",
            Knob::all().len() - Knob::tolerances().len()
        ),
        "The ECUs' laws, gains and filters are those of the paper, unless an effect says otherwise."
            .to_owned(),
        "At most two effects are there at once, each alike on all wheels of one scope.".to_owned(),
        "An effect is there all along, from one instant on that is the same in every run, told from each run's \
         start, or from one instant of the day on, for good: none goes again."
            .to_owned(),
    ];
    // Those have a place of their own.
    let told = [&details.faults, &diagnosis.unshrunk()].map(Clone::clone).concat();
    let notes = diagnosis.notes.iter().filter(|note| !told.contains(note));
    items.extend(notes.cloned());
    list(&items)
}

/// What may differ from machine to machine without being an effect, each by a standard deviation.
fn tolerances() -> String {
    let mut all: Vec<String> = Vec::new();
    for knob in Knob::tolerances() {
        let (name, sigma) = match knob {
            Knob::Machine(tolerance) => (tolerance.name.to_owned(), tolerance.sigma),
            // One a wheel, all alike.
            Knob::Effect(effect, ..) => (format!("{} of each arm", effect.name), knob.tolerance()),
        };
        let told = format!("{name} ±{:.0} %", sigma * 100.0);
        if !all.contains(&told) {
            all.push(told);
        }
    }
    all.join(", ")
}

/// What would settle it.
pub(super) fn settles(diagnosis: &Diagnosis) -> String {
    let mut items = Vec::new();
    if let Some(next) = &diagnosis.next {
        items.push(format!(
            "Drive {}: it {}{}.",
            next.manoeuvre,
            purpose(next, " and "),
            how_well(next)
        ));
        if !next.others.is_empty() {
            items.push(format!("{}.", after_that(next)));
        }
    } else if !diagnosis.looked_ahead {
        items.push("Which drive would tell causes apart was not asked.".to_owned());
    }
    items.extend(diagnosis.not_testable.iter().map(|one| {
        let how = if one.in_part { "is not tested at every wheel" } else { "cannot be tested" };
        format!("{} {how}: {}. {}.", one.effect.name, one.lacks, capitalised(&one.remedy()))
    }));
    if diagnosis.not_testable.is_empty() {
        items.push("Every effect of the catalogue is tested by these runs.".to_owned());
    }
    list(&items)
}

/// Faults of the logs.
pub(super) fn faults(details: &Details) -> String {
    let mut items: Vec<String> = details.faults.iter().take(FAULTS).cloned().collect();
    if details.faults.len() > FAULTS {
        items.push(format!("and {} more", details.faults.len() - FAULTS));
    }
    if items.is_empty() {
        items.push(
            "None: no log is cut, no clock steps, no message whose period the DBC tells is away for more than \
             one and a half of that, and no frame has another length or a value out of its range than the DBC \
             says. Frames that are late by less are no fault of a log: the bus is a block like others."
                .to_owned(),
        );
    }
    list(&items)
}

fn list(items: &[String]) -> String {
    let items: String = items.iter().map(|item| format!("<li>{}</li>", escape(item))).collect();
    format!("<ul>{items}</ul>")
}
