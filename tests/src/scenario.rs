//! A scenario file: the machine, the ground, who drives, for how long, and what must hold.

use std::io;
use std::path::{Path, PathBuf};

use ecu_emu::{Mishaps, Profile, Quirks, SensorFault, UnheardEffect};
use serde::Deserialize;
use xt28_sim::effects::Entry;

use crate::cab_script::{self, CabScript};
use crate::driver::Script;
use crate::expect::sense;
use crate::places::Places;
use crate::{Event, Expectation, Ground, Incident, ScenarioError};

/// One scenario as its TOML file states it. Units are in the keys.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scenario {
    /// The file's stem; not a key.
    #[serde(skip)]
    pub name: String,
    /// One line that says what is shown.
    pub title: String,
    /// Machine file, relative to the scenario file; the built-in machine when left out.
    pub machine: Option<PathBuf>,
    /// What the machine has beyond the nominal one, as an overlay file says it.
    #[serde(default, rename = "effect")]
    pub effects: Vec<Entry>,
    /// The ground: tables of a terrain, or a terrain file relative to the scenario file.
    #[serde(default)]
    pub terrain: Ground,
    /// What the gateway drives with, as its `--policy` takes it. A `script:` or `network:FILE` lies beside the
    /// scenario file.
    pub policy: String,
    /// File and line of the policy, for messages; not a key.
    #[serde(skip)]
    pub policy_at: String,
    /// The script that the policy names; not a key.
    #[serde(skip)]
    pub script: Option<Script>,
    /// Whose control runs in the ECUs: `paper`, or the firmware of `2016`, which an operator drives.
    #[serde(default, deserialize_with = "cab_script::profile")]
    pub profile: Profile,
    /// Oddities of that firmware that shall be otherwise than it has them.
    #[serde(default, deserialize_with = "cab_script::quirks")]
    pub quirks: Quirks,
    /// What the operator does: a script beside the scenario file. Profile 2016 only.
    pub operator: Option<PathBuf>,
    /// The script that `operator` names; not a key.
    #[serde(skip)]
    pub cab: Option<CabScript>,
    /// Seed of all noise.
    #[serde(default)]
    pub seed: u64,
    /// Length of the run, s.
    pub duration_s: f64,
    /// What befalls the bench on the way.
    #[serde(default, rename = "event")]
    pub events: Vec<Event>,
    /// Sensors that fail on the way.
    #[serde(default, rename = "fault")]
    pub faults: Vec<SensorFault>,
    /// What must hold.
    #[serde(default, rename = "expect")]
    pub expectations: Vec<Expectation>,
}

/// The longest run a scenario may ask for, s.
const DURATION_MAX_S: f64 = 3_600.0;

impl Scenario {
    /// A scenario from a file, and its script from the file beside it.
    ///
    /// # Errors
    /// [`ScenarioError`], with file, line and remedy.
    pub fn load(path: &Path) -> Result<Self, ScenarioError> {
        let text = std::fs::read_to_string(path)
            .map_err(|source| ScenarioError::Read { path: path.to_owned(), source })?;
        Self::parse(&text, path, |beside| std::fs::read_to_string(beside))
    }

    /// A scenario from TOML text; `path` gives its name and stands in errors, `read` gets the text
    /// of a script or of a terrain file.
    ///
    /// # Errors
    /// [`ScenarioError::Parse`], [`ScenarioError::Value`], [`ScenarioError::Script`],
    /// [`ScenarioError::Operator`] or [`ScenarioError::Terrain`].
    pub fn parse(
        text: &str,
        path: &Path,
        read: impl Fn(&Path) -> io::Result<String>,
    ) -> Result<Self, ScenarioError> {
        let mut scenario: Self =
            toml::from_str(text).map_err(|error| ScenarioError::from_toml(&error, text, path))?;
        scenario.check(text, path)?;
        scenario.name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        scenario.policy_at = format!("{}:{}", path.display(), line_of(text, "policy"));
        let beside = path.parent().unwrap_or(Path::new(""));
        if let Some(machine) = &mut scenario.machine {
            *machine = beside.join(&machine);
        }
        scenario.terrain.resolve(beside, &read).map_err(|source| ScenarioError::Terrain {
            terrain_at: format!("{}:{}", path.display(), line_of(text, "terrain")),
            source,
        })?;
        scenario.ensure_it_drives()?;
        scenario.find_policy(beside, &read)?;
        if let Some(file) = &mut scenario.operator {
            *file = beside.join(&file);
            let cab = CabScript::read(file, &read);
            scenario.cab = Some(cab.map_err(|source| ScenarioError::Operator {
                operator_at: format!("{}:{}", path.display(), line_of(text, "operator")),
                source,
            })?);
        }
        Ok(scenario)
    }

