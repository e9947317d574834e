//! Running lists: what a sensor faster than the receiver said since the last observation.

use xt28_machine::SimTime;

/// Sum and count of `N` channels that come together, and their last values.
///
/// The paper keeps lists and averages them at each fix (5.3); a sum says the same.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Running<const N: usize> {
    sum: [f64; N],
    count: u32,
    last: [f64; N],
    at: Option<SimTime>,
}

impl<const N: usize> Running<N> {
    pub(crate) const fn new() -> Self {
        Self { sum: [0.0; N], count: 0, last: [f64::NAN; N], at: None }
    }

    /// One more sample.
    pub(crate) fn push(&mut self, at: SimTime, values: [f64; N]) {
        self.sum.iter_mut().zip(values).for_each(|(sum, value)| *sum += value);
        self.count += 1;
        self.last = values;
        self.at = Some(at);
    }

    /// The mean since the last call, or the last value where nothing came since.
    pub(crate) fn take_mean(&mut self) -> [f64; N] {
        let mean = self.mean();
        self.sum = [0.0; N];
        self.count = 0;
        mean
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
}
