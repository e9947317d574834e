//! Samples in the order of time: what a log says of one quantity.

/// One value and when it was on the bus.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample<T> {
    /// Seconds from the start of the run.
    pub at_s: f64,
    /// The value.
    pub value: T,
}

/// Samples, oldest first.
#[derive(Clone, Debug, PartialEq)]
pub struct Series<T>(Vec<Sample<T>>);

impl<T> Default for Series<T> {
    fn default() -> Self {
        Self(Vec::new())
    }
}

impl<T> Series<T> {
    /// Adds a sample. A log is in bus order; where its clock steps back all the same, time stands
    /// still until it has caught up.
    pub fn push(&mut self, at_s: f64, value: T) {
        let at_s = self.0.last().map_or(at_s, |last| last.at_s.max(at_s));
        self.0.push(Sample { at_s, value });
    }

    /// All samples, oldest first.
    #[must_use]
    pub fn samples(&self) -> &[Sample<T>] {
        &self.0
    }

    /// The samples from `from_s` to `to_s`, both included.
    #[must_use]
    pub fn between(&self, from_s: f64, to_s: f64) -> &[Sample<T>] {
        let from = self.0.partition_point(|sample| sample.at_s < from_s);
        let to = self.0.partition_point(|sample| sample.at_s <= to_s);
        &self.0[from..to.max(from)]
    }

    /// The samples from `from_s` to `to_s`, where none of that time goes by without one; else a note that `what`
    /// was lacking, and when. What nobody looked at has not been seen to hold.
    pub(crate) fn covering(
        &self,
        from_s: f64,
        to_s: f64,
        what: &str,
    ) -> Result<&[Sample<T>], String> {
        let samples = self.between(from_s, to_s);
        let starts_s = std::iter::once(from_s).chain(samples.iter().map(|sample| sample.at_s));
        let ends_s = samples.iter().map(|sample| sample.at_s).chain([to_s]);
        match starts_s.zip(ends_s).find(|(start_s, end_s)| end_s - start_s > SILENCE_S) {
            Some((start_s, end_s)) => Err(format!("no {what} from {start_s:.2} to {end_s:.2} s")),
            None if samples.is_empty() => Err(format!("no {what} from {from_s:.2} to {to_s:.2} s")),
            None => Ok(samples),
        }
    }

    /// The newest sample at or before `at_s`: what a listener knew then.
    #[must_use]
    pub fn known_at(&self, at_s: f64) -> Option<&Sample<T>> {
        self.0[..self.0.partition_point(|sample| sample.at_s <= at_s)].last()
    }

    /// The newest sample.
    #[must_use]
    pub fn last(&self) -> Option<&Sample<T>> {
        self.0.last()
    }
}

/// The longest time without a sample that still counts as looked at, s: far more than a busy host holds a
/// program up, and as much as a log may lack of its run.
const SILENCE_S: f64 = 0.5;

/// Mean of `value` over samples, `None` of none.
pub(crate) fn mean<T>(samples: &[Sample<T>], value: impl Fn(&T) -> f64) -> Option<f64> {
    #[allow(clippy::cast_precision_loss)] // a run has far fewer than 2^52 samples
    let count = samples.len() as f64;
    (!samples.is_empty()).then(|| samples.iter().map(|s| value(&s.value)).sum::<f64>() / count)
}

/// Slope of the least-squares line through `value` over time, 1/s; `None` below two instants.
pub(crate) fn slope<T>(samples: &[Sample<T>], value: impl Fn(&T) -> f64) -> Option<f64> {
    let mean_value = mean(samples, &value)?;
    #[allow(clippy::cast_precision_loss)]
    let mean_s = samples.iter().map(|s| s.at_s).sum::<f64>() / samples.len() as f64;
    let (mut along, mut across) = (0.0, 0.0);
    for sample in samples {
        let dt_s = sample.at_s - mean_s;
        along += dt_s * dt_s;
        across += dt_s * (value(&sample.value) - mean_value);
    }
    (along > 0.0).then(|| across / along)
}

