//! A scripted operator: which controls of the cab are where, and when, from a TOML file.
//!
//! ```toml
//! [[action]]
//! at_s = 6.0
//! left_button = 18          # pressed for 0.2 s, or for hold_s
//!
//! [[action]]
//! at_s = 8.0
//! gas_percent = 60          # stays until another action says otherwise
//! ```

use std::path::{Path, PathBuf};
use std::time::Duration;

use serde::Deserialize;
use toml::Spanned;
use xt28_machine::SimTime;

use crate::Cab;

/// How long a button is pressed when nothing else is said, s.
const HOLD_S: f64 = 0.2;
/// The longest run, s.
const RUN_MAX_S: f64 = 3600.0;

/// Why an operator's script was refused.
#[derive(Debug, thiserror::Error)]
pub enum OperatorError {
    /// The file could not be read.
    #[error(
        "{path}: cannot read the operator's script: {source}; --operator is looked for from the working \
         folder, a scenario's operator beside the scenario"
    )]
    Read {
        /// The file that was looked for, its folder included.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// The text is no script.
    #[error("{path}:{line}: {problem}")]
    Parse {
        /// The file.
        path: PathBuf,
        /// Line, from 1.
        line: usize,
        /// What is wrong there and what would be right.
        problem: String,
    },
}

/// What an operator does over a run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Operator {
    actions: Vec<Action>,
    /// The armrests send nothing, but for an action that lets them.
    pads_silent: bool,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct ScriptFile {
    #[serde(rename = "action")]
    actions: Vec<Action>,
}

/// What an action changes, and when; what it leaves out stays.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
struct Action {
    at_s: Spanned<f64>,
    left_button: Option<u8>,
    right_button: Option<u8>,
    hold_s: Option<f64>,
    gas_percent: Option<f64>,
    brake_percent: Option<f64>,
    joystick_percent: Option<[f64; 2]>,
    steer_percent: Option<f64>,
    roller_percent: Option<f64>,
    chair: Option<Chair>,
    pads_silent: Option<bool>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Chair {
    Front,
    Back,
}

impl Operator {
    /// One who touches nothing.
    #[must_use]
    pub const fn idle() -> Self {
        Self { actions: Vec::new(), pads_silent: false }
    }

    /// Nobody, and no armrests either: somebody else's speak on their wires.
    #[must_use]
    pub const fn absent() -> Self {
        Self { actions: Vec::new(), pads_silent: true }
    }

    /// From a file.
    ///
    /// # Errors
    /// [`OperatorError`], with file, line and remedy.
    pub fn load(path: &Path) -> Result<Self, OperatorError> {
        let text = std::fs::read_to_string(path)
            .map_err(|source| OperatorError::Read { path: path.to_owned(), source })?;
        Self::parse(&text, path)
    }

    /// From TOML text; `path` only names it in errors.
    ///
    /// # Errors
    /// [`OperatorError::Parse`].
    pub fn parse(text: &str, path: &Path) -> Result<Self, OperatorError> {
        let refuse = |at: usize, problem: String| OperatorError::Parse {
            path: path.to_owned(),
            line: text.as_bytes()[..at.min(text.len())].iter().filter(|&&b| b == b'\n').count() + 1,
            problem,
        };
        let file: ScriptFile = toml::from_str(text).map_err(|error| {
            let problem = error.message().trim_end().replace('\n', " ");
            refuse(error.span().map_or(0, |span| span.start), problem)
        })?;
        let mut before_s = 0.0;
        for action in &file.actions {
            let at = action.at_s.span().start;
            action.check(before_s).map_err(|problem| refuse(at, problem))?;
            before_s = action.at_s();
        }
        Ok(Self { actions: file.actions, pads_silent: false })
    }

    /// The cab at `now`.
    #[must_use]
    pub fn cab(&self, now: SimTime) -> Cab {
        let mut cab = Cab { pads_silent: self.pads_silent, ..Cab::default() };
        for action in self.actions.iter().take_while(|action| action.at() <= now) {
            action.apply(now.since(action.at()), &mut cab);
        }
        cab
    }
}

impl Action {
    fn at_s(&self) -> f64 {
        *self.at_s.get_ref()
    }

    fn at(&self) -> SimTime {
        SimTime::ZERO + Duration::from_secs_f64(self.at_s())
    }

