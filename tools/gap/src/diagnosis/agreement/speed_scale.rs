//! Whether wheel speeds are on the scale of what the receiver and the throttle say, and of the same sign: a wrong
//! factor in a DBC makes a machine that slides over any ground.

use core::fmt;

use xt28_machine::Machine;

use crate::diagnosis::signals::{DT_S, Signals};

/// Time over which ways are held against one another, s.
const SPAN_S: f64 = 2.0;
/// How many times more or less than the others the wheels may say: a sensor's pulses, a tyre, ground that gives
/// way or another machine's speed at full throttle, not another unit.
const TIMES_MAX: f64 = 4.0;
/// Ways that are shorter in all, m, say nothing.
const WAY_MIN_M: f64 = 0.5;
/// The way over ground is the wheels' own, on whatever scale, where the two go along like this, or against one
/// another.
const ALONG: f64 = 0.8;

/// Wheel speeds that neither the receiver nor the throttle bears out, or a throttle that the two deny.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpeedScale {
    /// The way that the wheels roll over the one that the receiver goes; less than zero where they roll back.
    pub over_receiver: f64,
    /// The same over the one that the throttle asks for.
    pub over_throttle: f64,
}

/// Ways over one span, m, ahead > 0: the wheels', the receiver's, the throttle's.
type Ways = [f64; 3];

/// By how much the wheel speeds of all `runs` are off, where receiver and throttle both say so. Wheels that spin
/// do what the throttle asks; a throttle on another scale leaves wheels and receiver agreed, and only its sign is
/// told, for a drive may be weak.
pub(super) fn speed_scale(runs: &[Signals], machine: &Machine) -> Option<SpeedScale> {
    let all: Vec<Ways> = runs.iter().flat_map(|s| ways_m(s, machine)).collect();
    let both = |a: usize, b: usize| all.iter().map(|ways| ways[a] * ways[b]).sum::<f64>();
    let way_m = |k: usize| all.iter().map(|ways| ways[k].abs()).sum::<f64>();
    let along = |other: usize| both(0, other) / (both(0, 0) * both(other, other)).sqrt();
    if (0..3).any(|k| way_m(k) < WAY_MIN_M) || along(1).abs() < ALONG {
        return None;
    }
    let over = |other: usize| both(0, 0) / both(0, other);
    let scale = SpeedScale { over_receiver: over(1), over_throttle: over(2) };
    let each = [scale.over_receiver, scale.over_throttle];
    let is_off = each.iter().all(|times| *times > TIMES_MAX)
        || each.iter().all(|times| *times < 1.0 / TIMES_MAX)
        || (scale.over_receiver > 0.0 && along(2) < -ALONG);
    is_off.then_some(scale)
}

/// Ways from fix to fix, some seconds apart each.
fn ways_m(s: &Signals, machine: &Machine) -> Vec<Ways> {
    let asked_m_s = |i: usize| machine.drive.speed_full_m_s * s.throttle[i];
    let rolled_m_s = |i: usize| machine.wheels.radius_m * s.mean_wheel_speed_rad_s(i);
    let Some(mut from) = s.fixes.first() else { return Vec::new() };
    let mut all = Vec::new();
    for to in s.fixes.iter().filter(|fix| fix[0] < s.duration_s()) {
        if to[0] - from[0] < SPAN_S {
            continue;
        }
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let [first, last] = [from[0], to[0]].map(|at_s| (at_s / DT_S) as usize);
        let way_m = |speed_m_s: &dyn Fn(usize) -> f64| {
            (first..last).map(|i| speed_m_s(i) * DT_S).sum::<f64>()
        };
        let rolled_m = way_m(&rolled_m_s);
        all.push([rolled_m, over_ground_m(s, [from, to], rolled_m), way_m(&asked_m_s)]);
        from = to;
    }
    all
}

