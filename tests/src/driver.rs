//! What drives a scenario: its own policy or another, and the files that it names.

use std::io;
use std::path::{Path, PathBuf};

use ecu_emu::Profile;

use crate::{Scenario, ScenarioError};

/// Text of a script policy.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Script {
    /// Where it was found: a path, or a name among the built-in ones.
    pub path: PathBuf,
    /// Its TOML.
    pub text: String,
}

impl Scenario {
    /// Another policy than the scenario's own, as a command line gives it.
    ///
    /// # Errors
    /// [`ScenarioError::Script`].
    pub fn drive_by(&mut self, policy: &str) -> Result<(), ScenarioError> {
        policy.clone_into(&mut self.policy);
        "--policy".clone_into(&mut self.policy_at);
        self.script = None;
        self.ensure_it_drives()?;
        self.find_policy(Path::new(""), &|file| std::fs::read_to_string(file))
    }

    /// Refuses a policy that would have nothing to drive: the ECUs of 2016 take no commands.
    pub(crate) fn ensure_it_drives(&self) -> Result<(), ScenarioError> {
        if self.profile == Profile::Firmware2016 && self.policy != "hold" {
            let (policy_at, policy) = (self.policy_at.clone(), self.policy.clone());
            return Err(ScenarioError::NotDriven { policy_at, policy });
        }
        Ok(())
    }

    /// Finds the file that the policy names, if it names one, `beside` the scenario's own, and reads a script.
    pub(crate) fn find_policy(
        &mut self,
        beside: &Path,
        read: &impl Fn(&Path) -> io::Result<String>,
    ) -> Result<(), ScenarioError> {
        if let Some(file) = self.policy.strip_prefix("network:") {
            // What comes behind the file's name is no part of a path, and stays as it is.
            self.policy = format!("network:{}", beside.join(file).display());
        }
        let Some(file) = self.policy.strip_prefix("script:") else { return Ok(()) };
        let script = beside.join(file);
        let text = read(&script).map_err(|source| ScenarioError::Script {
            policy_at: self.policy_at.clone(),
            script: script.clone(),
            source,
        })?;
        self.script = Some(Script { path: script, text });
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn another_policy_takes_the_place_of_the_scenarios_script() {
        let mut scenario = Scenario::find("arm-steps").unwrap();
        assert!(scenario.script.is_some());
        scenario.drive_by("goto:10,0,0").unwrap();
        assert_eq!((scenario.policy.as_str(), &scenario.script), ("goto:10,0,0", &None));
        let error = scenario.drive_by("script:no/such.toml").unwrap_err().to_string();
        assert!(error.starts_with("--policy: ") && error.contains("no/such.toml"), "{error}");
    }

    #[test]
    fn ecus_that_take_no_commands_are_driven_by_no_policy() {
        let mut scenario = Scenario::find("2016-pedal").unwrap();
        scenario.drive_by("hold").unwrap();
        let error = scenario.drive_by("goto:25,0,0").unwrap_err().to_string();
        assert!(error.starts_with("--policy: `goto:25,0,0` would drive nothing"), "{error}");
        let text = "title = \"t\"\npolicy = \"goto:1,0,0\"\nduration_s = 9\nprofile = \"2016\"\n";
        let nothing = |_: &Path| Err(io::ErrorKind::NotFound.into());
        let error = Scenario::parse(text, Path::new("t.toml"), nothing).unwrap_err().to_string();
        assert!(error.starts_with("t.toml:2: `goto:1,0,0` would"), "{error}");
    }
}
