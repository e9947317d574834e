//! What to drive next, and what for.

use crate::diagnosis::{Drive, Next};

/// Beyond this many nats, odds of a thousand, a figure says no more than a word: models are not that good.
const EASILY_NATS: f64 = 7.0;

/// What a drive is for, after its name: what it tells apart or, without any of that, what it tests.
pub(super) fn purpose(next: &Next, joined_by: &str) -> String {
    let name = |name| if name == "none" { "no effect" } else { name };
    if next.nats.is_some() {
        let rivals: Vec<&str> = next.separates.iter().map(String::as_str).map(name).collect();
        format!("tells {} apart", rivals.join(joined_by))
    } else {
        format!("would test {} that the runs fitted do not", effects(next.tests.len()))
    }
}

/// How well it does, after its purpose. What a drive tests is told of each effect by itself.
pub(super) fn how_well(next: &Next) -> String {
    match next.nats {
        Some(nats) if nats > EASILY_NATS => " easily".to_owned(),
        Some(nats) => format!(", {nats:.1} nats expected (odds of {:.0} to 1)", nats.exp()),
        None => String::new(),
    }
}

/// The drives that would tell less, best first; empty without any.
pub(super) fn after_that(next: &Next) -> String {
    let of = |drive: &Drive| {
        let worth =
            drive.nats.map_or_else(|| effects(drive.tests.len()), |nats| format!("{nats:.1} nats"));
        format!("{} ({worth})", drive.manoeuvre)
    };
    let all: Vec<String> = next.others.iter().map(of).collect();
    if all.is_empty() { String::new() } else { format!("next best: {}", all.join(", ")) }
}

fn effects(count: usize) -> String {
    if count == 1 { "an effect".to_owned() } else { format!("{count} effects") }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn next(nats: Option<f64>) -> Next {
        Next {
            manoeuvre: String::new(),
            separates: nats.map_or(Vec::new(), |_| ["a", "none"].map(str::to_owned).to_vec()),
            nats,
            tests: vec!["b", "c"],
            others: vec![Drive { manoeuvre: "straight".to_owned(), nats, tests: vec!["b"] }],
        }
    }

    #[test]
    fn a_drive_that_tells_with_ease_has_no_figure() {
        assert_eq!(how_well(&next(Some(549_918.9))), " easily");
        assert_eq!(how_well(&next(Some(3.0))), ", 3.0 nats expected (odds of 20 to 1)");
        assert_eq!(purpose(&next(Some(3.0)), " and "), "tells a and no effect apart");
        assert_eq!(after_that(&next(Some(3.0))), "next best: straight (3.0 nats)");
    }

    #[test]
    fn a_drive_that_tells_nothing_apart_says_what_it_tests() {
        let next = next(None);
        assert_eq!(purpose(&next, ", "), "would test 2 effects that the runs fitted do not");
        assert_eq!(how_well(&next), "");
        assert_eq!(after_that(&next), "next best: straight (an effect)");
    }
}