    /// What goes wrong with the machine's electrics.
    #[must_use]
    pub fn mishaps(&self) -> Mishaps {
        let power = self.events.iter().filter_map(|event| match event.what {
            Incident::Power(power) => Some(power),
            Incident::Kill(_) | Incident::Order(_) => None,
        });
        Mishaps { faults: self.faults.clone(), events: power.collect() }
    }

    fn check(&self, text: &str, path: &Path) -> Result<(), ScenarioError> {
        let refuse = |line: usize, problem: String| {
            Err(ScenarioError::Value { path: path.to_owned(), line, problem })
        };
        if !(self.duration_s > 0.0 && self.duration_s <= DURATION_MAX_S) {
            let problem =
                format!("duration_s = {} must be above 0 and at most 3600", self.duration_s);
            return refuse(line_of(text, "duration_s"), problem);
        }
        if let Some((line, problem)) = self.mishap_problem(text) {
            return refuse(line, problem);
        }
        if self.operator.is_some() && self.profile == Profile::Paper {
            let problem = "operator needs profile = \"2016\": no cab is heard otherwise";
            return refuse(line_of(text, "operator"), problem.to_owned());
        }
        if self.quirks != Quirks::firmware() && self.profile == Profile::Paper {
            let problem = "quirks need profile = \"2016\": they are oddities of that firmware";
            return refuse(line_of(text, "quirks"), problem.to_owned());
        }
        self.check_effects(text, path)?;
        if let Some((line, problem)) = sense::problem(text, self.duration_s) {
            return refuse(line, problem);
        }
        self.terrain.spec.check().map_err(|fault| ScenarioError::Value {
            path: path.to_owned(),
            line: fault.line_in(text, "terrain."),
            problem: format!("[terrain.{}]: {}", fault.table, fault.problem),
        })
    }

    /// Refuses effects that this profile does not hear of, and those that would do nothing.
    fn check_effects(&self, text: &str, path: &Path) -> Result<(), ScenarioError> {
        let refuse = |name: &str, before: usize, problem: String| {
            let named = format!("\"{name}\"");
            let mut naming = (1..).zip(text.lines()).filter(|(_, line)| line.contains(&named));
            let line = naming.nth(before).map_or(1, |(line, _)| line);
            Err(ScenarioError::Value { path: path.to_owned(), line, problem })
        };
        if let Err(error) = UnheardEffect::check(self.profile, &self.effects) {
            return refuse(error.effect, 0, error.to_string());
        }
        if let Some(at) = self.effects.iter().position(|entry| entry.severity <= 0.0) {
            let line = Places::of(text).effect(at, "severity", text);
            let name = self.effects[at].effect.name;
            let problem =
                format!("{name} would do nothing at severity = 0; give more, or remove it");
            return Err(ScenarioError::Value { path: path.to_owned(), line, problem });
        }
        if let Some((at, problem)) = Entry::idle(&self.effects) {
            let effect = self.effects[at].effect;
            let before = self.effects[..at].iter().filter(|entry| entry.effect == effect).count();
            return refuse(effect.name, before, problem);
        }
        Ok(())
    }
}

