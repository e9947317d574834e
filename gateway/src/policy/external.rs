//! A controller that thinks elsewhere: it is shown observations, and what it answers holds until it answers again.
//!
//! Two ends of one desk. [`External`] is the policy in the gateway; [`Seat`] is where the controller, or what carries
//! its messages, sits. Neither waits for the other: an answer counts from the tick it is found at, and is as old as
//! the observation that it answers, so that the safety kernel sees a controller that falls behind.

use core::time::Duration;
use std::collections::VecDeque;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use xt28_machine::{Machine, SimTime};
use xt28_safety::Command;

use super::{Answer, Outcome, Pace, Policy, held};
use crate::{Action, ActionMap, Observation};

/// Observations that may still be answered. At 100 Hz, the last 0.64 s of them: the safety kernel takes what is older
/// than 0.375 s for lost.
const ANSWERABLE: usize = 64;

/// The gateway's end.
#[derive(Debug)]
pub struct External {
    pace: Pace,
    map: ActionMap,
    desk: Arc<Mutex<Desk>>,
    /// Where the front joint is held once the task is over, rad.
    held_rad: Option<f64>,
}

/// The controller's end.
#[derive(Clone, Debug)]
pub struct Seat(Arc<Mutex<Desk>>);

/// An observation with the number that an answer names.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seen {
    /// Counts from 1.
    pub seq: u64,
    /// What is seen.
    pub observation: Observation,
}

/// Why an answer is not taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Refusal {
    /// No such observation was shown.
    #[error("no observation has number {seq} yet; the newest is {newest}")]
    NotShown {
        /// The one named.
        seq: u64,
        /// The newest one.
        newest: u64,
    },
    /// It was shown long ago.
    #[error("observation {seq} is too old to be answered; the newest is {newest}")]
    TooOld {
        /// The one named.
        seq: u64,
        /// The newest one.
        newest: u64,
    },
    /// It, or a later one, was answered already.
    #[error("observation {seq} is no use any more: {answered} was answered already")]
    Overtaken {
        /// The one named.
        seq: u64,
        /// The one answered last.
        answered: u64,
    },
}

/// How a controller kept up.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Account {
    /// Observations that it was shown.
    pub shown: u64,
    /// Answers of it that were taken.
    pub answers: u64,
    /// From an observation to its answer, all together: whole ticks, as the gateway finds them.
    pub delay_sum: Duration,
    /// The longest.
    pub delay_max: Duration,
}

#[derive(Debug)]
struct Desk {
    account: Account,
    /// The newest one, until the controller takes it.
    fresh: Option<Seen>,
    /// When the last ones were put together and sensed, the newest last.
    lately: VecDeque<(SimTime, SimTime)>,
    /// The one answered last.
    answered: u64,
    /// The newest answer, until the gateway takes it.
    answer: Option<(Action, SimTime)>,
    outcome: Outcome,
}

impl Desk {
    const fn is_over(&self) -> bool {
        matches!(self.outcome, Outcome::Reached | Outcome::Failed(_))
    }
}

impl External {
    /// A desk and its two ends. The controller is shown an observation at each `pace`; its actions are those of
    /// `machine`.
    #[must_use]
    pub fn new(machine: &Machine, pace: Pace) -> (Self, Seat) {
        let desk = Arc::new(Mutex::new(Desk {
            account: Account::default(),
            fresh: None,
            lately: VecDeque::with_capacity(ANSWERABLE),
            answered: 0,
            answer: None,
            outcome: Outcome::Endless,
        }));
        let seat = Seat(Arc::clone(&desk));
        (Self { pace, map: ActionMap::new(machine), desk, held_rad: None }, seat)
    }
}

impl Policy for External {
    fn pace(&self) -> Pace {
        self.pace
    }

