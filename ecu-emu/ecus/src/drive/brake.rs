//! The parking brake: as commanded, and by itself when the command is lost.
//!
//! A command closes it at any speed (assumed: the firmware's button needs less than 150 per mille of
//! filtered pedal, facts 4.4, and a throttle on the bus has no such filter). The safety kernel waits for
//! the machine to stand.

use core::time::Duration;

use xt28_machine::SimTime;

use crate::life::State;

/// Slower than this the machine counts as standing, m/s (assumed).
const STANDING_M_S: f64 = 0.02;
/// So long after a safe stop the brake is applied even to a machine that still rolls (assumed).
const ROLLING_MAX: Duration = Duration::from_secs(5);

/// The brake's logic. Released at the start, as the public firmware has it (facts 4.1).
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct ParkingBrake {
    applied: bool,
    /// Somebody has commanded it since it started.
    was_commanded: bool,
    stopping_since: Option<SimTime>,
}

impl ParkingBrake {
    /// Whether it is applied now. `commanded` is what a fresh command says of it. A brake that a
    /// safe stop applied stays on until a command releases it.
    ///
    /// A sender that falls silent is a stop in standby as well: one that had asked for rest while the machine
    /// still rolled can no longer brake it.
    pub(crate) fn step(
        &mut self,
        now: SimTime,
        state: State,
        commanded: Option<bool>,
        speed_m_s: f64,
    ) -> bool {
        if matches!(state, State::Restarted(_)) {
            // Its spring closed the brake while the ECU was dark; nobody has asked to open it.
            self.applied = true;
        }
        self.was_commanded |= commanded.is_some();
        let is_deserted = self.was_commanded && commanded.is_none();
        let stops = matches!(state, State::SafeStop | State::Fault | State::Restarted(_));
        if !stops && !is_deserted {
            self.stopping_since = None;
            self.applied = commanded.unwrap_or(self.applied);
            return self.applied;
        }
        let since = *self.stopping_since.get_or_insert(now);
        let standing = speed_m_s.abs() < STANDING_M_S;
        self.applied |= standing || commanded == Some(true) || now.since(since) >= ROLLING_MAX;
        self.applied
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(ms: u64) -> SimTime {
        SimTime::from_millis(ms)
    }

    #[test]
    fn a_safe_stop_brakes_when_standing() {
        let mut brake = ParkingBrake::default();
        assert!(!brake.step(at(0), State::Active, Some(false), 1.0));
        assert!(!brake.step(at(10), State::SafeStop, None, 0.021));
        assert!(brake.step(at(20), State::SafeStop, None, -0.019));
        assert!(brake.step(at(30), State::SafeStop, Some(false), 0.1), "it stays on");
        assert!(brake.step(at(40), State::Standby, None, 0.0));
        assert!(!brake.step(at(50), State::Standby, Some(false), 0.0));
    }

    #[test]
    fn a_sender_that_asks_for_rest_and_falls_silent_leaves_no_rolling_machine() {
        let mut brake = ParkingBrake::default();
        assert!(!brake.step(at(0), State::Standby, None, 1.0), "nobody has commanded it yet");
        assert!(!brake.step(at(10), State::Standby, Some(false), 1.0));
        assert!(!brake.step(at(20), State::Standby, None, 1.0));
        assert!(!brake.step(at(5010), State::Standby, None, 1.0));
        assert!(brake.step(at(5020), State::Standby, None, 1.0));
        assert!(!brake.step(at(5030), State::Standby, Some(false), 1.0), "as it is told again");
        assert!(!brake.step(at(5040), State::Standby, None, 0.5));
        assert!(brake.step(at(5050), State::Standby, None, 0.01));
    }

    #[test]
    fn a_brake_that_a_restart_closed_stays_closed_until_commanded() {
        let mut brake = ParkingBrake::default();
        assert!(brake.step(at(0), State::Restarted(3), Some(false), 1.0));
        assert!(brake.step(at(10), State::SafeStop, Some(false), 1.0));
        assert!(brake.step(at(20), State::Standby, None, 0.0));
        assert!(!brake.step(at(30), State::Active, Some(false), 0.0));
    }

    #[test]
    fn a_machine_that_rolls_on_is_braked_after_five_seconds() {
        let mut brake = ParkingBrake::default();
        assert!(!brake.step(at(0), State::SafeStop, None, 1.0));
        assert!(!brake.step(at(4990), State::SafeStop, None, 1.0));
        assert!(brake.step(at(5000), State::SafeStop, None, 1.0));
    }
}
