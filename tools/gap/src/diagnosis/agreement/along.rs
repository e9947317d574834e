//! How many times what is told of a motion its reading is, where the two go along: what tells another unit or sign
//! from another motion.

/// Samples that are too few, ten a second.
const SAMPLES_MIN: usize = 50;
/// A reading is of the same motion, on whatever scale, where the two go along like this, or against one another.
/// Of machines with a fault none had less than 0.8 where strokes and attitude were held against one another.
const ALONG: f64 = 0.7;

/// A motion as it is told and as it is read, over many samples.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Along {
    told: f64,
    both: f64,
    read: f64,
    count: usize,
}

impl Along {
    /// Of samples of what is told and what is read.
    pub(super) fn of(pairs: impl Iterator<Item = [f64; 2]>) -> Self {
        pairs.fold(Self::default(), |all, [told, read]| Self {
            told: all.told + told * told,
            both: all.both + told * read,
            read: all.read + read * read,
            count: all.count + 1,
        })
    }

    /// Root mean squares of what is told and of what is read; zeros without a sample.
    #[allow(clippy::cast_precision_loss)]
    pub(super) fn means(&self) -> [f64; 2] {
        [self.told, self.read].map(|square| (square / self.count.max(1) as f64).sqrt())
    }

    /// How many times what is told the reading is, less than zero where it is the other way round; nothing of few
    /// samples, and where another motion is read.
    pub(super) fn times(&self) -> Option<f64> {
        let Self { told, both, read, count } = *self;
        let along = count >= SAMPLES_MIN && both.abs() > ALONG * (told * read).sqrt();
        along.then(|| (read / told).sqrt().copysign(both))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A motion, and a reading of so many times that, so much later.
    fn swung(times: f64, late_s: f64, samples: i32) -> Option<f64> {
        let at = |at_s: f64| (0.8 * at_s).sin();
        let pairs = (0..samples).map(|k| 0.1 * f64::from(k));
        Along::of(pairs.map(|at_s| [at(at_s), times * at(at_s - late_s)])).times()
    }

    #[test]
    fn a_scale_and_a_sign_are_told_of_one_motion_alone() {
        for times in [10.0, 1.0, 0.01, -1.0, -57.0] {
            let found = swung(times, 0.1, 400).unwrap();
            assert!((found / times - 1.0).abs() < 0.01, "{times}: {found}");
        }
        assert_eq!(swung(10.0, 2.0, 400), None, "it is read of something else");
        assert_eq!(swung(0.0, 0.0, 400), None, "nothing is read");
        assert_eq!(swung(10.0, 0.0, 40), None, "who knows");
    }
}
