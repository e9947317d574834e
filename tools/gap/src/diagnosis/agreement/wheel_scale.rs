//! Whether each wheel's speed is on the scale of the other five, and of the same sign: a wrong factor of one in a
//! DBC makes a wheel that slips wherever the machine goes.

use core::fmt;

use xt28_machine::{Machine, Wheel};

use super::COMPARED_EVERY;
use super::along::Along;
use crate::diagnosis::signals::{SMOOTHED, Signals};

/// Root mean square of a speed that is too little to tell a scale by, rad/s: 0.07 m/s.
const TURNS_RAD_S: f64 = 0.1;
/// How many times more or less than others a wheel may turn: one that is lifted, that digs itself in, a sensor's
/// pulses, not another unit.
const TIMES_MAX: f64 = 4.0;

/// Wheels whose speeds neither the other wheels nor the throttle bear out.
#[derive(Clone, Debug, PartialEq)]
pub struct WheelScale {
    /// Each, with how many times the middle one of the others it turns; less than zero where it turns the other way.
    pub wheels: Vec<(Wheel, f64)>,
}

/// The wheels of all `runs` that turn beyond what a wheel does beside the others, and beside what the throttle asks:
/// where half the wheels are off nobody knows which of themselves, and where all are it is one drive's matter.
pub(super) fn wheel_scale(runs: &[Signals], machine: &Machine) -> Option<WheelScale> {
    let full_rad_s = machine.drive.speed_full_m_s / machine.wheels.radius_m;
    let off = |wheel: Wheel| {
        let over = |other: &dyn Fn(&Signals, usize) -> f64| {
            let pairs =
                |s| samples(s).map(move |i| [other(s, i), s.smooth_wheel_speed_rad_s[wheel][i]]);
            times(runs.iter().flat_map(pairs))
        };
        let over_others = over(&|s, i| middle_rad_s(s, wheel, i))?;
        let over_throttle = over(&|s, i| full_rad_s * s.throttle[i.saturating_sub(SMOOTHED)])?;
        let both = [over_others, over_throttle];
        let is_off = both.iter().all(|times| *times > TIMES_MAX)
            || both.iter().all(|times| *times < 1.0 / TIMES_MAX);
        is_off.then_some((wheel, over_others))
    };
    let wheels: Vec<_> = Wheel::ALL.into_iter().filter_map(off).collect();
    (!wheels.is_empty()).then_some(WheelScale { wheels })
}

/// The samples of a run that are looked at.
fn samples(s: &Signals) -> impl Iterator<Item = usize> {
    (0..s.len).step_by(COMPARED_EVERY)
}

/// The middle one of the speeds of all wheels but one, rad/s: one more that is off moves it little.
fn middle_rad_s(s: &Signals, but: Wheel, i: usize) -> f64 {
    let others = Wheel::ALL.into_iter().filter(|wheel| *wheel != but);
    let mut speeds: Vec<f64> = others.map(|wheel| s.smooth_wheel_speed_rad_s[wheel][i]).collect();
    speeds.sort_by(f64::total_cmp);
    speeds[speeds.len() / 2]
}

/// How many times what is told a speed is; nothing where little turns or another thing is read.
fn times(pairs: impl Iterator<Item = [f64; 2]>) -> Option<f64> {
    let along = Along::of(pairs);
    let [told_rad_s, _] = along.means();
    along.times().filter(|_| told_rad_s > TURNS_RAD_S)
}

impl fmt::Display for WheelScale {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let each = self
            .wheels
            .iter()
            .map(|(wheel, times)| format!("wheel_speed.{wheel} {times:.2} times"));
        write!(f, "{}", each.collect::<Vec<_>>().join(", "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Channel, Series, Terrain};

    /// A machine that is asked for 0.75 m/s for 20 s, ahead and then back, whose wheels are said to turn so many
    /// times as fast.
    fn driven(times: impl Fn(Wheel) -> f64) -> [Signals; 1] {
        let series = |value: f64| -> Series {
            let sense = |i: i32| if i < 1200 { 1.0 } else { -1.0 };
            (0..2000).map(|i| (f64::from(i) * 0.01, sense(i) * value)).collect()
        };
        let reads = |channel: Channel| match channel {
            Channel::WheelSpeed(wheel) => times(wheel) * 0.75 / 0.74,
            Channel::Throttle => 0.5,
            _ => 0.0,
        };
        let all = Channel::all().into_iter().map(|channel| (channel, series(reads(channel))));
        [Signals::of_series("made up", &all.collect(), 20.0, Terrain::Flat).unwrap()]
    }

    #[test]
    fn a_wheel_of_another_scale_or_sign_is_told_by_its_name() {
        for wheel in Wheel::ALL {
            for factor in [-1.0, 10.0, 0.1] {
                let found = wheel_scale(
                    &driven(|w| if w == wheel { factor } else { 1.0 }),
                    &Machine::xt28(),
                );
                let told = found.expect("it is off").to_string();
                assert_eq!(told, format!("wheel_speed.{wheel} {factor:.2} times"));
            }
        }
    }

    #[test]
    fn wheels_of_one_side_that_count_the_other_way_are_told_and_the_others_are_not() {
        let right = [Wheel::Fr, Wheel::Mr, Wheel::Br];
        let found =
            wheel_scale(&driven(|w| if right.contains(&w) { -1.0 } else { 1.0 }), &Machine::xt28());
        let found = found.expect("three are turned");
        assert_eq!(found.wheels.iter().map(|(wheel, _)| *wheel).collect::<Vec<_>>(), right);
    }

    /// A sensor's pulses, a lifted wheel that spins, one that does not turn, and what all six have alike.
    #[test]
    fn what_a_wheel_can_do_is_not_complained_of() {
        for factor in [0.85, 1.15, 3.0, 0.0] {
            let one = driven(|w| if w == Wheel::Ml { factor } else { 1.0 });
            assert_eq!(wheel_scale(&one, &Machine::xt28()), None, "{factor}");
        }
        for factor in [-1.0, 10.0, 0.0] {
            assert_eq!(
                wheel_scale(&driven(|_| factor), &Machine::xt28()),
                None,
                "{factor}: of all"
            );
        }
    }
}
