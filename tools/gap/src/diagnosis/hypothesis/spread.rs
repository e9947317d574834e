//! How well the parameters of a fit are known: the curvature of its cost at the least.

use nalgebra::{Cholesky, DMatrix};
use xt28_sim::effects::Parameter;

use super::wide;

/// Correlation of two parameters at most; what is beyond is rounding of the costs.
const CORRELATION_MAX: f64 = 0.995;

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
        let n = parameters.len();
        let alone: Vec<f64> =
            parameters.iter().enumerate().map(|(k, p)| alone(cost, at, best, k, p)).collect();
        let step = |k: usize| {
            let p = &parameters[k];
            if at[k] + alone[k] <= p.range[1] { alone[k] } else { -alone[k] }
        };
        let moved = |by: &[usize]| {
            let mut moved = at.to_vec();
            for &k in by {
                let [low, high] = parameters[k].range;
                moved[k] = (at[k] + step(k)).clamp(low, high);
            }
            cost(&moved)
        };
        let single: Vec<f64> =
            if n > 1 { (0..n).map(|k| moved(&[k])).collect() } else { Vec::new() };
        let mut together = DMatrix::identity(n, n);
        for j in 0..n {
            for k in 0..j {
                let bent = 0.5 * (moved(&[j, k]) - single[j] - single[k] + best);
                let sense = step(j).signum() * step(k).signum();
                let both = (sense * bent).clamp(-CORRELATION_MAX, CORRELATION_MAX);
                (together[(j, k)], together[(k, j)]) = (both, both);
            }
        }
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

/// Standard deviation of parameter `k` about `at`, the others held: where the cost is up by one.
///
/// The step is sought so that the cost rises by about one; at the end of a range, inwards alone.
fn alone(cost: &dyn Fn(&[f64]) -> f64, at: &[f64], least: f64, k: usize, p: &Parameter) -> f64 {
    let rise = |by: f64| {
        let mut moved = at.to_vec();
        moved[k] = (at[k] + by).clamp(p.range[0], p.range[1]);
        let step = (moved[k] - at[k]).abs();
        (step > 0.5 * by.abs()).then(|| (cost(&moved) - least, step))
    };
    let (mut step, mut found) = (0.1 * p.tolerance, wide(p));
    for _ in 0..8 {
        let sides: Vec<(f64, f64)> = [step, -step].into_iter().filter_map(rise).collect();
        let up = sides.iter().map(|(rise, _)| rise).sum::<f64>() / sides.len().max(1) as f64;
        let Some((_, taken)) = sides.first() else { break };
        if up > 0.0 {
            found = taken / up.sqrt();
        }
        if (0.3..3.0).contains(&up) {
            break;
        }
        step =
            if up <= 0.0 { 3.0 * step } else { (step / up.sqrt()).clamp(0.1 * step, 10.0 * step) };
    }
    found.min(wide(p))
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
