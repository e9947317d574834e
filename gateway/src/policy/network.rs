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
mod policy_file;
mod rate;
mod term;
mod window;

use core::time::Duration;
use std::path::{Path, PathBuf};

use xt28_machine::{Machine, SimTime};
use xt28_safety::{Arms, Command, Limits};
use xt28_terrain::Terrain;

use super::{Outcome, Pace, Policy, REACHED_DISTANCE_M, REACHED_HEADING_RAD};
use crate::heights::read_heights;
use crate::{Action, ActionMap, Observation, Pose};

use layers::Layers;
use policy_file::{PolicyFile, Trained};
use rate::Rate;
use term::{Term, View};
use window::Window;

pub use policy_file::NetworkError;

/// What was seen longer ago is no frame of a window any more: after so long the safety kernel has stopped the machine.
const FORGOTTEN: Duration = Duration::from_nanos(Limits::XT28.observation.span_ns());

/// A learnt policy. Where it sees a goal its task ends within 0.3 m and 9 degrees of it (paper 4.2), and it holds
/// there; else it has no end.
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
    /// When it was asked last, and what it wanted.
    last: Option<(SimTime, Command)>,
    reached: bool,
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
            last: None,
            reached: false,
        })
    }

    /// The policy file at `path`, and the weights that it names where it can be read.
    #[must_use]
    pub fn files(path: &Path) -> Vec<PathBuf> {
        let weights = PolicyFile::weights_of(path);
        [Some(path.to_owned()), weights].into_iter().flatten().collect()
    }

    /// Whether the machine is where it is to be.
    fn is_there(&self, seen: &Observation) -> bool {
        let (Some(goal), Some(located)) = (&self.goal, &seen.located) else { return false };
        let [ahead_m, left_m, turn_rad] = located.pose.to_local(goal);
        seen.since_arming_s.is_some()
            && ahead_m.hypot(left_m) <= REACHED_DISTANCE_M
            && turn_rad.abs() <= REACHED_HEADING_RAD
    }

    /// What the network wants, given what it sees now and saw before; `None` where it does not see all that it must.
    fn asked(&mut self, seen: &Observation) -> Option<Command> {
        if self.fed_at.is_some_and(|fed_at| seen.at.since(fed_at) > FORGOTTEN) {
            self.window.clear();
        }
        self.heights_m.clear();
        if let (Some(map), Some(located)) = (&self.map, &seen.located) {
            read_heights(map, &located.pose, &mut self.heights_m);
        }
        let view = View { seen, goal: self.goal, heights_m: &self.heights_m };
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

    fn act(&mut self, seen: &Observation) -> Option<Command> {
        self.reached |= self.is_there(seen);
        if let Some((last, command)) = self.last
            && !self.reached
            && !self.rate.is_due(Some(last), seen.at)
        {
            return Some(command);
        }
        let hold = Command {
            throttle: 0.0,
            front_angle_rad: seen.front_joint_rad,
            arms: Arms::Position([None; 6]),
            brake: self.reached,
        };
        let wanted = if self.reached { None } else { self.asked(seen) };
        let command = wanted.unwrap_or(hold);
        self.last = Some((seen.at, command));
        Some(command)
    }

    fn outcome(&self) -> Outcome {
        match (self.goal, self.reached) {
            (None, _) => Outcome::Endless,
            (Some(_), false) => Outcome::Running,
            (Some(_), true) => Outcome::Reached,
        }
    }
}

#[cfg(test)]
mod tests {
    use xt28_machine::PerWheel;

    use super::*;
    use crate::{Attitude, Located};

    /// Every term by its name.
    pub(super) const ALL: [&str; 13] = [
        "goal_m",
        "goal_heading_rad",
        "velocity_m_s",
        "speed_m_s",
        "roll_rad",
        "pitch_rad",
        "stroke_m",
        "load_n",
        "wheel_speed_rad_s",
        "front_joint_rad",
        "rear_joint_rad",
        "previous_action",
        "height_map_m",
    ];

    /// One layer of five numbers, of which the second frame's roll is the last before the goal.
    pub(super) const FILE: &str = r#"weights = "w.safetensors"
layers = ["0"]
activation = "tanh"
squash = "none"
rate = "fix"

[[input]]
frames = 2
newest = "last"
terms = [
    { name = "roll_rad", scale = 10, clip = 1 },
]

[[input]]
terms = [
    { name = "goal_m", scale = [1.0, 2.0], clip = 5 },
    { name = "goal_heading_rad" },
]
"#;

