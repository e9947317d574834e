//! Running lists: what a sensor faster than the receiver said since the last observation.

use core::time::Duration;

use xt28_machine::SimTime;
use xt28_safety::Limits;

/// A list that began longer ago begins anew: after so long without a fix the safety kernel takes an observation for
/// lost, and the mean of minutes is not where the machine is.
const LIST_MAX: Duration = Duration::from_nanos(Limits::XT28.observation.span_ns());

/// Sum and count of `N` channels that come together, and their last values.
///
/// The paper keeps lists and averages them at each fix (5.3); a sum says the same.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Running<const N: usize> {
    sum: [f64; N],
    count: u32,
    /// When the first of them came.
    since: SimTime,
    last: [f64; N],
    at: Option<SimTime>,
}

impl<const N: usize> Running<N> {
    pub(crate) const fn new() -> Self {
        Self { sum: [0.0; N], count: 0, since: SimTime::ZERO, last: [f64::NAN; N], at: None }
    }

    /// One more sample.
    pub(crate) fn push(&mut self, at: SimTime, values: [f64; N]) {
        if self.count > 0 && at.since(self.since) > LIST_MAX {
            self.clear();
        }
        if self.count == 0 {
            self.since = at;
        }
        self.sum.iter_mut().zip(values).for_each(|(sum, value)| *sum += value);
        self.count += 1;
        self.last = values;
        self.at = Some(at);
    }

    /// The mean since the last call, or the last value where nothing came since.
    pub(crate) fn take_mean(&mut self) -> [f64; N] {
        let mean = self.mean();
        self.clear();
        mean
    }

    fn clear(&mut self) {
        self.sum = [0.0; N];
        self.count = 0;
    }

    /// The last values; NaN before the first.
    pub(crate) const fn last(&self) -> [f64; N] {
        self.last
    }

    /// When the last values came.
    pub(crate) const fn at(&self) -> Option<SimTime> {
        self.at
    }

    /// The mean since the last [`Self::take_mean`], or the last value.
    pub(crate) fn mean(&self) -> [f64; N] {
        match self.count {
            0 => self.last,
            count => self.sum.map(|sum| sum / f64::from(count)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn averages_between_observations_and_keeps_the_last_value() {
        let mut running = Running::new();
        assert!(running.take_mean()[0].is_nan() && running.at().is_none());
        running.push(SimTime::from_millis(10), [1.0]);
        running.push(SimTime::from_millis(20), [2.0]);
        assert_eq!(running.take_mean(), [1.5]);
        assert_eq!(running.take_mean(), [2.0]);
        assert_eq!(running.at(), Some(SimTime::from_millis(20)));
    }

    #[test]
    fn a_list_that_nobody_asked_for_says_where_the_machine_is_and_not_where_it_was() {
        let mut running = Running::new();
        for tick in 0..6000_u32 {
            let stroke_m = if tick < 5900 { 0.1 } else { 0.2 };
            running.push(SimTime::from_millis(u64::from(10 * tick)), [stroke_m]);
        }
        assert!((running.take_mean()[0] - 0.2).abs() < 1e-9);
        // Within a fix's period or two, all count.
        (0..25).for_each(|n| running.push(SimTime::from_millis(60_000 + 10 * n), [n as f64]));
        assert_eq!(running.mean(), [12.0]);
    }
}
