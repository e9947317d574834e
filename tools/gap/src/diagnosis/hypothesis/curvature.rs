//! How a cost bends about a point: along each parameter, and two at a time.

use nalgebra::{DMatrix, SymmetricEigen};
use xt28_sim::effects::Parameter;

use super::wide;

/// Correlation of two parameters at most; what is beyond is rounding of the costs.
const CORRELATION_MAX: f64 = 0.995;
/// Least curvature along an axis of its own, that of the parameters being one.
const BENT_MIN: f64 = 0.005;

/// A cost about a point, as a quadratic form.
#[derive(Clone, Debug)]
pub(super) struct Curvature {
    /// How far each parameter goes, the others held, until the cost is up by one.
    pub(super) alone: Vec<f64>,
    /// The form in units of those; ones on its diagonal.
    pub(super) together: DMatrix<f64>,
}

impl Curvature {
    /// Of `cost`, which is `here` at `at`, by finite differences to about where it is higher by `rise`. The cost is
    /// not smooth, and `rise` has to be large beside its jumps.
    #[must_use]
    pub(super) fn about(
        cost: &dyn Fn(&[f64]) -> f64,
        at: &[f64],
        (here, rise): (f64, f64),
        parameters: &[Parameter],
    ) -> Self {
        let n = parameters.len();
        let root = rise.sqrt();
        let alone: Vec<f64> = parameters
            .iter()
            .enumerate()
            .map(|(k, p)| alone(cost, at, (here, rise), k, p))
            .collect();
        let step = |k: usize| {
            let p = &parameters[k];
            if at[k] + root * alone[k] <= p.range[1] { root * alone[k] } else { -root * alone[k] }
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
                let bent = 0.5 / rise * (moved(&[j, k]) - single[j] - single[k] + here);
                let sense = step(j).signum() * step(k).signum();
                let both = (sense * bent).clamp(-CORRELATION_MAX, CORRELATION_MAX);
                (together[(j, k)], together[(k, j)]) = (both, both);
            }
        }
        Self { alone, together }
    }

    /// Directions that do not lean on each other, each as long as the cost needs to rise by one; along a
    /// valley as far as can be told.
    #[must_use]
    pub(super) fn axes(&self) -> Vec<Vec<f64>> {
        let own = SymmetricEigen::new(self.together.clone());
        let each = own.eigenvalues.iter().zip(own.eigenvectors.column_iter());
        let axis = |(bent, along): (&f64, nalgebra::DVectorView<'_, f64>)| {
            let length = bent.max(BENT_MIN).sqrt();
            along.iter().zip(&self.alone).map(|(by, alone)| by * alone / length).collect()
        };
        each.map(axis).collect()
    }
}

/// How far parameter `k` goes from `at`, the others held, until the cost is up by one.
///
/// The step is sought so that it rises by about that; at the end of a range, inwards alone.
fn alone(
    cost: &dyn Fn(&[f64]) -> f64,
    at: &[f64],
    (here, wanted): (f64, f64),
    k: usize,
    p: &Parameter,
) -> f64 {
    let rise = |by: f64| {
        let mut moved = at.to_vec();
        moved[k] = (at[k] + by).clamp(p.range[0], p.range[1]);
        let step = (moved[k] - at[k]).abs();
        (step > 0.5 * by.abs()).then(|| ((cost(&moved) - here) / wanted, step))
    };
    let (mut step, mut found) = (0.1 * p.tolerance, wide(p));
    for _ in 0..8 {
        let sides: Vec<(f64, f64)> = [step, -step].into_iter().filter_map(rise).collect();
        let up = sides.iter().map(|(rise, _)| rise).sum::<f64>() / sides.len().max(1) as f64;
        let Some((_, taken)) = sides.first() else { break };
        if up > 0.0 {
            found = taken / (up * wanted).sqrt();
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
    fn axes_lie_along_and_across_a_valley() {
        let p = find("steer-gain").unwrap().parameters;
        let cost = |v: &[f64]| {
            let (a, b) = (v[0] - 1.2, v[1] - 1.4);
            ((a - b) / 0.01).powi(2) + ((a + b) / 0.05).powi(2)
        };
        let mut axes = Curvature::about(&cost, &[1.2, 1.4], (0.0, 10.0), p).axes();
        axes.sort_by(|a, b| (a[0] * a[1]).total_cmp(&(b[0] * b[1])));
        for (axis, [a, b]) in axes.iter().zip([[0.005, -0.005], [0.025, 0.025]]) {
            let sign = axis[0].signum();
            assert!((sign * axis[0] - a).abs() < 5e-4, "{axes:?}");
            assert!((sign * axis[1] - b).abs() < 5e-4, "{axes:?}");
        }
    }
}
