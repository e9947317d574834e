//! How well the parameters of a fit are known: the curvature of its cost at the least.

use nalgebra::{Cholesky, DMatrix};
use xt28_sim::effects::Parameter;

use super::curvature::Curvature;
use super::wide;

/// How much dearer it is where the curvature is taken from: two standard deviations away.
const RISE: f64 = 4.0;

/// Spread of the parameters about their best values.
#[derive(Clone, Debug)]
pub(super) struct Spread {
    /// Standard deviation of each, whatever the others are; never more than one believed before.
    pub(super) sigma: Vec<f64>,
    /// Logarithm of the share of what one believed possible before that is so still, negative.
    pub(super) log_share: f64,
}

impl Spread {
    /// Of `cost` about its least, `best`, at `at`.
    #[must_use]
    pub(super) fn about(
        cost: &dyn Fn(&[f64]) -> f64,
        at: &[f64],
        best: f64,
        parameters: &[Parameter],
    ) -> Self {
        let Curvature { alone, together } = Curvature::about(cost, at, (best, RISE), parameters);
        let factor = factor(together);
        let inverse = factor.inverse();
        let of = |(k, p): (usize, &Parameter)| (alone[k] * inverse[(k, k)].sqrt()).min(wide(p));
        let sigma = parameters.iter().enumerate().map(of).collect();
        let widths: f64 = alone.iter().zip(parameters).map(|(s, p)| (s / wide(p)).ln()).sum();
        Self { sigma, log_share: (widths - 0.5 * factor.ln_determinant()).min(0.0) }
    }
}

/// The factor of a matrix of ones on the diagonal, its other entries made smaller until it has one.
fn factor(mut matrix: DMatrix<f64>) -> Cholesky<f64, nalgebra::Dyn> {
    loop {
        if let Some(factor) = Cholesky::new(matrix.clone()) {
            return factor;
        }
        matrix *= 0.9;
        matrix.fill_diagonal(1.0);
    }
}

#[cfg(test)]
mod tests {
    use xt28_sim::effects::find;

    use super::*;

    #[test]
    fn what_two_parameters_share_leaves_each_wide() {
        let p = find("steer-gain").unwrap().parameters;
        let tight = |v: &[f64]| {
            let (a, b) = ((v[0] - 1.2) / 0.02, (v[1] - 1.4) / 0.02);
            (a * a + b * b - 2.0 * 0.9 * a * b) / (1.0 - 0.81)
        };
        let spread = Spread::about(&tight, &[1.2, 1.4], 0.0, p);
        for sigma in &spread.sigma {
            assert!((sigma / 0.02 - 1.0).abs() < 0.02, "{spread:?}");
        }
        let area = 0.02 * 0.02 * 0.19_f64.sqrt() / (wide(&p[0]) * wide(&p[1]));
        assert!((spread.log_share - area.ln()).abs() < 0.02, "{spread:?}");
    }

    #[test]
    fn a_parameter_that_shows_in_nothing_is_known_as_before() {
        let p = find("arm-delay").unwrap().parameters;
        let spread = Spread::about(&|_| 0.0, &[0.1], 0.0, p);
        assert_eq!(spread.sigma, [wide(&p[0])]);
        assert_eq!(spread.log_share, 0.0);
    }
}
