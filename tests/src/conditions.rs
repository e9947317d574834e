//! Under what a run was driven: by which policy, on which solver, with which effects.

use serde_json::{Value, json};
use xt28_sim::effects::Entry;

use crate::Setup;

/// What tells two runs of one scenario apart, beside seed and bus.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Conditions {
    /// The policy as a command line names it.
    pub policy: String,
    /// What solved the rigid bodies.
    pub solver: String,
    /// What the machine had beyond the nominal one, each as `xt28 effects` takes it, with its wheels.
    pub effects: Vec<String>,
}

impl Conditions {
    /// Those of a run of `setup`.
    pub(crate) fn new(setup: &Setup) -> Self {
        Self {
            policy: setup.scenario.policy.clone(),
            solver: setup.solver.to_string(),
            effects: setup.overlay.entries.iter().map(entry).collect(),
        }
    }

    /// `driven by hold on rapier, with payload mass_kg=2000 (all)`.
    pub(crate) fn line(&self) -> String {
        let Self { policy, solver, effects } = self;
        let with = if effects.is_empty() {
            String::new()
        } else {
            format!(", with {}", effects.join("; "))
        };
        format!("driven by {policy} on {solver}{with}")
    }

    pub(crate) fn json(&self) -> Value {
        json!({ "policy": self.policy, "solver": self.solver, "effects": self.effects })
    }
}

fn entry(entry: &Entry) -> String {
    let values =
        entry.values.iter().map(|(parameter, value)| format!(" {}={value}", parameter.name));
    let values: String = values.collect();
    // In full is nothing to be said.
    let share = match entry.severity {
        1.0 => String::new(),
        share => format!(" at {share}"),
    };
    format!("{}{values} ({}{share})", entry.effect.name, entry.scope)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Scenario;

    #[test]
    fn a_run_says_what_it_was_driven_with() {
        let mut setup = Setup::new(Scenario::find("straight-25m").unwrap(), None).unwrap();
        assert_eq!(Conditions::new(&setup).line(), "driven by goto:25,0,0 on rapier");
        let text =
            "[[effect]]\nname = \"arm-delay\"\nscope = \"front\"\ndelay_s = 0.2\nseverity = 0.5\n";
        let overlay = xt28_sim::effects::Overlay::parse(text, std::path::Path::new("o.toml"));
        setup.overlay = overlay.unwrap();
        let conditions = Conditions::new(&setup);
        assert!(conditions.line().ends_with(", with arm-delay delay_s=0.2 (front at 0.5)"));
        assert_eq!(conditions.json()["effects"][0], "arm-delay delay_s=0.2 (front at 0.5)");
    }
}
