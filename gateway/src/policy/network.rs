//! `network:FILE[@X,Y,HEADING_DEG]`: a learnt policy, from a policy file and its weights (safetensors).
//!
//! ```toml
//! weights = "straight.safetensors"   # beside this file
//! layers = ["0", "2", "4"]           # NAME.weight and NAME.bias, as PyTorch calls them, first to last
//! activation = "elu"                 # between them: elu, relu, silu or tanh
//! squash = "tanh"                    # what the last one says: tanh or none
//! rate = "fix"                       # asked at each fix, 8 Hz; or 10, 20, 25, 50, 100 Hz
//!
//! [[input]]                          # the tables come one behind the other, each frame after frame
//! frames = 8
//! newest = "last"
//! terms = [                          # each is clamp((value - offset) * scale, clip)
//!     { name = "goal_m", scale = 0.1, clip = 5 },
//!     { name = "stroke_m", offset = 0.125, scale = 8 },
//! ]
//! ```
//!
//! It is fed in the gateway with what it would be fed with anywhere else that builds its observations here; what does
//! not fit its file is refused before anything moves. Eight numbers come out, an [`Action`].

mod layers;
#[cfg(test)]
mod made_up;
mod policy_file;
mod rate;
mod term;
mod window;

use core::time::Duration;
use std::path::{Path, PathBuf};

use xt28_machine::{Machine, SimTime};
use xt28_safety::{Command, Limits};
use xt28_terrain::Terrain;

use super::arrival::{Standstill, judge, too_far};
use super::{Outcome, Pace, Policy, held};
use crate::heights::read_heights;
use crate::{Action, ActionMap, Observation, Pose};

use layers::Layers;
use policy_file::{PolicyFile, Trained};
use rate::Rate;
use term::{Term, View};
use window::Window;

pub use policy_file::NetworkError;

/// What was seen longer ago is no frame of a window any more: after so long without an answer the safety kernel has
/// stopped the machine.
const FORGOTTEN: Duration = Duration::from_nanos(Limits::XT28.observation.span_ns());

/// A learnt policy. Where it sees a goal its task ends within 0.3 m and 9 degrees of it (paper 4.2): it lets the machine
/// come to a stop, and has reached its goal if that is there. Else it has no end.
#[derive(Clone, Debug)]
pub struct Network {
    window: Window,
    layers: Layers,
    rate: Rate,
    actions: ActionMap,
    goal: Option<Pose>,
    /// What its local height map is cut from, if it looks at one.
    map: Option<Terrain>,
    heights_m: Vec<f32>,
    fed: Vec<f32>,
    /// When the window took its last frame.
    fed_at: Option<SimTime>,
    /// When it was asked last.
    asked_at: Option<SimTime>,
    /// Whether something moved then.
    was_armed: bool,
    stage: Stage,
}

#[derive(Clone, Debug)]
enum Stage {
    /// The network has the word.
    Driving,
    /// At the goal, throttle let go, until it stands; the front joint stays as it was.
    Stopping { standstill: Standstill, joint_rad: f64 },
    /// Standing for good.
    Ended { outcome: Outcome, joint_rad: f64 },
}

impl Network {
    /// The network of the policy file at `path` on a machine with these ranges. `goal` is for one that sees a goal, and
    /// for no other; `map` for one that sees heights.
    ///
    /// # Errors
    /// [`NetworkError`]: file, line or tensor, and what would be right.
    pub fn load(
        path: &Path,
        machine: &Machine,
        goal: Option<Pose>,
        map: Option<&Terrain>,
    ) -> Result<Self, NetworkError> {
        let Trained { window, layers, rate } = PolicyFile::read(path)?;
        let refuse = |problem| Err(NetworkError::Given { path: path.to_owned(), problem });
        let sees_goal = window.terms().any(Term::needs_goal);
        let sees_map = window.terms().any(|term| term == Term::HeightMapM);
        match (goal, map) {
            (None, _) if sees_goal => {
                return refuse("it sees a goal; give one, as network:FILE@25,0,0");
            }
            (Some(_), _) if !sees_goal => {
                return refuse("it sees no goal; leave @X,Y,HEADING_DEG out");
            }
            (_, None) if sees_map => {
                return refuse(
                    "it sees heights around the machine; give their terrain file (--map)",
                );
            }
            _ => {}
        }
        Ok(Self {
            window,
            layers,
            rate,
            actions: ActionMap::new(machine),
            goal,
            map: map.filter(|_| sees_map).cloned(),
            heights_m: Vec::new(),
            fed: Vec::new(),
            fed_at: None,
            asked_at: None,
            was_armed: false,
            stage: Stage::Driving,
        })
    }

