//! Where demands come from: one trait, and the policies that think here.

mod arrival;
mod external;
mod goto;
mod hold;
mod levelling;
mod network;
mod path;
mod pose_filter;
mod script;
mod script_file;
mod spec;
mod steering;
mod toml_text;

use xt28_machine::SimTime;
use xt28_safety::{Arms, Command};

use crate::Observation;

pub use arrival::{REACHED_DISTANCE_M, REACHED_HEADING_RAD};
pub use external::{Account, External, Refusal, Seat, Seen};
pub use goto::Goto;
pub use hold::Hold;
pub use network::{Network, NetworkError};
pub use script::Script;
pub use script_file::ScriptError;
pub use spec::{SpecError, from_spec, network_files, takes_map};

/// Turns observations into demands. It sees nothing else and is trusted with nothing: the safety
/// kernel stands between it and the bus.
pub trait Policy: Send {
    /// When it wants to be asked.
    fn pace(&self) -> Pace;

    /// Whether it can do nothing without a receiver.
    fn needs_fixes(&self) -> bool {
        self.pace() == Pace::Fix
    }

    /// What it wants, given what it sees. Also asked while not armed
    /// (`since_arming_s` is `None`), so that its first armed answer is not its first; of what it wants then the
    /// brake alone counts. `None` from one that thinks elsewhere: [`Self::answer`] has it once it is there.
    fn act(&mut self, observation: &Observation) -> Option<Command>;

    /// What it wants of its own accord, once: the answer to an observation that it was shown before.
    fn answer(&mut self) -> Option<Answer> {
        None
    }

    /// How far it has come.
    fn outcome(&self) -> Outcome;
}

/// What moves nothing: throttle at zero, the joint at `front_angle_rad`, every arm held where it is.
pub(crate) const fn held(front_angle_rad: f64, brake: bool) -> Command {
    Command { throttle: 0.0, front_angle_rad, arms: Arms::Position([None; 6]), brake }
}

/// A demand that took its time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Answer {
    /// What is wanted.
    pub command: Command,
    /// [`Observation::sensed_at`] of what it answers. It counts as given then, however late it comes.
    pub sensed_at: SimTime,
}

/// When a policy is asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pace {
    /// At each GNSS fix, 8 Hz; its answer holds until the next (paper 5.3).
    Fix,
    /// At each tick, 100 Hz, fix or not.
    Tick,
}

/// How a policy's task stands.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// It has no end to come to; good as long as nothing stops it.
    Endless,
    /// Still at it.
    Running,
    /// Done; its demand now holds the machine.
    Reached,
    /// It can't be done, and why; its demand holds the machine.
    Failed(String),
}

impl Outcome {
    /// Its name in reports.
    #[must_use]
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Endless => "endless",
            Self::Running => "running",
            Self::Reached => "reached",
            Self::Failed(_) => "failed",
        }
    }
}