/// The way from one fix to another, m, ahead > 0; where no heading tells which way is ahead, it is `rolled_m`'s.
fn over_ground_m(s: &Signals, [from, to]: [&[f64; 3]; 2], rolled_m: f64) -> f64 {
    let [east_m, north_m] = [to[1] - from[1], to[2] - from[2]];
    let ahead = |[heading, _]: [f64; 2]| east_m * heading.cos() + north_m * heading.sin();
    let ahead_m = s.heading_at(0.5 * (from[0] + to[0])).map_or(rolled_m, ahead);
    east_m.hypot(north_m).copysign(ahead_m)
}

impl SpeedScale {
    /// What is to be mended, as a user calls it.
    #[must_use]
    pub fn to_mend(&self) -> &'static str {
        let is_throttle = self.over_receiver > 0.0 && self.over_throttle < 0.0;
        if is_throttle { "the throttle" } else { "the wheel speeds" }
    }
}

impl fmt::Display for SpeedScale {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { over_receiver, over_throttle } = self;
        write!(
            f,
            "{over_receiver:.2} times the way that the receiver goes and {over_throttle:.2} times the one that \
             the throttle asks for"
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Channel, Series, Terrain};

    /// A machine that is asked for 0.75 m/s for 20 s: how fast wheels are said to turn beside that, and how fast
    /// it goes over ground.
    fn driven(wheels: f64, ground: f64) -> [Signals; 1] {
        let series = |value: &dyn Fn(f64) -> f64| -> Series {
            (0..2000).map(|i| f64::from(i) * 0.01).map(|at_s| (at_s, value(at_s))).collect()
        };
        let reads = |channel: Channel| match channel {
            Channel::WheelSpeed(_) => series(&|_| wheels * 0.75 / 0.74),
            Channel::Throttle => series(&|_| 0.5),
            Channel::East => series(&|at_s| ground * 0.75 * at_s),
            _ => series(&|_| 0.0),
        };
        let all = Channel::all().into_iter().map(|channel| (channel, reads(channel)));
        [Signals::of_series("made up", &all.collect(), 20.0, Terrain::Flat).unwrap()]
    }

    #[test]
    fn another_factor_is_told_with_what_it_is_held_against() {
        let told =
            speed_scale(&driven(10.0, 1.0), &Machine::xt28()).expect("a factor of ten").to_string();
        assert!(told.starts_with("10.00 times the way that the receiver goes and 10.00"), "{told}");
        assert!(speed_scale(&driven(0.1, 1.0), &Machine::xt28()).is_some());
    }

    #[test]
    fn wheels_that_roll_back_while_the_machine_goes_ahead_are_told_and_so_is_a_throttle_that_asks_for_it()
     {
        let told = speed_scale(&driven(-1.0, 1.0), &Machine::xt28()).expect("the other way");
        assert!(told.to_string().starts_with("-1.00 times the way that the receiver"), "{told}");
        assert_eq!(told.to_mend(), "the wheel speeds");
        let [mut signals] = driven(1.0, 1.0);
        signals.throttle.iter_mut().for_each(|throttle| *throttle *= -1.0);
        let told = speed_scale(&[signals], &Machine::xt28()).expect("the throttle is turned");
        assert_eq!(told.to_mend(), "the throttle");
        assert_eq!(
            speed_scale(&driven(1.0, -1.0), &Machine::xt28()),
            None,
            "a heading from the stern is told as that"
        );
    }

    /// Wheels that spin, a slow drive, a standing machine, a throttle or a receiver on another scale.
    #[test]
    fn what_a_machine_can_do_is_not_complained_of() {
        for (wheels, ground) in [(1.0, 1.0), (1.0, 0.1), (0.2, 0.2), (0.0, 0.0), (1.0, 10.0)] {
            assert_eq!(
                speed_scale(&driven(wheels, ground), &Machine::xt28()),
                None,
                "{wheels} {ground}"
            );
        }
        let [mut signals] = driven(1.0, 1.0);
        signals.throttle.iter_mut().for_each(|throttle| *throttle *= 0.1);
        assert_eq!(speed_scale(&[signals], &Machine::xt28()), None, "the throttle is off");
        let [mut signals] = driven(10.0, 1.0);
        signals.fixes.clear();
        assert_eq!(speed_scale(&[signals], &Machine::xt28()), None, "there is no receiver");
    }
}