/// The line, from 1, that begins with `key`; 1 if none does.
fn line_of(text: &str, key: &str) -> usize {
    text.lines().position(|line| line.trim_start().starts_with(key)).map_or(1, |index| index + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    const GOOD: &str = r#"
title = "Over a ramp"
policy = "goto:15,0,0"
duration_s = 30

[terrain.ramp]
x_m = [4, 7, 8.5, 11.5]
height_m = 0.3
y_min_m = -1.9
y_max_m = -0.5

[[event]]
at_s = 5.0
kill = "gateway"

[[expect]]
stands-still = { below_m_s = 0.02 }
"#;

    fn parse(text: &str) -> Result<Scenario, ScenarioError> {
        Scenario::parse(text, Path::new("a/ramp.toml"), |script| match script.to_str() {
            Some("a/steps.toml") => Ok("[[command]]".to_owned()),
            Some("a/kerb.toml") => Ok("kind = \"step\"\nx_m = 6\nheight_m = 0.15".to_owned()),
            Some("a/bad.toml") => Ok("\nkind = \"step\"\nx_mm = 6".to_owned()),
            _ => Err(io::ErrorKind::NotFound.into()),
        })
    }

    fn refusal(from: &str, to: &str) -> String {
        assert!(GOOD.contains(from));
        let text = GOOD.replace(from, to);
        parse(&text).unwrap_err().to_string()
    }

    #[test]
    fn reads_every_part() {
        let scenario = parse(GOOD).unwrap();
        assert_eq!(scenario.name, "ramp");
        assert_eq!(scenario.terrain.spec.ramp[0].height_m, 0.3);
        assert_eq!(scenario.terrain.to_string(), "ramp 0.3 m");
        assert_eq!(
            scenario.events,
            [Event { at_s: 5.0, what: Incident::Kill(crate::Node::Gateway) }]
        );
        assert_eq!(scenario.expectations.len(), 1);
    }

    #[test]
    fn a_script_is_read_from_beside_the_scenario() {
        let scenario = parse(&GOOD.replace("goto:15,0,0", "script:steps.toml")).unwrap();
        assert_eq!(scenario.script.unwrap().text, "[[command]]");
        assert_eq!(scenario.policy_at, "a/ramp.toml:3");
    }

    #[test]
    fn a_terrain_may_lie_beside_the_scenario() {
        let with = |terrain: &str| {
            parse(&format!("title = \"t\"\npolicy = \"idle\"\nduration_s = 1\n{terrain}"))
        };
        let scenario = with("terrain = \"kerb.toml\"").unwrap();
        assert_eq!(scenario.terrain.spec.step[0].height_m, 0.15);
        let error = with("terrain = \"bad.toml\"").unwrap_err().to_string();
        assert!(error.starts_with("a/ramp.toml:4: a/bad.toml:"), "{error}");
        assert!(error.contains("`x_mm`"), "{error}");
        let error = with("terrain = \"none.toml\"").unwrap_err().to_string();
        assert!(error.contains("a/none.toml: cannot read the terrain file"), "{error}");
        let error = with("terrain = 3").unwrap_err().to_string();
        assert!(error.starts_with("a/ramp.toml:4: invalid type"), "{error}");
        let both =
            "[terrain.slope]\ngrade = 0.1\n[[terrain.bumps]]\nheight_m = 0.1\nwavelength_m = 3";
        assert_eq!(with(both).unwrap().terrain.to_string(), "slope 10 %, bumps 0.1 m");
        assert_eq!(with("").unwrap().terrain.to_string(), "flat ground");
    }

    #[test]
    fn an_operator_is_read_from_beside_the_scenario_and_needs_the_profile_of_2016() {
        const ACTION: &str = "[[action]]\nat_s = 1.0\nleft_button = 18\n";
        let parse = |profile: &str, action: &'static str| {
            let keys =
                format!("profile = \"{profile}\"\noperator = \"cab.toml\"\n\n[terrain.ramp]");
            Scenario::parse(
                &GOOD.replace("goto:15,0,0", "hold").replace("[terrain.ramp]", &keys),
                Path::new("a/ramp.toml"),
                |path| {
                    assert_eq!(path, Path::new("a/cab.toml"));
                    Ok(action.to_owned())
                },
            )
        };
        let scenario = parse("2016", ACTION).unwrap();
        assert_eq!(
            (scenario.profile, scenario.quirks),
            (Profile::Firmware2016, Quirks::firmware())
        );
        assert_eq!(scenario.cab.unwrap().text, ACTION);
        let unheard = "2016\"\neffect = [{ name = \"steer-gain\", kp_factor = 0.5 }]\n#";
        let keys = "quirks = { follower_gate_is_a_step = false }\n[terrain.ramp]";
        let quirky = Scenario::parse(
            &GOOD.replace("[terrain.ramp]", keys),
            Path::new("a/ramp.toml"),
            |_| Err(io::ErrorKind::NotFound.into()),
        );
        let refusals = [
            (parse(unheard, ACTION), "a/ramp.toml:7: \"steer-gain\" acts in loops"),
            (parse("paper", ACTION), "a/ramp.toml:7: operator needs profile = \"2016\""),
            (parse("2016", "[[action]]\n"), "a/ramp.toml:7: a/cab.toml:1: missing field `at_s`"),
            (parse("2016\"\nquirks = { x = true }\n#", ACTION), "a/ramp.toml:7: no oddity \"x\""),
            (quirky, "a/ramp.toml:6: quirks need profile = \"2016\""),
            (parse("2015", ACTION), "a/ramp.toml:6: no profile \"2015\"; give paper or 2016"),
        ];
        let absent = Scenario::parse(
            &GOOD.replace("goto:15,0,0", "hold").replace(
                "[terrain.ramp]",
                "profile = \"2016\"\noperator = \"no.toml\"\n[terrain.ramp]",
            ),
            Path::new("a/ramp.toml"),
            |_| Err(io::ErrorKind::NotFound.into()),
        );
        let error = absent.unwrap_err().to_string();
        assert!(error.starts_with("a/ramp.toml:7: a/no.toml: cannot read the operator"), "{error}");
        assert!(error.ends_with("a scenario's operator beside the scenario"), "{error}");
        for (refused, starts) in refusals {
            let error = refused.unwrap_err().to_string();
            assert!(error.starts_with(starts), "{error}");
        }
    }

    #[test]
    fn an_effect_that_would_do_nothing_is_refused_with_its_line() {
        let sag = |scope: &str, key: &str| {
            format!("[[effect]]\nname = \"unsupported-sag\"\nscope = \"{scope}\"\n{key}\n")
        };
        let with = |entries: String| parse(&format!("{GOOD}{entries}"));
        let (rate, below) = (sag("front", "rate_m_s = 0.01"), sag("all", "below_n = 5e3"));
        assert!(with(rate.clone() + &below).is_ok());
        let error = with(rate + &sag("rear", "below_n = 5e3")).unwrap_err().to_string();
        assert!(error.starts_with("a/ramp.toml:23: unsupported-sag has only below_n"), "{error}");
        assert!(with(below).unwrap_err().to_string().starts_with("a/ramp.toml:19: "));
    }

    #[test]
    fn a_bad_key_unit_or_value_is_one_line_with_file_line_and_remedy() {
        let cases = [
            (
                "duration_s",
                "duration_ms",
                "a/ramp.toml:4: unknown field `duration_ms`",
                "duration_s",
            ),
            ("height_m", "height_mm", "a/ramp.toml:8: unknown field `height_mm`", "height_m"),
            ("\"gateway\"", "\"cab\"", "a/ramp.toml:14: unknown variant `cab`", "emulator"),
            ("stands-still", "stand-still", "a/ramp.toml:17: unknown variant", "stands-still"),
            ("below_m_s", "below_km_h", "a/ramp.toml:17: unknown field `below_km_h`", "below_m_s"),
            ("= 30", "= -1", "a/ramp.toml:4: duration_s = -1", "above 0"),
            ("= 30", "= nan", "a/ramp.toml:4: duration_s = NaN", "above 0"),
            ("= 0.02", "= nan", "a/ramp.toml:17: stands-still: below_m_s = NaN", "finite"),
            ("at_s = 5.0", "at_s = 31", "a/ramp.toml:13: at_s = 31", "0 to 30"),
            ("7, 8.5", "9, 8.5", "a/ramp.toml:6: [terrain.ramp]", "x_m must grow"),
            ("goto:15,0,0", "script:no.toml", "a/ramp.toml:3: cannot read", "a/no.toml"),
        ];
        for (from, to, starts, contains) in cases {
            let error = refusal(from, to);
            assert!(error.starts_with(starts), "{error}");
            assert!(error.contains(contains), "{error}");
            assert!(!error.contains('\n'), "{error}");
        }
    }
}
