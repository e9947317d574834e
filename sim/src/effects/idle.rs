//! Entries that would do nothing: all that they set waits for another parameter of their effect.

use super::{Effect, Entry, Parameter};

impl Entry {
    /// The first of `entries` that would do nothing: its place in the list and why, with the key that it lacks.
    ///
    /// Such an entry sets no parameter that acts alone, and none in the list does on one of its wheels. Which of the
    /// two comes first makes no difference: each is set where it sits, and both are read when a block is built.
    #[must_use]
    pub fn idle(entries: &[Self]) -> Option<(usize, String)> {
        let moved_by = |entry: &Self, other: &Self| {
            other.effect == entry.effect && other.acts() && entry.meets(other)
        };
        let at =
            entries.iter().position(|entry| !entries.iter().any(|other| moved_by(entry, other)))?;
        Some((at, entries[at].waits()))
    }

    /// Whether it sets a parameter that acts alone.
    fn acts(&self) -> bool {
        self.values.iter().any(|(parameter, _)| parameter.acts_alone)
    }

    /// Whether the two have a wheel in common.
    fn meets(&self, other: &Self) -> bool {
        self.scope.wheels().any(|wheel| other.scope.contains(wheel))
    }

    /// What it waits for.
    fn waits(&self) -> String {
        let Effect { name, parameters, .. } = self.effect;
        let set: Vec<&str> = self.values.iter().map(|(parameter, _)| parameter.name).collect();
        let alone = parameters.iter().filter(|parameter| parameter.acts_alone);
        let needs: Vec<&str> = alone.map(|Parameter { name, .. }| *name).collect();
        let on = if self.effect.has_scope() { " on its wheels" } else { "" };
        format!(
            "{name} has only {} here and would do nothing; it needs {}, here or in another entry{on}",
            set.join(", "),
            needs.join(" or "),
        )
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use crate::effects::{CATALOGUE, Overlay};

    fn parse(text: &str) -> Result<Overlay, String> {
        Overlay::parse(text, Path::new("o.toml")).map_err(|error| error.to_string())
    }

    fn entry(name: &str, keys: &str) -> String {
        format!("[[effect]]\nname = \"{name}\"\n{keys}\n")
    }

    #[test]
    fn what_only_says_how_another_parameter_acts_is_refused_alone() {
        for (name, key, needs) in [
            ("payload", "lateral_m = 0.3", "mass_kg"),
            ("unsupported-sag", "below_n = 5e3", "rate_m_s"),
            ("accumulator-gas", "volume_m3 = 2e-3", "share"),
            ("seal-stiction", "stribeck_speed_m_s = 0.02", "coulomb_n or stribeck_n"),
            ("drive-lag", "lead_s = 0.1", "time_constant_s"),
            ("load-dependent-speed", "set_at_pa = 5e6", "droop"),
            ("pressure-scale", "rod_share = 0.0", "factor"),
        ] {
            let (key_name, _) = key.split_once(' ').unwrap();
            let before = entry("arm-delay", "delay_s = 0.1");
            let error = parse(&(before + &entry(name, key))).unwrap_err();
            let says = format!(
                "o.toml:4: {name} has only {key_name} here and would do nothing; it needs {needs}, "
            );
            assert!(error.starts_with(&says), "{error}");
        }
    }

    #[test]
    fn every_effect_has_a_parameter_that_acts_alone() {
        for effect in CATALOGUE {
            assert!(effect.parameters.iter().any(|p| p.acts_alone), "{}", effect.name);
        }
    }

    #[test]
    fn another_entry_on_one_of_its_wheels_gives_it_something_to_do() {
        let sag = |scope: &str, keys: &str| {
            entry("unsupported-sag", &format!("scope = \"{scope}\"\n{keys}"))
        };
        let (rate, below) = ("rate_m_s = 0.01", "below_n = 5e3");
        assert!(parse(&(sag("front", rate) + &sag("all", below))).is_ok());
        assert!(parse(&(sag("left", below) + &sag("FL", rate))).is_ok());
        let error = parse(&(sag("front", rate) + &sag("rear", below))).unwrap_err();
        assert!(error.starts_with("o.toml:5: unsupported-sag has only below_n"), "{error}");
        assert!(
            error.ends_with("it needs rate_m_s, here or in another entry on its wheels"),
            "{error}"
        );
        let other = entry("leakage-drift", rate);
        assert!(parse(&(other + &sag("all", below))).is_err(), "another effect's");
    }
}
