//! What was taken for granted, what would settle it, what is wrong with the logs.

use super::svg::escape;
use crate::diagnosis::{Details, Diagnosis, TOLERANCES};

/// Faults of logs listed.
const FAULTS: usize = 12;

/// What was assumed.
pub(super) fn assumed(diagnosis: &Diagnosis, details: &Details) -> String {
    let tolerances: Vec<String> = TOLERANCES
        .iter()
        .map(|tolerance| format!("{} ±{:.0} %", tolerance.name, tolerance.sigma * 100.0))
        .collect();
    let mut items = vec![
        format!("The machine file holds but for ordinary tolerances: {}.", tolerances.join(", ")),
        "The ECUs' laws, gains and filters are those of the paper, unless an effect says otherwise."
            .to_owned(),
        "At most two effects are there at once, each alike on all wheels of one scope.".to_owned(),
    ];
    let notes = diagnosis.notes.iter().filter(|note| !details.faults.contains(note));
    items.extend(notes.cloned());
    list(&items)
}

/// What would settle it.
pub(super) fn settles(diagnosis: &Diagnosis) -> String {
    let mut items = Vec::new();
    if let Some(next) = &diagnosis.next {
        items.push(format!(
            "Drive {}: it tells {} apart, by {:.1} nats (odds of e to the {:.1}) expected.",
            next.manoeuvre,
            next.separates.join(" and "),
            next.nats,
            next.nats
        ));
    }
    items.extend(diagnosis.not_testable.iter().map(|one| {
        format!("{} cannot be tested: {}. Drive {}.", one.effect.name, one.lacks, one.manoeuvre)
    }));
    if items.is_empty() {
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
        items.push("None: no frame is lost, late or odd.".to_owned());
    }
    list(&items)
}

fn list(items: &[String]) -> String {
    let items: String = items.iter().map(|item| format!("<li>{}</li>", escape(item))).collect();
    format!("<ul>{items}</ul>")
}