    fn act(&mut self, observation: &Observation) -> Option<Command> {
        let mut desk = lock(&self.desk);
        if desk.is_over() {
            // Nobody has to go on answering for a machine that only stands. One that is not armed by then need not be.
            observation.since_arming_s?;
            return Some(held(*self.held_rad.get_or_insert(observation.front_joint_rad), true));
        }
        desk.account.shown += 1;
        desk.fresh = Some(Seen { seq: desk.account.shown, observation: *observation });
        if desk.lately.len() == ANSWERABLE {
            desk.lately.pop_front();
        }
        desk.lately.push_back((observation.at, observation.sensed_at));
        None
    }

    fn answer(&mut self) -> Option<Answer> {
        let (action, sensed_at) = lock(&self.desk).answer.take()?;
        Some(Answer { command: self.map.command(&action), sensed_at })
    }

    fn outcome(&self) -> Outcome {
        lock(&self.desk).outcome.clone()
    }
}

impl Seat {
    /// The newest observation, once. Those that nobody took in time are gone.
    #[must_use]
    pub fn take(&self) -> Option<Seen> {
        lock(&self.0).fresh.take()
    }

    /// Whether the task is over.
    #[must_use]
    pub fn is_over(&self) -> bool {
        lock(&self.0).is_over()
    }

    /// Answers, at `now`, the observation of this number; nothing comes of it once the task is over. Values beyond -1 to 1 are held to the limits by the safety kernel.
    ///
    /// # Errors
    /// [`Refusal`]: there is no such observation, or it is no use any more. The last answer stays in force.
    pub fn answer(&self, now: SimTime, seq: u64, action: Action) -> Result<(), Refusal> {
        let mut desk = lock(&self.0);
        if desk.is_over() {
            return Ok(());
        }
        let (newest, answered) = (desk.account.shown, desk.answered);
        if seq == 0 || seq > newest {
            return Err(Refusal::NotShown { seq, newest });
        }
        let back = usize::try_from(newest - seq).unwrap_or(usize::MAX);
        let Some(&(at, sensed_at)) = desk.lately.iter().rev().nth(back) else {
            return Err(Refusal::TooOld { seq, newest });
        };
        if seq <= answered {
            return Err(Refusal::Overtaken { seq, answered });
        }
        let delay = now.since(at);
        desk.account.answers += 1;
        desk.account.delay_sum += delay;
        desk.account.delay_max = desk.account.delay_max.max(delay);
        desk.answered = seq;
        desk.answer = Some((action, sensed_at));
        Ok(())
    }

    /// Whether nothing is left to be answered: the newest observation was, or there is none, or the task is over.
    #[must_use]
    pub fn is_answered(&self) -> bool {
        let desk = lock(&self.0);
        desk.answered == desk.account.shown || desk.is_over()
    }

    /// The number of the newest observation and of the one answered last; 0 is none.
    #[must_use]
    pub fn owed(&self) -> (u64, u64) {
        let desk = lock(&self.0);
        (desk.account.shown, desk.answered)
    }

    /// How the controller has kept up so far.
    #[must_use]
    pub fn account(&self) -> Account {
        lock(&self.0).account
    }

    /// Says that the task is over, and how; once. The machine is then held, and no more answers are asked for.
    pub fn conclude(&self, outcome: Outcome) {
        let mut desk = lock(&self.0);
        if !desk.is_over() {
            desk.outcome = outcome;
            desk.answer = None;
        }
    }
}