/// Least and greatest `value` over samples, `None` of none.
pub(crate) fn extent<T>(samples: &[Sample<T>], value: impl Fn(&T) -> f64) -> Option<(f64, f64)> {
    samples.iter().map(|s| value(&s.value)).fold(None, |extent, v| {
        let (low, high) = extent.unwrap_or((v, v));
        Some((f64::min(low, v), f64::max(high, v)))
    })
}

/// The stretches of samples in a row of which `holds` is true.
pub(crate) fn stretches<T>(
    samples: &[Sample<T>],
    mut holds: impl FnMut(&Sample<T>) -> bool,
) -> Vec<&[Sample<T>]> {
    let mut found = Vec::new();
    let mut start = None;
    for (index, sample) in samples.iter().enumerate() {
        match (holds(sample), start) {
            (true, None) => start = Some(index),
            (false, Some(from)) => {
                found.push(&samples[from..index]);
                start = None;
            }
            _ => {}
        }
    }
    if let Some(from) = start {
        found.push(&samples[from..]);
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line() -> Series<f64> {
        let mut series = Series::default();
        for step in 0..=100 {
            let at_s = f64::from(step) / 10.0;
            series.push(at_s, 3.0 - 0.5 * at_s);
        }
        series
    }

    #[test]
    fn windows_include_both_ends_and_may_be_empty() {
        let series = line();
        assert_eq!(series.between(1.0, 2.0).len(), 11);
        assert!(series.between(2.0, 1.0).is_empty());
        assert!(series.between(20.0, 30.0).is_empty());
        assert_eq!(series.known_at(0.55).unwrap().value, 2.75);
        assert_eq!(series.known_at(-0.1), None);
    }

    #[test]
    fn a_window_is_covered_where_no_half_second_lacks_a_sample() {
        let mut series = Series::default();
        for at_s in [1.0, 1.5, 2.0, 3.0, 3.25] {
            series.push(at_s, at_s);
        }
        let covering = |from_s, to_s| series.covering(from_s, to_s, "frame").map(<[_]>::len);
        assert_eq!(covering(0.5, 2.5), Ok(3));
        assert_eq!(covering(3.0, 3.75), Ok(2));
        assert_eq!(covering(0.25, 2.0), Err("no frame from 0.25 to 1.00 s".to_owned()));
        assert_eq!(covering(1.0, 3.25), Err("no frame from 2.00 to 3.00 s".to_owned()));
        assert_eq!(covering(3.0, 4.0), Err("no frame from 3.25 to 4.00 s".to_owned()));
        assert_eq!(covering(2.25, 2.5), Err("no frame from 2.25 to 2.50 s".to_owned()));
    }

    #[test]
    fn time_never_falls() {
        let mut series = line();
        series.push(3.0, 7.0);
        assert_eq!(series.last(), Some(&Sample { at_s: 10.0, value: 7.0 }));
        assert_eq!(series.between(9.95, 10.0).len(), 2);
    }

    #[test]
    fn a_line_has_its_mean_slope_and_extent() {
        let series = line();
        assert!((mean(series.samples(), |v| *v).unwrap() - 0.5).abs() < 1e-12);
        assert!((slope(series.samples(), |v| *v).unwrap() + 0.5).abs() < 1e-12);
        assert_eq!(extent(series.samples(), |v| *v), Some((-2.0, 3.0)));
        assert_eq!(slope(&series.samples()[..1], |v| *v), None);
    }

    #[test]
    fn stretches_are_maximal() {
        let series = line();
        let found = stretches(series.samples(), |s| !(2.0..3.0).contains(&s.at_s));
        assert_eq!(found.iter().map(|s| s.len()).collect::<Vec<_>>(), [20, 71]);
    }
}
