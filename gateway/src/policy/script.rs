//! `script:FILE`: timed commands for open-loop calibration runs.
//!
//! ```toml
//! # Seconds count from arming. What a command leaves out stays as it is.
//! end_s = 12                        # the script is over; default: the end of the last command
//! [[command]]
//! at_s = 1.0
//! stroke_mm = [250, 250, "hold", "hold", 250, 250]   # FR FL MR ML BR BL, 0 to 250
//! [[command]]
//! at_s = 5.0
//! ramp_s = 2.0                      # linearly from the values in force, or from where an arm is held
//! throttle_percent = 40             # -100 to 100
//! front_angle_deg = 10              # -25 to 25, left > 0
//! [[command]]
//! at_s = 9.0
//! opening_percent = [10, 10, 0, 0, -10, -10]         # valves, -30 to 30, + extends
//! [[command]]
//! at_s = 10.0
//! arms = "off"                      # off, automatic, position, valve
//! throttle_percent = 0
//! brake = true
//! ```

use std::path::Path;

use xt28_safety::{Arms, Command, Limits};

use super::script_file::{Entry, Mode, ScriptError, ScriptFile, Stroke};
use super::{Outcome, Pace, Policy};
use crate::Observation;

/// Plays timed commands, whatever it sees. Asked at each tick, so its steps are 10 ms sharp.
#[derive(Clone, Debug)]
pub struct Script {
    entries: Vec<Entry>,
    end_s: f64,
    start: Option<Start>,
    now_s: f64,
}

/// What ramps start from where nothing is commanded.
#[derive(Clone, Copy, Debug)]
struct Start {
    /// Stroke of each arm when the script last did not say where it shall be.
    stroke_m: [f64; 6],
    /// Front joint at arming.
    front_angle_rad: f64,
}

impl Script {
    /// A script from a file, for a machine with these limits.
    ///
    /// # Errors
    /// [`ScriptError`], with file, line and what would be right.
    pub fn load(path: &Path, limits: &Limits) -> Result<Self, ScriptError> {
        ScriptFile::read(path, limits).map(Self::new)
    }

    /// A script from TOML text; `path` only names it in errors.
    ///
    /// # Errors
    /// [`ScriptError::Parse`].
    pub fn parse(text: &str, path: &Path, limits: &Limits) -> Result<Self, ScriptError> {
        ScriptFile::parse(text, path, limits).map(Self::new)
    }

    /// The same for a run of `run_s` s, armed within it, in which each command has to come.
    ///
    /// # Errors
    /// [`ScriptError::Parse`].
    pub fn parse_for(
        run_s: f64,
        text: &str,
        path: &Path,
        limits: &Limits,
    ) -> Result<Self, ScriptError> {
        let file = ScriptFile::parse(text, path, limits)?;
        file.check_run(run_s, limits, text, path)?;
        Ok(Self::new(file))
    }

    fn new(file: ScriptFile) -> Self {
        let ends = file.commands.iter().map(|entry| entry.at_s.get_ref() + entry.ramp_s);
        let end_s = file.end_s.map_or_else(|| ends.fold(0.0, f64::max), toml::Spanned::into_inner);
        Self { entries: file.commands, end_s, start: None, now_s: 0.0 }
    }

    /// When the script is over, s since arming.
    #[must_use]
    pub const fn end_s(&self) -> f64 {
        self.end_s
    }

    /// The command in force at `t_s`.
    fn at(&self, t_s: f64, start: &Start) -> Command {
        let mut throttle = Channel::resting(0.0);
        let mut angle_deg = Channel::resting(start.front_angle_rad.to_degrees());
        let mut strokes_mm = start.stroke_m.map(|s| Channel::resting(s * 1e3));
        let mut holds = [true; 6];
        let mut openings = [Channel::resting(0.0); 6];
        let mut mode = Mode::Position;
        let mut brake = false;
        for entry in self.entries.iter().take_while(|entry| *entry.at_s.get_ref() <= t_s) {
            throttle.go(entry, entry.throttle_percent);
            angle_deg.go(entry, entry.front_angle_deg);
            for (i, stroke) in entry.stroke_mm.iter().flatten().enumerate() {
                // An arm that is held, or that another mode moves, is not where it was told to be last.
                if holds[i] || mode != Mode::Position {
                    strokes_mm[i] = Channel::resting(start.stroke_m[i] * 1e3);
                }
                holds[i] = matches!(stroke, Stroke::Hold(_));
                if let Stroke::Target(mm) = stroke {
                    strokes_mm[i].go(entry, Some(*mm));
                }
            }
            for (i, opening) in entry.opening_percent.iter().flatten().enumerate() {
                if mode != Mode::Valve {
                    openings[i] = Channel::resting(0.0);
                }
                openings[i].go(entry, Some(*opening));
            }
            let implied = match (&entry.stroke_mm, &entry.opening_percent) {
                (Some(_), _) => Some(Mode::Position),
                (_, Some(_)) => Some(Mode::Valve),
                _ => None,
            };
            mode = entry.arms.or(implied).unwrap_or(mode);
            brake = entry.brake.unwrap_or(brake);
        }
        let target = |i: usize| (!holds[i]).then(|| strokes_mm[i].value(t_s) * 1e-3);
        let arms = match mode {
            Mode::Off => Arms::Off,
            Mode::Automatic => Arms::Automatic,
            Mode::Position => Arms::Position([0, 1, 2, 3, 4, 5].map(target)),
            Mode::Valve => Arms::Valve(openings.map(|o| o.value(t_s) * 1e-2)),
        };
        let front_angle_rad = angle_deg.value(t_s).to_radians();
        Command { throttle: throttle.value(t_s) * 1e-2, front_angle_rad, arms, brake }
    }
}

