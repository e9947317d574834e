//! The ECU's own supply: below a threshold it goes dark, and starts anew when the supply is back.

use core::time::Duration;

use xt28_machine::SimTime;

use crate::diagnostics::trouble_code::Fmi;

/// Below this the ECU resets: a controller for 8 to 32 V (assumed).
pub const RESET_BELOW_MV: f64 = 8_000.0;
/// Above this it starts again (assumed).
pub const START_ABOVE_MV: f64 = 9_000.0;
/// From the end of a reset to the first task period (assumed).
pub const BOOT: Duration = Duration::from_millis(250);

/// Why an ECU has just started.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Cause {
    /// The supply was too low, or away.
    Supply,
    /// Its reset line was pulled.
    Reset,
}

impl Cause {
    /// What it leaves in the fault memory, of the supply and of the controller, until the ECU is
    /// taken into use again.
    pub(crate) fn failures(cause: Option<Self>) -> [Option<Fmi>; 2] {
        match cause {
            Some(Self::Supply) => [Some(Fmi::FarBelow), None],
            Some(Self::Reset) => [None, Some(Fmi::Erratic)],
            None => [None, None],
        }
    }
}

/// What an ECU does in a task period.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Running {
    /// Its task.
    On,
    /// Its first task after a start.
    Started(Cause),
    /// Nothing: every output is off, no frame leaves.
    Off,
}

/// Follows the supply of one ECU. The bench begins with ECUs that run.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Power {
    state: State,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum State {
    #[default]
    On,
    Dark,
    Boots {
        until: SimTime,
        cause: Cause,
    },
}

impl Power {
    /// One task period with `supply_mv`; what is not a number is none.
    pub(crate) fn step(&mut self, now: SimTime, supply_mv: f64) -> Running {
        let low = supply_mv.is_nan() || supply_mv < RESET_BELOW_MV;
        match self.state {
            _ if low => self.state = State::Dark,
            State::Dark if supply_mv > START_ABOVE_MV => {
                self.state = State::Boots { until: now + BOOT, cause: Cause::Supply };
            }
            State::Boots { until, cause } if now >= until => {
                self.state = State::On;
                return Running::Started(cause);
            }
            State::On => return Running::On,
            State::Dark | State::Boots { .. } => {}
        }
        Running::Off
    }

    /// The reset line is pulled for a moment.
    pub(crate) fn reset(&mut self, now: SimTime) {
        if self.state != State::Dark {
            self.state = State::Boots { until: now + BOOT, cause: Cause::Reset };
        }
    }

    /// True while the ECU takes frames.
    pub(crate) fn is_on(&self) -> bool {
        self.state == State::On
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(ms: u64) -> SimTime {
        SimTime::from_millis(ms)
    }

    #[test]
    fn a_dip_ends_in_a_start_after_the_boot_time() {
        let mut power = Power::default();
        assert_eq!(power.step(at(0), 8_000.0), Running::On);
        assert_eq!(power.step(at(10), 7_999.0), Running::Off);
        assert_eq!(power.step(at(20), 8_500.0), Running::Off, "not yet enough to start");
        assert_eq!(power.step(at(30), 24_000.0), Running::Off);
        assert_eq!(power.step(at(270), 24_000.0), Running::Off);
        assert_eq!(power.step(at(280), 24_000.0), Running::Started(Cause::Supply));
        assert_eq!(power.step(at(290), 24_000.0), Running::On);
    }

    #[test]
    fn a_reset_does_the_same_and_a_dip_in_it_begins_anew() {
        let mut power = Power::default();
        power.reset(at(0));
        assert!(!power.is_on());
        assert_eq!(power.step(at(249), 24_000.0), Running::Off);
        assert_eq!(power.step(at(250), 24_000.0), Running::Started(Cause::Reset));
        power.reset(at(300));
        assert_eq!(power.step(at(310), f64::NAN), Running::Off);
        power.reset(at(320));
        assert_eq!(power.step(at(320), 24_000.0), Running::Off);
        assert_eq!(power.step(at(560), 24_000.0), Running::Off);
        assert_eq!(power.step(at(570), 24_000.0), Running::Started(Cause::Supply));
    }
}
