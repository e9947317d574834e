//! The state machine of both ECUs: init, standby, active, safe stop, fault.
//!
//! Nothing moves outside [`State::Active`], and nothing is active without a command younger than
//! [`COMMAND_DEADLINE`]. A stream that is there from the start may command at once, so that a
//! recorded run replays from its first frame. After a safe stop the sender must first ask for rest,
//! at the earliest in the last of [`REARM_FRAMES`] good frames: a node that dropped out and comes back in
//! the middle of a manoeuvre does not set the machine moving.

use core::time::Duration;

use xt28_dbc::messages::{ArmStatusState, DriveStatusState};

use crate::Refusal;

/// Period of both ECUs' task and of every command frame.
pub(crate) const PERIOD: Duration = Duration::from_millis(10);
/// The same in s.
pub(crate) const PERIOD_S: f64 = 0.01;
/// A command older than this is lost: three periods.
pub(crate) const COMMAND_DEADLINE: Duration = PERIOD.saturating_mul(3);
/// Good frames without a silence between them that end a safe stop, with a request for rest in the last.
pub(crate) const REARM_FRAMES: u32 = 3;

/// So long an ECU that has restarted looks at its inputs before it takes part: 100 ms (assumed).
pub(crate) const SELF_TEST: State = State::Restarted(10);

/// Where an ECU is in its life.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum State {
    /// Its inputs have not all been seen in range yet.
    #[default]
    Init,
    /// Started again while the machine may have been moving; says init for so many task periods
    /// more, and then does nothing before its sender has asked for rest.
    Restarted(u8),
    /// Ready; commanded to rest, or not at all.
    Standby,
    /// Carries out a command.
    Active,
    /// The command stayed away, or a fault just ended.
    SafeStop,
    /// An input that the control needs is broken.
    Fault,
}

/// What the freshest command asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Request {
    /// Mode off, or not enabled.
    Rest,
    /// Anything that may move the machine.
    Move,
}

/// The command stream at one tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Commanded {
    /// What it asks for.
    pub(crate) request: Request,
    /// Good frames since it was last lost.
    pub(crate) frames: u32,
}

/// The needed inputs at one tick, better before worse.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Health {
    /// All in range.
    Good,
    /// Something out of range, but not for long enough to call it broken.
    Doubtful,
    /// Broken.
    Broken,
}

impl State {
    /// The next state; `commanded` is `None` while no command is fresh.
    pub(crate) fn next(self, health: Health, commanded: Option<Commanded>) -> Self {
        let request = commanded.map(|c| c.request);
        match (self, health) {
            (_, Health::Broken) => Self::Fault,
            (Self::Init, Health::Doubtful) => Self::Init,
            (Self::Restarted(left), Health::Doubtful) => Self::Restarted(left),
            (Self::Restarted(left @ 1..), Health::Good) => Self::Restarted(left - 1),
            (Self::Fault, _) => Self::SafeStop,
            (Self::Init | Self::Standby | Self::Active, _) => match request {
                Some(Request::Move) => Self::Active,
                Some(Request::Rest) => Self::Standby,
                None if self == Self::Active => Self::SafeStop,
                None => Self::Standby,
            },
            (Self::Restarted(_) | Self::SafeStop, _) => match commanded {
                Some(Commanded { request: Request::Rest, frames }) if frames >= REARM_FRAMES => {
                    Self::Standby
                }
                _ => Self::SafeStop,
            },
        }
    }

    /// Why a command is not carried out in this state, which followed on `before`.
    pub(crate) fn refusal(self, before: Self, commanded: Option<Commanded>) -> Option<Refusal> {
        let moves = commanded.is_some_and(|c| c.request == Request::Move);
        match self {
            Self::SafeStop if before == Self::Active => Some(Refusal::Deadline),
            Self::SafeStop | Self::Restarted(_) if moves => Some(Refusal::Rearm),
            Self::Fault | Self::Init if moves => Some(Refusal::SensorFault),
            _ => None,
        }
    }
}

