//! Wheel speeds: frequencies to counts, without direction (facts 4.8).

use xt28_machine::{PerWheel, Wheel};

use crate::DrivePins;
use crate::firmware_2016::Quirks;
use crate::firmware_2016::whole::cut;

/// Counts for each unit of frequency at the motor: 60 s in a minute, tenths, 67 pulses.
const COUNTS: f64 = 600.0;
const PULSES: f64 = 67.0;
const GEAR: f64 = 48.3;
/// Highest frequency that an input counts, Hz (assumed).
const INPUT_MAX_HZ: f64 = 10_000.0;
/// Wheel radius in the display's formula, m, which takes counts for tenths of rpm.
const RADIUS_M: f64 = 0.74;
const RAD_S_PER_COUNT: f64 = 0.1 * core::f64::consts::TAU / 60.0;

/// Speeds of wheels 1 to 6, counts.
pub(super) fn counts(pins: &DrivePins, quirks: Quirks) -> PerWheel<i32> {
    let per_hz = if quirks.frequency_in_tenths_of_hz { 10.0 } else { 1.0 };
    let count = |w: Wheel| {
        // What is not a number is cut to zero.
        let input = cut(pins.wheel_hz[w].clamp(0.0, INPUT_MAX_HZ) * per_hz);
        cut((f64::from(input) * COUNTS / PULSES).trunc() / GEAR)
    };
    PerWheel::from_fn(|w| match w {
        Wheel::Br if quirks.speed_inputs_5_6_crossed => count(Wheel::Bl),
        Wheel::Bl if quirks.speed_inputs_5_6_crossed => count(Wheel::Br),
        w => count(w),
    })
}

/// Mean of the six, whole; 1 in place of 0.
pub(super) fn mean(counts: &PerWheel<i32>) -> i32 {
    (counts.0.iter().sum::<i32>() / 6).max(1)
}

/// What the display is told: m/s by the formula, tenths of m/s as the counts are.
pub(super) fn shown(mean: i32) -> i32 {
    cut(f64::from(mean) * RAD_S_PER_COUNT * RADIUS_M)
}

#[cfg(test)]
mod tests {
    use xt28_machine::PerWheel;

    use super::*;

    fn pins(wheel_hz: [f64; 6]) -> DrivePins {
        DrivePins {
            joint_front_mv: 3296.0,
            joint_rear_mv: 2244.0,
            wheel_hz: PerWheel(wheel_hz),
            wheel_forward: PerWheel::splat(true),
            pump_mv: [500.0; 4],
            supply_mv: 24_000.0,
        }
    }

    /// Facts 4.8: 3.6 km/h is 12.9 rpm and 696 Hz, which the display calls 10.
    #[test]
    fn counts_are_hundredths_of_rpm_or_tenths() {
        let walking = pins([696.0; 6]);
        let count = counts(&walking, Quirks::firmware()).0[0];
        assert!((1289..=1291).contains(&count), "{count}");
        assert_eq!(shown(1291), 10);
        let in_hz = Quirks { frequency_in_tenths_of_hz: false, ..Quirks::firmware() };
        assert!((128..=129).contains(&counts(&walking, in_hz).0[0]));
    }

    #[test]
    fn inputs_5_and_6_change_places() {
        let apart = pins([100.0, 200.0, 300.0, 400.0, 500.0, 600.0]);
        let firmware = counts(&apart, Quirks::firmware()).0;
        let straight = counts(&apart, Quirks::none()).0;
        assert_eq!([firmware[4] > firmware[5], straight[4] > straight[5]], [true, false]);
    }

    #[test]
    fn a_standing_machine_counts_one_on_average() {
        assert_eq!(mean(&counts(&pins([f64::NAN, -5.0, 0.0, 0.0, 0.0, 0.0]), Quirks::none())), 1);
    }
}