    /// Name, shape and numbers of a tensor.
    pub(super) fn tensor(
        name: &str,
        shape: &[usize],
        numbers: &[f32],
    ) -> (String, Vec<usize>, Vec<u8>) {
        let bytes = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
        (name.to_owned(), shape.to_vec(), bytes)
    }

    /// A safetensors file of `tensors`.
    pub(super) fn file(tensors: &[(String, Vec<usize>, Vec<u8>)]) -> Vec<u8> {
        let views = tensors.iter().map(|(name, shape, bytes)| {
            let view =
                safetensors::tensor::TensorView::new(safetensors::Dtype::F32, shape.clone(), bytes);
            (name.as_str(), view.unwrap())
        });
        safetensors::serialize(views, None).unwrap()
    }

    /// A machine that stands at the origin, heads east and is armed.
    pub(super) fn seen() -> Observation {
        let wheels = PerWheel([0.10, 0.11, 0.12, 0.13, 0.14, 0.15]);
        Observation {
            at: SimTime::ZERO,
            sensed_at: SimTime::ZERO,
            since_arming_s: Some(1.0),
            located: Some(Located::default()),
            attitude: Attitude::default(),
            stroke_m: wheels,
            load_n: wheels,
            wheel_speed_rad_s: wheels,
            wheel_speed_m_s: 0.0,
            front_joint_rad: 0.05,
            rear_joint_rad: 0.0,
            previous_action: Action::default(),
        }
    }

    /// Loads the policy file `text`, whose layer passes what it is fed with on to the first five numbers of an action.
    fn load(text: &str, goal: Option<Pose>) -> Result<Network, NetworkError> {
        let folder = tempfile::tempdir().unwrap();
        let mut weights = [0.0; 40];
        (0..5).for_each(|k| weights[6 * k] = 1.0);
        let weights = [tensor("0.weight", &[8, 5], &weights), tensor("0.bias", &[8], &[0.0; 8])];
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
        // After a second without a fix, what was before is no frame of the window.
        let located = seen.located.take();
        for at in (250..1100).step_by(125) {
            seen.at = SimTime::from_millis(at);
            assert_eq!(said(&mut network, &seen)[0], 0.0);
        }
        (seen.at, seen.located) = (SimTime::from_millis(1125), located);
        near(said(&mut network, &seen), [1.0, 1.0, 4.0, -2.0, 0.2, 0.0, 0.0, 0.0]);
        assert_eq!((network.pace(), network.outcome()), (Pace::Fix, Outcome::Running));
    }

    #[test]
    fn between_two_times_that_it_is_asked_its_answer_holds() {
        let mut network = load(&FILE.replace("\"fix\"", "10"), GOAL).unwrap();
        assert_eq!(network.pace(), Pace::Tick);
        let mut seen = seen();
        let mut rolls = Vec::new();
        for tick in 0..25 {
            seen.at = SimTime::from_millis(10 * tick);
            seen.attitude.roll_rad = 1e-3 * tick as f64;
            rolls.push((100.0 * said(&mut network, &seen)[1]).round());
        }
        assert!(rolls[..10].iter().all(|roll| *roll == 0.0), "{rolls:?}");
        assert!(rolls[10..20].iter().all(|roll| *roll == 10.0), "{rolls:?}");
    }

    #[test]
    fn it_holds_where_it_does_not_see_all_that_it_must_and_at_its_goal() {
        let mut network = load(FILE, GOAL).unwrap();
        let mut seen = seen();
        seen.located = None;
        let hold = network.act(&seen).unwrap();
        assert_eq!((hold.throttle, hold.front_angle_rad, hold.brake), (0.0, 0.05, false));
        let pose = Pose { east_m: 3.9, north_m: -0.8, heading_rad: 0.1 };
        seen.located = Some(Located { pose, ..Located::default() });
        seen.since_arming_s = None;
        assert!(!network.act(&seen).unwrap().brake, "nothing moves yet");
        seen.since_arming_s = Some(9.0);
        let command = network.act(&seen).unwrap();
        assert_eq!((command.throttle, command.brake), (0.0, true));
        assert_eq!(network.outcome(), Outcome::Reached);
        // It stays there.
        seen.located = Some(Located::default());
        assert!(network.act(&seen).unwrap().brake);
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