impl State {
    /// Its number on the wire.
    pub(crate) const fn number(self) -> u8 {
        match self {
            Self::Init | Self::Restarted(_) => 0,
            Self::Standby => 1,
            Self::Active => 2,
            Self::SafeStop => 3,
            Self::Fault => 4,
        }
    }
}

macro_rules! on_the_wire {
    ($($wire:ident),*) => {
        $(impl From<State> for $wire {
            fn from(state: State) -> Self {
                match state {
                    State::Init | State::Restarted(_) => Self::Init,
                    State::Standby => Self::Standby,
                    State::Active => Self::Active,
                    State::SafeStop => Self::SafeStop,
                    State::Fault => Self::Fault,
                }
            }
        })*
    };
}

on_the_wire!(ArmStatusState, DriveStatusState);

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const MOVE: Option<Commanded> = Some(Commanded { request: Request::Move, frames: 9 });
    const REST: Option<Commanded> = Some(Commanded { request: Request::Rest, frames: 9 });

    #[test]
    fn a_stream_from_the_start_is_active_at_once() {
        assert_eq!(State::Init.next(Health::Good, MOVE), State::Active);
        assert_eq!(State::Init.next(Health::Good, None), State::Standby);
        assert_eq!(State::Standby.next(Health::Good, MOVE), State::Active);
        assert_eq!(State::Init.next(Health::Doubtful, MOVE), State::Init);
    }

    #[test]
    fn a_safe_stop_ends_with_rest_and_only_then() {
        assert_eq!(State::Active.next(Health::Good, None), State::SafeStop);
        assert_eq!(State::SafeStop.next(Health::Good, MOVE), State::SafeStop);
        assert_eq!(State::SafeStop.next(Health::Good, None), State::SafeStop);
        assert_eq!(State::SafeStop.next(Health::Good, REST), State::Standby);
        for (frames, next) in [(1, State::SafeStop), (2, State::SafeStop), (3, State::Standby)] {
            let back = Some(Commanded { request: Request::Rest, frames });
            assert_eq!(State::SafeStop.next(Health::Good, back), next, "{frames}");
        }
    }

    #[test]
    fn a_fault_ends_in_a_safe_stop() {
        assert_eq!(State::Fault.next(Health::Broken, REST), State::Fault);
        assert_eq!(State::Fault.next(Health::Good, MOVE), State::SafeStop);
    }

    #[test]
    fn a_restart_tests_itself_then_waits_for_rest() {
        let mut state = SELF_TEST;
        for _ in 0..10 {
            state = state.next(Health::Good, MOVE);
            assert!(matches!(state, State::Restarted(_)));
            assert_eq!(ArmStatusState::from(state), ArmStatusState::Init);
            assert_eq!(state.refusal(state, MOVE), Some(Refusal::Rearm));
        }
        assert_eq!(state.next(Health::Doubtful, REST), state);
        assert_eq!(state.next(Health::Good, MOVE), State::SafeStop);
        assert_eq!(state.next(Health::Good, None), State::SafeStop);
        assert_eq!(state.next(Health::Good, REST), State::Standby);
    }

    fn any_state() -> impl Strategy<Value = State> {
        use State::{Active, Fault, Init, Restarted, SafeStop, Standby};
        let all = vec![Init, Restarted(1), Restarted(0), Standby, Active, SafeStop, Fault];
        prop::sample::select(all)
    }

    proptest! {
        #[test]
        fn active_needs_health_and_a_command(
            state in any_state(),
            health in prop::sample::select(vec![Health::Good, Health::Doubtful, Health::Broken]),
            commanded in prop::sample::select(vec![None, MOVE, REST]),
        ) {
            let next = state.next(health, commanded);
            if next == State::Active {
                prop_assert_eq!(commanded, MOVE);
                prop_assert_ne!(health, Health::Broken);
                prop_assert!(matches!(state, State::Init | State::Standby | State::Active));
            }
        }
    }
}
