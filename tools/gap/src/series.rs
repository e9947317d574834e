//! A channel over time, held between its samples as a bus holds a value between two frames.

/// Samples in order of time; never two out of order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Series {
    at_s: Vec<f64>,
    value: Vec<f64>,
}

impl Series {
    /// Adds a sample. One earlier than the last is left out and answered with `false`.
    pub fn push(&mut self, at_s: f64, value: f64) -> bool {
        let in_order = self.at_s.last().is_none_or(|&last_s| at_s >= last_s);
        if in_order {
            self.at_s.push(at_s);
            self.value.push(value);
        }
        in_order
    }

    /// Instants and values, oldest first; seconds from the first frame of the log, SI.
    pub fn iter(&self) -> impl Iterator<Item = (f64, f64)> {
        self.at_s.iter().copied().zip(self.value.iter().copied())
    }

    /// The value in force at `at_s`: that of the latest sample not later, `None` before the first.
    ///
    /// Nothing is interpolated: that is what a node on the bus knows at that instant, and a
    /// quantised value has nothing between two of its steps.
    #[must_use]
    pub fn at(&self, at_s: f64) -> Option<f64> {
        let after = self.at_s.partition_point(|&sample_s| sample_s <= at_s);
        Some(self.value[after.checked_sub(1)?])
    }

    /// Number of samples.
    #[must_use]
    pub fn len(&self) -> usize {
        self.at_s.len()
    }

    /// True without a sample.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.at_s.is_empty()
    }

    /// Instant of the last sample, s.
    #[must_use]
    pub fn end_s(&self) -> Option<f64> {
        self.at_s.last().copied()
    }

    /// What is in force between two instants, with the first of them as zero.
    #[must_use]
    pub fn within(&self, [from_s, to_s]: [f64; 2]) -> Self {
        let held = self.at(from_s).map(|value| (from_s, value));
        let inside = self.iter().filter(|(at_s, _)| *at_s > from_s && *at_s <= to_s);
        let (at_s, value) =
            held.into_iter().chain(inside).map(|(at_s, v)| (at_s - from_s, v)).unzip();
        Self { at_s, value }
    }

    /// The samples between two instants, with the first of them as zero: what is told once and not held.
    #[must_use]
    pub fn told_within(&self, [from_s, to_s]: [f64; 2]) -> Self {
        let inside = self.iter().filter(|(at_s, _)| *at_s >= from_s && *at_s <= to_s);
        let (at_s, value) = inside.map(|(at_s, v)| (at_s - from_s, v)).unzip();
        Self { at_s, value }
    }

    /// The same with every value multiplied by `factor`.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        let value = self.value.iter().map(|value| value * factor).collect();
        Self { at_s: self.at_s.clone(), value }
    }

    /// The sum of several, at the instants of the first at which all have a value.
    #[must_use]
    pub fn sum(parts: &[&Self]) -> Self {
        let mut sum = Self::default();
        let Some(first) = parts.first() else { return sum };
        for (at_s, _) in first.iter() {
            if let Some(value) = parts.iter().map(|part| part.at(at_s)).sum() {
                sum.push(at_s, value);
            }
        }
        sum
    }
}

impl FromIterator<(f64, f64)> for Series {
    fn from_iter<I: IntoIterator<Item = (f64, f64)>>(samples: I) -> Self {
        let mut series = Self::default();
        for (at_s, value) in samples {
            series.push(at_s, value);
        }
        series
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn holds_a_value_until_the_next() {
        let series: Series = [(0.0, 1.0), (0.5, 2.0)].into_iter().collect();
        assert_eq!(series.at(-0.1), None);
        assert_eq!(series.at(0.0), Some(1.0));
        assert_eq!(series.at(0.499), Some(1.0));
        assert_eq!(series.at(0.5), Some(2.0));
        assert_eq!(series.at(9.0), Some(2.0));
    }

    #[test]
    fn what_is_held_goes_on_within_and_what_is_told_once_does_not() {
        let series: Series = [(0.0, 1.0), (0.5, 2.0), (1.5, 3.0)].into_iter().collect();
        let samples = |series: Series| series.iter().collect::<Vec<_>>();
        assert_eq!(samples(series.within([0.75, 2.0])), [(0.0, 2.0), (0.75, 3.0)]);
        assert_eq!(samples(series.told_within([0.75, 2.0])), [(0.75, 3.0)]);
        assert_eq!(samples(series.told_within([0.5, 2.0])), [(0.0, 2.0), (1.0, 3.0)]);
    }

    #[test]
    fn refuses_to_go_back() {
        let mut series: Series = [(0.0, 1.0), (0.5, 2.0)].into_iter().collect();
        assert!(!series.push(0.4, 3.0));
        assert_eq!(series.len(), 2);
    }

    #[test]
    fn sums_where_all_are_known() {
        let a: Series = [(0.0, 1.0), (1.0, 2.0)].into_iter().collect();
        let b: Series = [(0.5, 10.0)].into_iter().collect();
        assert_eq!(Series::sum(&[&a, &b]).iter().collect::<Vec<_>>(), [(1.0, 12.0)]);
    }
}