    /// The policy file at `path`, and the weights that it names where it can be read.
    #[must_use]
    pub fn files(path: &Path) -> Vec<PathBuf> {
        let weights = PolicyFile::weights_of(path);
        [Some(path.to_owned()), weights].into_iter().flatten().collect()
    }

    /// Moves on to the stage that fits what is seen.
    fn advance(&mut self, seen: &Observation) {
        let (Some(goal), Some(located)) = (&self.goal, &seen.located) else { return };
        let joint_rad = seen.front_joint_rad;
        match &mut self.stage {
            // Where the joint is held from then on must be known.
            Stage::Driving if joint_rad.is_finite() => {
                if let Some(outcome) = too_far(&located.pose, goal) {
                    self.stage = Stage::Ended { outcome, joint_rad };
                } else if seen.since_arming_s.is_some()
                    && judge(&located.pose, goal) == Outcome::Reached
                {
                    self.stage = Stage::Stopping { standstill: Standstill::default(), joint_rad };
                }
            }
            Stage::Stopping { standstill, joint_rad } => {
                let joint_rad = *joint_rad;
                if let Some(outcome) = standstill.outcome(seen, &located.pose, goal) {
                    self.stage = Stage::Ended { outcome, joint_rad };
                }
            }
            Stage::Driving | Stage::Ended { .. } => {}
        }
    }

    /// What the network wants, given what it sees now and saw before; `None` where it does not see all that it must.
    fn asked(&mut self, seen: &Observation) -> Option<Command> {
        // Until something moves every time is the beginning of a drive, as is the first time after that.
        let begins = seen.since_arming_s.is_none() || !self.was_armed;
        self.was_armed = seen.since_arming_s.is_some();
        if begins || self.fed_at.is_some_and(|fed_at| seen.at.since(fed_at) > FORGOTTEN) {
            self.window.clear();
        }
        self.heights_m.clear();
        if let (Some(map), Some(located)) = (&self.map, &seen.located) {
            read_heights(map, &located.pose, &mut self.heights_m);
        }
        let previous_action = if begins { Action::default() } else { seen.previous_action };
        let view = View { seen, goal: self.goal, heights_m: &self.heights_m, previous_action };
        if !self.window.take(&view, &mut self.fed) {
            return None;
        }
        self.fed_at = Some(seen.at);
        let said = self.layers.forward(&self.fed);
        let mut action = Action::default();
        action.0.iter_mut().zip(said).for_each(|(number, said)| *number = f64::from(*said));
        Some(self.actions.command(&action))
    }
}

impl Policy for Network {
    fn pace(&self) -> Pace {
        self.rate.pace()
    }

    fn needs_fixes(&self) -> bool {
        self.rate == Rate::Fix || self.window.terms().any(Term::needs_fix)
    }

    /// `None` between two times that it is asked, and where it does not see all that it must: its last answer gets old
    /// then, and the safety kernel stops the machine.
    fn act(&mut self, seen: &Observation) -> Option<Command> {
        self.advance(seen);
        match self.stage {
            Stage::Stopping { joint_rad, .. } => Some(held(joint_rad, false)),
            Stage::Ended { joint_rad, .. } => Some(held(joint_rad, true)),
            Stage::Driving if self.rate.is_due(self.asked_at, seen.at) => {
                self.asked_at = Some(seen.at);
                self.asked(seen)
            }
            Stage::Driving => None,
        }
    }