impl Policy for Script {
    fn pace(&self) -> Pace {
        Pace::Tick
    }

    fn act(&mut self, seen: &Observation) -> Option<Command> {
        let here = Start { stroke_m: seen.stroke_m.0, front_angle_rad: seen.front_joint_rad };
        let Some(t_s) = seen.since_arming_s else {
            self.start = None;
            // Before arming nothing of the script is in force, not even its commands at zero; but this answer is
            // the one that arming finds, and a brake must not open for it.
            let arms = Arms::Position([None; 6]);
            let (front_angle_rad, brake) = (here.front_angle_rad, self.at(0.0, &here).brake);
            return Some(Command { throttle: 0.0, front_angle_rad, arms, brake });
        };
        self.now_s = t_s;
        let start = *self.start.get_or_insert(here);
        let command = self.at(t_s, &start);
        let told =
            |i: usize| matches!(command.arms, Arms::Position(strokes) if strokes[i].is_some());
        if let Some(start) = &mut self.start {
            for i in (0..6).filter(|i| !told(*i)) {
                start.stroke_m[i] = here.stroke_m[i];
            }
        }
        Some(command)
    }

    fn outcome(&self) -> Outcome {
        let over = self.start.is_some() && self.now_s >= self.end_s;
        if over { Outcome::Reached } else { Outcome::Running }
    }
}

/// One number over time: constant, or on a line between two times.
#[derive(Clone, Copy, Debug)]
struct Channel {
    from: f64,
    to: f64,
    from_s: f64,
    ramp_s: f64,
}

impl Channel {
    const fn resting(value: f64) -> Self {
        Self { from: value, to: value, from_s: 0.0, ramp_s: 0.0 }
    }

    fn value(&self, t_s: f64) -> f64 {
        let done = (t_s - self.from_s) / self.ramp_s;
        if done < 1.0 { self.from + (self.to - self.from) * done } else { self.to }
    }

    /// Sets off for `to`, if the entry names one, from wherever the channel is then.
    fn go(&mut self, entry: &Entry, to: Option<f64>) {
        if let Some(to) = to {
            let from_s = *entry.at_s.get_ref();
            *self = Self { from: self.value(from_s), to, from_s, ramp_s: entry.ramp_s };
        }
    }
}

#[cfg(test)]
mod tests {
    use xt28_machine::{PerWheel, SimTime};

    use super::*;
    use crate::{Action, Attitude};

    const TEXT: &str = r#"
[[command]]
at_s = 1
stroke_mm = [250, 0, "hold", "hold", 100, 100]
[[command]]
at_s = 2
ramp_s = 4
throttle_percent = 40
front_angle_deg = -20
[[command]]
at_s = 4
throttle_percent = 0
opening_percent = [10, -10, 0, 0, 30, -30]
"#;

    fn at(t_s: f64) -> Command {
        let start = Start { stroke_m: [0.17; 6], front_angle_rad: 0.0 };
        Script::parse(TEXT, Path::new("t.toml"), &Limits::XT28).unwrap().at(t_s, &start)
    }

    #[test]
    fn what_a_run_has_no_time_for_is_refused() {
        let parse = |run_s| Script::parse_for(run_s, TEXT, Path::new("s.toml"), &Limits::XT28);
        assert!(parse(100.0).is_ok());
        let error = parse(2.0).unwrap_err().to_string();
        assert!(error.starts_with("s.toml:6: at_s = 2 lies outside the run of 2 s"), "{error}");
    }

