//! The causes that a diagnosis stands by, and the overlay that puts them into the simulator.

use xt28_sim::effects::Overlay;

use super::how_far::{overlay, since};
use super::onset::FirstOnset;
use super::verdict::{Cause, Diagnosis, Verdict};

/// A cause at or below this probability is only listed.
const STANDS_ABOVE: f64 = 0.5;

impl Cause {
    /// Whether it is more likely there than not. A diagnosis stands by it where it names an effect at all.
    #[must_use]
    pub fn stands(&self) -> bool {
        self.probability > STANDS_ABOVE
    }
}

impl Diagnosis {
    /// The causes that it stands by, the likeliest first: none unless the verdict is an effect.
    pub fn stood_by(&self) -> impl Iterator<Item = &Cause> {
        let names_any = self.verdict == Verdict::Effect;
        self.causes.iter().filter(move |cause| names_any && cause.stands())
    }

    /// When the first of those causes begins.
    pub(super) fn since(&self) -> FirstOnset {
        since(self.stood_by())
    }

    /// Those causes at their best values, for the simulator to load: it has them from its start on.
    #[must_use]
    pub fn overlay(&self) -> Overlay {
        overlay(self.stood_by())
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::super::verdict::Estimate;
    use super::*;

    fn cause(effect: &str, probability: f64, value: [f64; 3]) -> Cause {
        let effect = xt28_sim::effects::find(effect).unwrap();
        Cause {
            effect,
            scope: "all".parse().unwrap(),
            scopes: Vec::new(),
            values: Vec::new(),
            probability,
            parameters: vec![Estimate { name: effect.parameters[0].name, value }],
            class: vec![effect.name],
            begins: None,
            shrink: None,
        }
    }

    fn diagnosis(verdict: Verdict) -> Diagnosis {
        let causes = vec![
            cause("arm-delay", 0.9, [0.2, 0.19, 0.21]),
            cause("steer-delay", 0.8, [1e9, 0.0, 2e9]),
            cause("valve-lag", 0.4, [0.1, 0.0, 0.2]),
        ];
        Diagnosis::of(verdict, causes)
    }

    #[test]
    fn an_overlay_has_the_causes_stood_by_and_reads_back() {
        let overlay = diagnosis(Verdict::Effect).overlay();
        let again = Overlay::parse(&overlay.to_toml(), Path::new("o.toml")).unwrap();
        assert_eq!(again, overlay);
        let names: Vec<&str> = overlay.entries.iter().map(|entry| entry.effect.name).collect();
        assert_eq!(names, ["arm-delay", "steer-delay"]);
    }

    #[test]
    fn unknown_puts_nothing_into_the_simulator() {
        assert!(diagnosis(Verdict::Unknown).overlay().entries.is_empty());
    }
}