    /// Moves the controls that this action moves, so long after it.
    fn apply(&self, since: Duration, cab: &mut Cab) {
        let set = |control: &mut f64, percent: Option<f64>| {
            if let Some(percent) = percent {
                *control = percent * 1e-2;
            }
        };
        set(&mut cab.gas, self.gas_percent);
        set(&mut cab.brake, self.brake_percent);
        set(&mut cab.steer, self.steer_percent);
        set(&mut cab.roller, self.roller_percent);
        if let Some(percent) = self.joystick_percent {
            cab.joystick = percent.map(|share| share * 1e-2);
        }
        if let Some(chair) = self.chair {
            cab.chair_front = chair == Chair::Front;
        }
        if let Some(silent) = self.pads_silent {
            cab.pads_silent = silent;
        }
        let down = since < Duration::from_secs_f64(self.hold_s.unwrap_or(HOLD_S));
        if let Some(button) = self.left_button {
            cab.left_button = down.then_some(button);
        }
        if let Some(button) = self.right_button {
            cab.right_button = down.then_some(button);
        }
    }

    fn check(&self, before_s: f64) -> Result<(), String> {
        let at_s = self.at_s();
        if !(at_s >= before_s && at_s <= RUN_MAX_S) {
            return Err(format!(
                "at_s = {at_s} must be {before_s}, as the action above, to {RUN_MAX_S}"
            ));
        }
        let buttons = [("left_button", self.left_button), ("right_button", self.right_button)];
        for (key, button) in buttons {
            if let Some(button) = button
                && !(1..=21).contains(&button)
            {
                return Err(format!("{key} = {button} must be 1 to 21"));
            }
        }
        let [x, y] = self.joystick_percent.map_or([None; 2], |xy| xy.map(Some));
        let numbers = [
            ("gas_percent", self.gas_percent, [0.0, 100.0]),
            ("brake_percent", self.brake_percent, [0.0, 100.0]),
            ("roller_percent", self.roller_percent, [0.0, 100.0]),
            ("steer_percent", self.steer_percent, [-100.0, 100.0]),
            ("joystick_percent x", x, [-100.0, 100.0]),
            ("joystick_percent y", y, [-100.0, 100.0]),
            ("hold_s", self.hold_s, [0.02, 3600.0]),
        ];
        for (key, value, [low, high]) in numbers {
            // Written so that NaN is refused.
            if let Some(value) = value
                && !(value >= low && value <= high)
            {
                return Err(format!("{key} = {value} must be {low} to {high}"));
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCRIPT: &str = "\
[[action]]
at_s = 1.0
left_button = 18

[[action]]
at_s = 2.0
gas_percent = 60
chair = \"back\"
joystick_percent = [10, -20]

[[action]]
at_s = 2.0
right_button = 12
hold_s = 1.0
";

    fn parse(text: &str) -> Result<Operator, OperatorError> {
        Operator::parse(text, Path::new("a/op.toml"))
    }

    #[test]
    fn controls_stay_where_they_were_put_and_buttons_come_up() {
        let operator = parse(SCRIPT).unwrap();
        let at = |ms| operator.cab(SimTime::from_millis(ms));
        assert_eq!(at(999), Cab::default());
        assert_eq!([at(1000).left_button, at(1190).left_button], [Some(18); 2]);
        assert_eq!(at(1200).left_button, None);
        let later = at(60_000);
        assert_eq!((later.gas, later.chair_front, later.right_button), (0.6, false, None));
        assert_eq!(later.joystick, [0.1, -0.2]);
        assert_eq!(at(2990).right_button, Some(12));
    }

    #[test]
    fn a_bad_script_is_one_line_with_file_line_and_remedy() {
        let cases = [
            (
                "at_s = 1.0",
                "at_s = -1.0",
                "a/op.toml:2: at_s = -1 must be 0, as the action above, to 3600",
            ),
            (
                "left_button = 18",
                "left_button = 22",
                "a/op.toml:2: left_button = 22 must be 1 to 21",
            ),
            (
                "gas_percent = 60",
                "gas_percent = nan",
                "a/op.toml:6: gas_percent = NaN must be 0 to 100",
            ),
            ("gas_percent", "gas", "unknown field `gas`"),
            ("\"back\"", "\"left\"", "unknown variant `left`"),
        ];
        for (from, to, contains) in cases {
            let error = parse(&SCRIPT.replace(from, to)).unwrap_err().to_string();
            assert!(error.contains(contains), "{error}");
            assert!(!error.contains('\n'), "{error}");
        }
    }
}