    #[test]
    fn commands_come_into_force_at_their_time_and_stay() {
        assert_eq!(at(0.99).arms, Arms::Position([None; 6]));
        let strokes = [Some(0.25), Some(0.0), None, None, Some(0.1), Some(0.1)];
        assert_eq!(at(1.0).arms, Arms::Position(strokes));
        assert_eq!(at(3.99).arms, Arms::Position(strokes));
        assert_eq!(at(4.0).arms, Arms::Valve([0.1, -0.1, 0.0, 0.0, 0.3, -0.3]));
    }

    #[test]
    fn a_ramp_is_a_line_and_a_step_ends_it() {
        assert!((at(3.0).throttle - 0.1).abs() < 1e-12);
        assert_eq!(at(4.0).throttle, 0.0);
        assert!((at(4.0).front_angle_rad + 10_f64.to_radians()).abs() < 1e-12);
        assert!((at(9.0).front_angle_rad + 20_f64.to_radians()).abs() < 1e-12);
    }

    /// Where FR is told to be at each time while the machine has it where `seen_m` says.
    fn told_m(text: &str, seen: [(f64, f64); 3]) -> [Option<f64>; 3] {
        let mut script = Script::parse(text, Path::new("t.toml"), &Limits::XT28).unwrap();
        seen.map(|(t_s, stroke_m)| {
            let zero = PerWheel::splat(0.0);
            let seen = Observation {
                at: SimTime::ZERO,
                sensed_at: SimTime::ZERO,
                since_arming_s: Some(t_s),
                located: None,
                attitude: Attitude::default(),
                stroke_m: PerWheel::splat(stroke_m),
                load_n: zero,
                wheel_speed_rad_s: zero,
                wheel_speed_m_s: 0.0,
                front_joint_rad: 0.0,
                rear_joint_rad: 0.0,
                previous_action: Action::default(),
            };
            let Arms::Position(strokes) = script.act(&seen)?.arms else { return None };
            strokes[0]
        })
    }

    #[test]
    fn a_ramp_after_a_hold_starts_where_the_arm_is_held() {
        let strokes = |at_s: f64, fr: &str, ramp_s: f64| {
            let rest = "\"hold\", \"hold\", \"hold\", \"hold\", \"hold\"";
            format!("[[command]]\nat_s = {at_s}\nramp_s = {ramp_s}\nstroke_mm = [{fr}, {rest}]\n")
        };
        let start = strokes(0.0, "250", 0.0);
        let held = strokes(0.5, "\"hold\"", 0.0);
        let opened = "[[command]]\nat_s = 0.5\nopening_percent = [-10, 0, 0, 0, 0, 0]\n";
        let down = strokes(4.0, "100", 10.0);
        for between in [held.as_str(), opened] {
            let seen = [(0.0, 0.17), (3.99, 0.19), (9.0, 0.15)];
            let told = told_m(&format!("{start}{between}{down}"), seen);
            assert_eq!([told[0], told[1]], [Some(0.25), None], "{between}");
            assert!((told[2].unwrap() - 0.145).abs() < 1e-9, "{between}: {told:?}");
        }
    }

    #[test]
    fn it_is_over_after_its_last_ramp() {
        assert_eq!(Script::parse(TEXT, Path::new("t.toml"), &Limits::XT28).unwrap().end_s(), 6.0);
    }

    #[test]
    fn a_bad_line_is_refused_by_its_number() {
        for (from, to, wanted) in [
            ("at_s = 2", "at_s = 0.5", "t.toml:6: at_s = 0.5 must not be before"),
            ("throttle_percent = 40", "throttle = 40", "t.toml:8: unknown field `throttle`"),
            ("[[command]]", "end_s = 3\n[[command]]", "t.toml:2: end_s = 3 must not be before"),
            ("\"hold\"", "\"hol\"", "t.toml:4: a stroke is a number of mm or \"hold\""),
            ("[250,", "[260,", "t.toml:3: stroke_mm = 260 must be 0 to 250"),
            ("front_angle_deg = -20", "front_angle_deg = nan", "t.toml:6: front_angle_deg = NaN"),
            ("ramp_s = 4", "arms = \"crane\"", "t.toml:7: unknown variant `crane`"),
        ] {
            assert!(TEXT.contains(from));
            let error =
                Script::parse(&TEXT.replacen(from, to, 1), Path::new("t.toml"), &Limits::XT28);
            let error = error.unwrap_err().to_string();
            assert!(error.starts_with(wanted), "{error}");
            assert!(!error.contains('\n'), "{error}");
        }
    }
}
