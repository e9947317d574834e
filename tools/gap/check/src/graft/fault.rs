//! One fault of reading: what it is called, where it can be, how large it is, and what it makes of readings.

use std::collections::BTreeMap;

use rand::Rng;
use rand_chacha::ChaCha8Rng;
use xt28_gap::{Channel, Series};
use xt28_sim::effects::Scope;

/// Time series by channel, as a log has them.
pub(super) type Readings = BTreeMap<Channel, Series>;

/// Something that can be wrong with readings.
#[derive(Debug)]
pub(super) struct Fault {
    /// As in an answer; that of the catalogue where it has it.
    pub(super) name: &'static str,
    /// What it can be on.
    pub(super) on: On,
    /// How bad it is.
    pub(super) parameters: &'static [Size],
    /// Lays it over readings: at which wheels, and how bad.
    pub(super) lay: fn(&mut Readings, Scope, &[f64]),
}

/// What a fault can be on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum On {
    /// The machine: it has no wheel.
    Machine,
    /// Any group of wheels.
    Wheels,
    /// Any group but all of them: a controller that uses their mean would have noticed.
    SomeWheels,
}

/// A number that says how bad it is; its unit is in its name.
#[derive(Debug)]
pub(super) struct Size {
    /// As in an answer.
    pub(super) name: &'static str,
    /// One of these ranges is picked, each as often, and a value within, all alike likely.
    pub(super) within: &'static [[f64; 2]],
}

impl Fault {
    /// Whether it is on wheels.
    #[cfg(test)]
    pub(super) fn has_wheels(&self) -> bool {
        self.on != On::Machine
    }

    /// Whether it can be on the wheels of `scope`.
    pub(super) fn can_be_on(&self, scope: Scope) -> bool {
        match self.on {
            On::Machine => scope == Scope::All,
            On::Wheels => true,
            On::SomeWheels => scope != Scope::All,
        }
    }

    /// How bad it is this time.
    pub(super) fn draw(&self, random: &mut ChaCha8Rng) -> Vec<f64> {
        let mut one = |size: &Size| {
            let [low, high] = size.within[random.random_range(0..size.within.len())];
            random.random_range(low..=high)
        };
        self.parameters.iter().map(&mut one).collect()
    }
}

/// Puts `new(instant in s, value)` in the place of every reading of `channel`; nothing where it was not logged.
pub(super) fn change(
    readings: &mut Readings,
    channel: Channel,
    mut new: impl FnMut(f64, f64) -> f64,
) {
    if let Some(series) = readings.get_mut(&channel) {
        *series = series.iter().map(|(at_s, value)| (at_s, new(at_s, value))).collect();
    }
}

/// Readings of `channel` through a first-order filter of `time_constant_s`.
pub(super) fn filter(readings: &mut Readings, channel: Channel, time_constant_s: f64) {
    let mut before: Option<(f64, f64)> = None;
    change(readings, channel, |at_s, value| {
        let filtered = before.map_or(value, |(before_s, filtered)| {
            filtered + (value - filtered) * -(-(at_s - before_s) / time_constant_s).exp_m1()
        });
        before = Some((at_s, filtered));
        filtered
    });
}

/// The value of `series` at `at_s`, on the line between the two readings around; the first before all.
pub(super) fn between(series: &Series, at_s: f64) -> Option<f64> {
    let mut before = None;
    for (next_s, next) in series.iter() {
        if next_s >= at_s {
            let Some((last_s, last)) = before else { return Some(next) };
            return Some(last + (next - last) * (at_s - last_s) / (next_s - last_s));
        }
        before = Some((next_s, next));
    }
    before.map(|(_, last)| last)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ramp() -> Series {
        (0..10).map(|k| (f64::from(k), 2.0 * f64::from(k))).collect()
    }

    #[test]
    fn between_two_readings_is_a_line_and_beyond_them_the_nearest() {
        let at = |at_s| between(&ramp(), at_s).unwrap();
        assert!((at(3.25) - 6.5).abs() < 1e-12 && at(-1.0) == 0.0 && at(99.0) == 18.0);
        assert!(between(&Series::default(), 0.0).is_none());
    }

    #[test]
    fn a_filter_follows_late_and_only_what_is_logged_changes() {
        let mut readings: Readings = [(Channel::Roll, ramp())].into();
        filter(&mut readings, Channel::Roll, 2.0);
        filter(&mut readings, Channel::Pitch, 2.0);
        let (_, last) = readings[&Channel::Roll].iter().last().unwrap();
        assert!(last > 14.0 && last < 18.0, "{last}");
        assert_eq!(readings.len(), 1);
    }
}
