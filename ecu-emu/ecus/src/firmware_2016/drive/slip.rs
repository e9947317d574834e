//! The slip controller: a wheel faster than the mean loses displacement, slowly (facts 4.5).

use xt28_machine::PerWheel;

use crate::firmware_2016::Quirks;
use crate::firmware_2016::whole::cut;

const GAIN_WRITTEN: f64 = 2.6;
const GAIN_STORED: f64 = 2.0;
/// Share of the last value that a tick keeps: 0.10 Hz up to this mean speed, 0.02 Hz above it.
const SLOW_UP_TO_COUNTS: i32 = 500;
const KEEP_SLOW: f64 = keep(0.10);
const KEEP_FAST: f64 = keep(0.02);

/// Share that a first-order filter of `hz` keeps at 100 Hz.
const fn keep(hz: f64) -> f64 {
    let rc_s = 1.0 / (core::f64::consts::TAU * hz);
    rc_s / (rc_s + 0.01)
}

/// The filters of the six motors.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Slip {
    filtered: PerWheel<f64>,
}

impl Slip {
    /// Displacement to take off each motor, per mille, from speeds in counts and their mean.
    pub(super) fn step(
        &mut self,
        counts: &PerWheel<i32>,
        mean: i32,
        quirks: Quirks,
    ) -> PerWheel<i32> {
        let keep = if mean <= SLOW_UP_TO_COUNTS { KEEP_SLOW } else { KEEP_FAST };
        let gain = if quirks.slip_gain_cut_to_2 { GAIN_STORED } else { GAIN_WRITTEN };
        self.filtered = PerWheel::from_fn(|w| {
            let x = gain * f64::from(counts[w] - mean);
            let value = keep * self.filtered[w] + (1.0 - keep) * x;
            if quirks.filters_cut_off { value.trunc() } else { value }
        });
        self.filtered.map(cut)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What one wheel loses for good when it is `above` counts faster than a mean.
    fn settled(above: i32, mean: i32, quirks: Quirks) -> i32 {
        let mut slip = Slip::default();
        let counts = PerWheel([mean + above, mean, mean, mean, mean, mean]);
        (0..60_000).map(|_| slip.step(&counts, mean, quirks).0[0]).last().unwrap()
    }

    /// Facts 4.5: dead for |x| below 160 (0.10 Hz) or 797 (0.02 Hz), and that much less above.
    #[test]
    fn cut_off_filters_leave_it_dead() {
        let firmware = Quirks::firmware();
        assert_eq!([settled(80, 400, firmware), settled(-80, 400, firmware)], [0, 0]);
        assert!((settled(150, 400, firmware) - (300 - 160)).abs() <= 1);
        assert!((settled(398, 500, firmware) - (796 - 160)).abs() <= 1);
        assert_eq!(settled(398, 501, firmware), 0);
        assert!((settled(500, 501, firmware) - (1000 - 796)).abs() <= 1);
    }

    #[test]
    fn with_fractions_and_its_written_gain_it_would_act() {
        let fractions = Quirks { filters_cut_off: false, ..Quirks::firmware() };
        assert!((settled(80, 400, fractions) - 160).abs() <= 1);
        let gain = Quirks { slip_gain_cut_to_2: false, ..fractions };
        assert!((settled(80, 400, gain) - 208).abs() <= 1);
    }
}