/// Nobody leaves the desk in disorder: each holds it for a few assignments.
fn lock(desk: &Mutex<Desk>) -> MutexGuard<'_, Desk> {
    desk.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use xt28_machine::PerWheel;
    use xt28_safety::Arms;

    use super::*;
    use crate::Attitude;

    fn seen(at_ms: u64) -> Observation {
        let zero = PerWheel::splat(0.0);
        Observation {
            at: SimTime::from_millis(at_ms),
            sensed_at: SimTime::from_millis(at_ms - 5),
            since_arming_s: Some(0.0),
            located: None,
            attitude: Attitude::default(),
            stroke_m: zero,
            load_n: zero,
            wheel_speed_rad_s: zero,
            wheel_speed_m_s: 0.0,
            front_joint_rad: 0.3,
            rear_joint_rad: 0.0,
            previous_action: Action::default(),
        }
    }

    #[test]
    fn an_answer_is_as_old_as_what_it_answers_and_holds_once() {
        let (mut policy, seat) = External::new(&Machine::xt28(), Pace::Fix);
        assert!(seat.take().is_none() && policy.answer().is_none() && seat.is_answered());
        for at_ms in [125, 250] {
            assert_eq!(policy.act(&seen(at_ms)), None);
        }
        let shown = seat.take().unwrap();
        assert_eq!((shown.seq, shown.observation), (2, seen(250)));
        assert!(seat.take().is_none() && !seat.is_answered());
        seat.answer(SimTime::from_millis(2000), 1, Action([0.5; 8])).unwrap();
        let answer = policy.answer().unwrap();
        assert_eq!(answer.sensed_at, SimTime::from_millis(120));
        assert_eq!(answer.command, ActionMap::new(&Machine::xt28()).command(&Action([0.5; 8])));
        assert!(policy.answer().is_none());
        seat.answer(SimTime::from_millis(2000), 2, Action::default()).unwrap();
        assert!(seat.is_answered());
        let account = seat.account();
        assert_eq!((account.shown, account.answers), (2, 2));
        assert_eq!(account.delay_max, Duration::from_millis(1875));
        assert_eq!(account.delay_sum, Duration::from_millis(1875 + 1750));
    }

    #[test]
    fn what_was_not_shown_is_too_old_or_comes_too_late_is_no_answer() {
        let (mut policy, seat) = External::new(&Machine::xt28(), Pace::Tick);
        let none = Action::default();
        assert_eq!(
            seat.answer(SimTime::from_millis(2000), 0, none),
            Err(Refusal::NotShown { seq: 0, newest: 0 })
        );
        for tick in 1..=100 {
            policy.act(&seen(10 * tick));
        }
        assert_eq!(
            seat.answer(SimTime::from_millis(2000), 101, none),
            Err(Refusal::NotShown { seq: 101, newest: 100 })
        );
        assert_eq!(
            seat.answer(SimTime::from_millis(2000), 36, none),
            Err(Refusal::TooOld { seq: 36, newest: 100 })
        );
        seat.answer(SimTime::from_millis(2000), 37, none).unwrap();
        assert_eq!(policy.answer().unwrap().sensed_at, SimTime::from_millis(365));
        seat.answer(SimTime::from_millis(2000), 90, none).unwrap();
        assert_eq!(
            seat.answer(SimTime::from_millis(2000), 90, none),
            Err(Refusal::Overtaken { seq: 90, answered: 90 })
        );
        assert_eq!(
            seat.answer(SimTime::from_millis(2000), 89, none),
            Err(Refusal::Overtaken { seq: 89, answered: 90 })
        );
        assert_eq!(policy.answer().unwrap().sensed_at, SimTime::from_millis(895));
    }

    #[test]
    fn a_task_that_is_over_holds_the_machine_without_answers() {
        let (mut policy, seat) = External::new(&Machine::xt28(), Pace::Fix);
        policy.act(&seen(125));
        seat.answer(SimTime::from_millis(2000), 1, Action([1.0; 8])).unwrap();
        seat.conclude(Outcome::Reached);
        seat.answer(SimTime::from_millis(2000), 1, Action([1.0; 8])).unwrap();
        assert!(policy.answer().is_none() && seat.is_answered());
        let unarmed = Observation { since_arming_s: None, ..seen(250) };
        assert_eq!(policy.act(&unarmed), None, "what is not armed stays so");
        for drifted_rad in [0.3, 0.2] {
            let (since_arming_s, front_joint_rad) = (Some(1.0), drifted_rad);
            let armed = Observation { since_arming_s, front_joint_rad, ..seen(250) };
            let held = policy.act(&armed).unwrap();
            assert!(held.brake && held.throttle == 0.0 && held.front_angle_rad == 0.3);
            assert_eq!(held.arms, Arms::Position([None; 6]));
        }
        seat.conclude(Outcome::Failed("too late".to_owned()));
        assert_eq!(policy.outcome(), Outcome::Reached);
    }
}
