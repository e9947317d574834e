//! How late ticks start: counted, reported, never asserted.

use core::time::Duration;

/// Counts of lateness by powers of two of a microsecond.
#[derive(Clone, Debug)]
pub(crate) struct Lateness {
    buckets: [u64; 33],
    ticks: u64,
    /// Ticks left out because their time had passed.
    pub(crate) missed: u64,
    worst: Duration,
}

impl Lateness {
    pub(crate) const fn new() -> Self {
        Self { buckets: [0; 33], ticks: 0, missed: 0, worst: Duration::ZERO }
    }

    pub(crate) fn note(&mut self, late: Duration) {
        let micros = u32::try_from(late.as_micros()).unwrap_or(u32::MAX);
        // Bucket n holds what is below 2^n µs.
        self.buckets[(u32::BITS - micros.leading_zeros()) as usize] += 1;
        self.ticks += 1;
        self.worst = self.worst.max(late);
    }

    pub(crate) const fn ticks(&self) -> u64 {
        self.ticks
    }

    pub(crate) const fn worst_ms(&self) -> f64 {
        self.worst.as_secs_f64() * 1e3
    }

    /// What 99 % of the ticks stayed below, ms, rounded up to a power of two of a microsecond.
    #[allow(clippy::cast_precision_loss)] // powers of two
    pub(crate) fn p99_ms(&self) -> f64 {
        let mut below = 0;
        for (n, count) in self.buckets.iter().enumerate() {
            below += count;
            if below * 100 >= self.ticks * 99 {
                return (1_u64 << n) as f64 * 1e-3;
            }
        }
        f64::INFINITY
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ninety_nine_in_a_hundred() {
        let mut lateness = Lateness::new();
        (0..990).for_each(|_| lateness.note(Duration::from_micros(100)));
        (0..10).for_each(|_| lateness.note(Duration::from_millis(7)));
        assert!((lateness.p99_ms() - 0.128).abs() < 1e-12);
        assert!((lateness.worst_ms() - 7.0).abs() < 1e-9);
        lateness.note(Duration::from_secs(100_000));
        assert!(lateness.p99_ms() > 7.0);
    }
}
