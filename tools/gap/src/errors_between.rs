//! How far one series is from another: RMSE, largest error, bias, correlation.

use serde::Serialize;

use crate::Series;

/// Distance of ours from what a log measured, over the log's own instants.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Errors {
    /// Instants compared.
    pub samples: usize,
    /// Root of the mean squared error.
    pub rmse: f64,
    /// Largest absolute error.
    pub max: f64,
    /// When that was, s from the log's first frame.
    pub max_at_s: f64,
    /// Mean of ours less mean of the log's.
    pub bias: f64,
    /// Pearson's correlation; `None` where one of the two does not move.
    pub correlation: Option<f64>,
}

impl Errors {
    /// Compares at every sample of `log` for which `ours` has a value by then; `None` without any.
    #[must_use]
    pub fn between(log: &Series, ours: &Series) -> Option<Self> {
        let pairs: Vec<(f64, f64, f64)> =
            log.iter().filter_map(|(at_s, want)| Some((at_s, want, ours.at(at_s)?))).collect();
        if pairs.is_empty() {
            return None;
        }
        #[allow(clippy::cast_precision_loss)] // a log of 2^53 samples does not exist
        let n = pairs.len() as f64;
        let mean = |value: fn(&(f64, f64, f64)) -> f64| pairs.iter().map(value).sum::<f64>() / n;
        let (log_mean, our_mean) = (mean(|p| p.1), mean(|p| p.2));
        let (mut squares, mut log_var, mut our_var, mut covariance) = (0.0, 0.0, 0.0, 0.0);
        let (mut max, mut max_at_s) = (0.0_f64, pairs[0].0);
        for &(at_s, want, got) in &pairs {
            let error = got - want;
            squares += error * error;
            if error.abs() > max {
                (max, max_at_s) = (error.abs(), at_s);
            }
            let (dl, d_o) = (want - log_mean, got - our_mean);
            log_var += dl * dl;
            our_var += d_o * d_o;
            covariance += dl * d_o;
        }
        let moves = log_var > 0.0 && our_var > 0.0;
        let correlation =
            moves.then(|| (covariance / (log_var.sqrt() * our_var.sqrt())).clamp(-1.0, 1.0));
        Some(Self {
            samples: pairs.len(),
            rmse: (squares / n).sqrt(),
            max,
            max_at_s,
            bias: our_mean - log_mean,
            correlation,
        })
    }

    /// The same in another unit.
    #[must_use]
    pub fn scaled(self, factor: f64) -> Self {
        let size = factor.abs();
        Self { rmse: self.rmse * size, max: self.max * size, bias: self.bias * factor, ..self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn series(values: &[f64]) -> Series {
        values.iter().enumerate().map(|(i, v)| (i as f64, *v)).collect()
    }

    #[test]
    fn measures_what_it_says() {
        let e = Errors::between(&series(&[0.0, 1.0, 2.0, 3.0]), &series(&[1.0, 2.0, 3.0, 8.0]))
            .unwrap();
        assert_eq!((e.samples, e.max, e.max_at_s), (4, 5.0, 3.0));
        assert!((e.rmse - 7.0_f64.sqrt()).abs() < 1e-12);
        assert!((e.bias - 2.0).abs() < 1e-12);
        assert!((e.correlation.unwrap() - 0.9135).abs() < 1e-4);
    }

    #[test]
    fn a_turned_copy_correlates_by_minus_one_and_a_still_one_not_at_all() {
        let log = series(&[0.0, 1.0, 2.0]);
        let turned = Errors::between(&log, &log.scaled(-1.0)).unwrap().correlation.unwrap();
        assert!((turned + 1.0).abs() < 1e-12, "{turned}");
        assert_eq!(Errors::between(&log, &series(&[1.0; 3])).unwrap().correlation, None);
        assert_eq!(Errors::between(&log, &log).unwrap().rmse, 0.0);
    }

    #[test]
    fn instants_before_ours_begins_are_not_compared() {
        let ours: Series = [(1.5, 2.0)].into_iter().collect();
        assert_eq!(Errors::between(&series(&[9.0, 9.0, 2.0]), &ours).unwrap().samples, 1);
        assert_eq!(Errors::between(&series(&[9.0]), &ours), None);
    }
}
