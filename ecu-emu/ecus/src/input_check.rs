//! Diagnosis of inputs: out of range for long enough is broken (facts 3.2), and so is a reading that
//! leaps as nothing behind it can.

use core::ops::RangeInclusive;
use core::time::Duration;

use xt28_machine::SimTime;

use crate::diagnostics::trouble_code::Fmi;
use crate::life::Health;

/// Out of this window an input is short or open, mV (facts 3.2; the strokes FR and FL, from 450 mV on
/// there, are watched like the others: assumed).
const WINDOW_MV: RangeInclusive<f64> = 200.0..=4800.0;
/// Where an input without a sensor is pulled to, mV: the sensors' supply, within its tolerance
/// (assumed). What is above hangs on the battery.
const PULLED_UP_MAX_MV: f64 = 5_200.0;
/// For this long it is doubted before it counts as broken (facts 3.2).
const DEBOUNCE: Duration = Duration::from_millis(200);
/// What a leap adds to the score, which falls by one a task period.
const LEAP: u8 = 4;
/// A leap on top of this score is one too many: the third within four task periods. One alone is
/// a glitch.
const LEAPS_BROKEN: u8 = LEAP + 1;
/// The score of a sensor that does nothing but leap: it has to be quiet for 200 ms to be believed.
const SCORE_MAX: u8 = 20;
/// Supply of a 24 V vehicle net, V (assumed).
const SUPPLY_V: RangeInclusive<f64> = 18.0..=32.0;
/// What the status frames can say of it, V.
const SUPPLY_MAX_V: f64 = 51.0;

/// Whether an input at `mv` says anything; what is not a number does not.
pub(crate) fn in_range(mv: f64) -> bool {
    WINDOW_MV.contains(&mv)
}

/// Watches one input.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct InputCheck {
    doubted_since: Option<SimTime>,
    /// Most that the input can change in a task period, mV, if there is such a limit.
    step_max_mv: Option<f64>,
    last_mv: Option<f64>,
    score: u8,
    leaps: bool,
}

impl InputCheck {
    /// For an input that changes by no more than `step_max_mv` in a task period.
    pub(crate) fn of_motion(step_max_mv: f64) -> Self {
        Self { step_max_mv: Some(step_max_mv), ..Self::default() }
    }

    /// What `mv` at `now` says of the input, and how it fails if it is broken. A value that is not a
    /// number is out of range.
    pub(crate) fn test(&mut self, now: SimTime, mv: f64) -> (Health, Option<Fmi>) {
        if !in_range(mv) {
            // What comes back from out of range has not leapt.
            self.last_mv = None;
            let since = *self.doubted_since.get_or_insert(now);
            return if now.since(since) >= DEBOUNCE {
                (Health::Broken, Some(out_of_range(mv)))
            } else {
                (Health::Doubtful, None)
            };
        }
        self.doubted_since = None;
        if self.leaps(mv) { (Health::Broken, Some(Fmi::ChangeRate)) } else { (Health::Good, None) }
    }

    /// Whether the input was out of range at its last test.
    pub(crate) fn is_doubtful(&self) -> bool {
        self.doubted_since.is_some()
    }

    /// True from three leaps close together until the input has been quiet for a while.
    fn leaps(&mut self, mv: f64) -> bool {
        let Some(step_max_mv) = self.step_max_mv else { return false };
        let leapt = self.last_mv.replace(mv).is_some_and(|last| (mv - last).abs() > step_max_mv);
        if !leapt {
            self.score = self.score.saturating_sub(1);
        } else if self.score >= LEAPS_BROKEN {
            (self.score, self.leaps) = (SCORE_MAX, true);
        } else {
            self.score += LEAP;
        }
        self.leaps &= self.score > 0;
        self.leaps
    }
}

/// How an input that reads `mv`, out of range, is wired.
fn out_of_range(mv: f64) -> Fmi {
    match mv {
        low if low < *WINDOW_MV.start() => Fmi::Low,
        high if high > PULLED_UP_MAX_MV => Fmi::High,
        _ => Fmi::Open,
    }
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
        self.failure().is_some()
    }

    /// How it fails, if it does.
    pub(crate) fn failure(self) -> Option<Fmi> {
        match self.volts {
            low if low < *SUPPLY_V.start() => Some(Fmi::Low),
            high if high > *SUPPLY_V.end() => Some(Fmi::High),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(ms: u64) -> SimTime {
        SimTime::from_millis(ms)
    }

    #[test]
    fn broken_after_200_ms_and_good_at_once() {
        let mut check = InputCheck::default();
        assert_eq!(check.test(at(0), 199.0), (Health::Doubtful, None));
        assert_eq!(check.test(at(190), f64::NAN), (Health::Doubtful, None));
        assert_eq!(check.test(at(200), 4801.0), (Health::Broken, Some(Fmi::Open)));
        assert_eq!(check.test(at(210), 5201.0), (Health::Broken, Some(Fmi::High)));
        assert_eq!(check.test(at(220), -1.0), (Health::Broken, Some(Fmi::Low)));
        assert_eq!(check.test(at(230), 4800.0), (Health::Good, None));
        assert_eq!(check.test(at(240), 0.0), (Health::Doubtful, None));
    }

    #[test]
    fn one_leap_is_a_glitch_and_three_are_a_fault_until_it_is_quiet() {
        let mut check = InputCheck::of_motion(50.0);
        let mut test = |tick: u64, mv| check.test(at(10 * tick), mv).0;
        for tick in 0..20 {
            assert_eq!(test(tick, if tick < 10 { 1000.0 } else { 2000.0 }), Health::Good);
        }
        let broken: Vec<u64> = (20..40)
            .filter(|tick| test(*tick, 2000.0 + 100.0 * (tick % 2) as f64) == Health::Broken)
            .collect();
        assert_eq!(broken.first(), Some(&23), "the third leap");
        let quiet = (40..100).find(|tick| test(*tick, 2100.0) == Health::Good).unwrap();
        assert_eq!(quiet, 40 + u64::from(SCORE_MAX) - 1);
    }

    #[test]
    fn the_supply_fails_both_ways() {
        let fails = |mv| Supply::read(mv).failure();
        assert_eq!([17_999.0, 18_000.0, 32_000.0].map(fails), [Some(Fmi::Low), None, None]);
        assert_eq!([32_001.0, f64::NAN].map(fails), [Some(Fmi::High), Some(Fmi::Low)]);
    }
}
