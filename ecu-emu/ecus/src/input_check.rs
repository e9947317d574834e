//! Diagnosis of inputs: out of range for long enough is broken (facts 3.2).

use core::ops::RangeInclusive;
use core::time::Duration;

use xt28_machine::SimTime;

use crate::life::Health;

/// Out of this window an input is short or open, mV (facts 3.2).
const WINDOW_MV: RangeInclusive<f64> = 200.0..=4800.0;
/// For this long it is doubted before it counts as broken (facts 3.2).
const DEBOUNCE: Duration = Duration::from_millis(200);
/// Supply of a 24 V vehicle net, V (assumed).
const SUPPLY_V: RangeInclusive<f64> = 18.0..=32.0;
/// What the status frames can say of it, V.
const SUPPLY_MAX_V: f64 = 51.0;

/// Watches one input.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct InputCheck {
    doubted_since: Option<SimTime>,
}

impl InputCheck {
    /// What `mv` at `now` says of the input. A value that is not a number is out of range.
    pub(crate) fn check(&mut self, now: SimTime, mv: f64) -> Health {
        if WINDOW_MV.contains(&mv) {
            self.doubted_since = None;
            return Health::Good;
        }
        let since = *self.doubted_since.get_or_insert(now);
        if now.since(since) >= DEBOUNCE { Health::Broken } else { Health::Doubtful }
    }
}

/// The worst of several inputs. All are checked, so that each keeps its own time.
pub(crate) fn worst(checks: &mut [InputCheck], now: SimTime, mv: &[f64]) -> Health {
    let states = checks.iter_mut().zip(mv).map(|(check, mv)| check.check(now, *mv));
    states.max().unwrap_or(Health::Good)
}

/// The supply voltage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Supply {
    volts: f64,
}

impl Supply {
    /// At `mv`; what is not a number is none.
    pub(crate) fn read(mv: f64) -> Self {
        let volts = if mv.is_nan() { 0.0 } else { (mv * 1e-3).clamp(0.0, SUPPLY_MAX_V) };
        Self { volts }
    }

    pub(crate) const fn volts(self) -> f64 {
        self.volts
    }

    pub(crate) fn is_bad(self) -> bool {
        !SUPPLY_V.contains(&self.volts)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn broken_after_200_ms_and_good_at_once() {
        let mut check = InputCheck::default();
        assert_eq!(check.check(SimTime::from_millis(0), 199.0), Health::Doubtful);
        assert_eq!(check.check(SimTime::from_millis(190), f64::NAN), Health::Doubtful);
        assert_eq!(check.check(SimTime::from_millis(200), 4801.0), Health::Broken);
        assert_eq!(check.check(SimTime::from_millis(210), 4800.0), Health::Good);
        assert_eq!(check.check(SimTime::from_millis(220), 0.0), Health::Doubtful);
    }

    #[test]
    fn the_worst_input_counts() {
        let mut checks = [InputCheck::default(); 3];
        assert_eq!(worst(&mut checks, SimTime::ZERO, &[500.0, 0.0, 0.0]), Health::Doubtful);
        let later = SimTime::from_millis(200);
        assert_eq!(worst(&mut checks, later, &[500.0, 900.0, 0.0]), Health::Broken);
    }
}