    fn outcome(&self) -> Outcome {
        match (self.goal, &self.stage) {
            (None, _) => Outcome::Endless,
            (_, Stage::Ended { outcome, .. }) => outcome.clone(),
            (Some(_), Stage::Driving | Stage::Stopping { .. }) => Outcome::Running,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::made_up::{FILE, file, seen, tensor};
    use super::*;
    use crate::Located;

    /// Loads the policy file `text`, whose layer passes what it is fed with on to the first five numbers of an action.
    fn load(text: &str, goal: Option<Pose>) -> Result<Network, NetworkError> {
        load_wide(text, 5, goal)
    }

    /// The same of a layer that is fed with `width` numbers, of which it passes on five that are as far apart as can be.
    fn load_wide(text: &str, width: usize, goal: Option<Pose>) -> Result<Network, NetworkError> {
        let folder = tempfile::tempdir().unwrap();
        let mut weights = vec![0.0; 8 * width];
        (0..5).for_each(|k| weights[k * width + k * (width - 1) / 4] = 1.0);
        let weights =
            [tensor("0.weight", &[8, width], &weights), tensor("0.bias", &[8], &[0.0; 8])];
        std::fs::write(folder.path().join("w.safetensors"), file(&weights)).unwrap();
        let path = folder.path().join("p.toml");
        std::fs::write(&path, text).unwrap();
        Network::load(&path, &Machine::xt28(), goal, None)
    }

    const GOAL: Option<Pose> = Some(Pose { east_m: 4.0, north_m: -1.0, heading_rad: 0.2 });

    fn said(network: &mut Network, seen: &Observation) -> [f64; 8] {
        let command = network.act(seen).unwrap();
        network.actions.action(&command, &seen.stroke_m).0
    }

    #[test]
    fn what_a_network_says_is_an_action() {
        let mut network = load(FILE, GOAL).unwrap();
        let mut seen = seen();
        let near = |said: [f64; 8], wanted: [f64; 8]| {
            let mut pairs = said.into_iter().zip(wanted);
            assert!(pairs.all(|(a, b)| (a - b).abs() < 1e-6), "{said:?} {wanted:?}");
        };
        seen.attitude.roll_rad = 0.02;
        near(said(&mut network, &seen), [0.2, 0.2, 4.0, -2.0, 0.2, 0.0, 0.0, 0.0]);
        seen.attitude.roll_rad = 0.5;
        seen.at = SimTime::from_millis(125);
        near(said(&mut network, &seen), [0.2, 1.0, 4.0, -2.0, 0.2, 0.0, 0.0, 0.0]);
        // After a second without a fix, in which it says nothing, what was before is no frame of the window.
        let located = seen.located.take();
        for at in (250..1100).step_by(125) {
            seen.at = SimTime::from_millis(at);
            assert_eq!(network.act(&seen), None);
        }
        (seen.at, seen.located) = (SimTime::from_millis(1125), located);
        near(said(&mut network, &seen), [1.0, 1.0, 4.0, -2.0, 0.2, 0.0, 0.0, 0.0]);
        assert_eq!((network.pace(), network.outcome()), (Pace::Fix, Outcome::Running));
    }

    #[test]
    fn a_drive_begins_without_a_past() {
        let text = FILE.replace("roll_rad\", scale = 10, clip = 1", "previous_action\"");
        let text = text.replace("    { name = \"goal_m\", scale = [1.0, 2.0], clip = 5 },\n", "");
        let mut network = load_wide(&text, 17, GOAL).unwrap();
        let mut seen = Observation { previous_action: Action([0.5; 8]), ..seen() };
        let mut older_and_newer = |at_ms: u64, since_arming_s: Option<f64>| {
            (seen.at, seen.since_arming_s) = (SimTime::from_millis(at_ms), since_arming_s);
            let said = said(&mut network, &seen);
            [said[0], said[2]].map(|number| (1e9 * number).round() / 1e9)
        };
        assert_eq!(older_and_newer(0, None), [0.0; 2]);
        assert_eq!(older_and_newer(125, Some(0.0)), [0.0; 2]);
        assert_eq!(older_and_newer(250, Some(0.125)), [0.0, 0.5]);
        assert_eq!(older_and_newer(375, Some(0.25)), [0.5; 2]);
        assert_eq!(older_and_newer(500, None), [0.0; 2], "stopped");
    }

    #[test]
    fn it_answers_as_often_as_it_is_asked() {
        let mut network = load(&FILE.replace("\"fix\"", "10"), GOAL).unwrap();
        assert!(network.pace() == Pace::Tick && network.needs_fixes());
        let mut seen = seen();
        let answered: Vec<u64> = (0..25)
            .filter(|tick| {
                seen.at = SimTime::from_millis(10 * tick);
                network.act(&seen).is_some()
            })
            .collect();
        assert_eq!(answered, [0, 10, 20]);
    }

    /// Drives at 0.8 m/s until told, and stands then.
    fn seen_at(pose: Pose, at_ms: u64, speed_m_s: f64) -> Observation {
        let located = Some(Located { pose, ..Located::default() });
        Observation {
            at: SimTime::from_millis(at_ms),
            located,
            wheel_speed_m_s: speed_m_s,
            ..seen()
        }
    }

    #[test]
    fn a_goal_is_reached_where_the_machine_stands_there() {
        let near = Pose { east_m: 3.9, north_m: -0.8, heading_rad: 0.1 };
        let beyond = Pose { east_m: 5.2, ..near };
        for (ends_at, outcome) in [(near, "reached"), (beyond, "failed")] {
            let mut network = load(FILE, GOAL).unwrap();
            let unarmed = Observation { since_arming_s: None, ..seen_at(near, 0, 0.8) };
            assert!(network.act(&unarmed).is_some(), "nothing moves yet");
            assert_eq!(network.outcome(), Outcome::Running);
            let mut seen = seen_at(near, 125, 0.8);
            let command = network.act(&seen).unwrap();
            assert_eq!((command.throttle, command.brake), (0.0, false), "it still rolls");
            assert_eq!(network.outcome(), Outcome::Running);
            // The joint stays where it was as the goal came near.
            seen = Observation { front_joint_rad: 0.3, ..seen_at(ends_at, 250, 0.0) };
            assert_eq!(network.act(&seen).unwrap().front_angle_rad, 0.05);
            let command = network.act(&seen_at(ends_at, 1250, 0.0)).unwrap();
            assert!(command.brake && network.outcome().name() == outcome, "{outcome}");
            // It stays there.
            assert!(network.act(&seen_at(Pose::default(), 1375, 0.0)).unwrap().brake);
        }
    }

    #[test]
    fn a_sensor_that_hangs_keeps_no_drive_from_its_end() {
        let near = Pose { east_m: 3.9, north_m: -0.8, heading_rad: 0.1 };
        let mut network = load(FILE, GOAL).unwrap();
        let answers = (0..100).map(|i| network.act(&seen_at(near, 125 * i, 0.1)).unwrap());
        // It lets go of the throttle at once, and asks for the brake after ten seconds.
        assert_eq!(answers.filter(|command| !command.brake).count(), 81);
        let Outcome::Failed(why) = network.outcome() else { panic!("it never stands") };
        assert!(why.contains("still read 0.10 m/s"), "{why}");
    }

    #[test]
    fn no_network_drives_to_a_goal_of_another_site() {
        let away = Some(Pose { east_m: 9e5, ..Pose::default() });
        for since_arming_s in [None, Some(0.0)] {
            let mut network = load(FILE, away).unwrap();
            let seen = Observation { since_arming_s, ..seen() };
            assert!(network.act(&seen).unwrap().brake);
            let Outcome::Failed(why) = network.outcome() else { panic!("it is too far") };
            assert!(why.contains("900000 m from the machine") && why.contains("--origin"), "{why}");
        }
    }

    #[test]
    fn what_a_file_needs_beside_it_is_asked_for_and_nothing_else() {
        let refused = |text: &str, goal| load(text, goal).unwrap_err().to_string();
        assert!(refused(FILE, None).contains("it sees a goal; give one, as network:FILE@25,0,0"));
        let blind = FILE.replace("goal_m", "velocity_m_s").replace("[1.0, 2.0]", "1");
        let blind = blind.replace("    { name = \"goal_heading_rad\" },\n", "");
        assert!(refused(&blind, GOAL).contains("leave @X,Y,HEADING_DEG out"));
        assert_eq!(load(&blind, None).unwrap().outcome(), Outcome::Endless);
        let sees_heights = blind.replace("velocity_m_s", "height_map_m");
        let error = refused(&sees_heights, None);
        assert!(error.contains("w.safetensors: 0.weight takes 5 numbers"), "{error}");
    }
}
