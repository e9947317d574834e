//! A linear law by ridge regression that knows how far it can be trusted: the further inputs lie from
//! those it was fitted on, the less it says.
//!
//! How far is told by leverage, z' (Z'Z / n + ridge)^-1 z, the squared distance in units of how the
//! inputs were spread. Within the largest that was fitted on it is trusted whole, beyond in
//! inverse proportion. Without that, a law of one manoeuvre extrapolates to whatever another one commands.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

/// Inputs of a sample and what they should tell, added up over samples.
#[derive(Clone, Debug)]
pub(super) struct Normal {
    matrix: DMatrix<f64>,
    right: DMatrix<f64>,
    samples: f64,
}

/// Weights, one row an input and one column a number that is told.
#[derive(Clone, Debug)]
pub(super) struct Law {
    weights: DMatrix<f64>,
}

/// How far inputs lie from those that were fitted on.
#[derive(Clone, Debug)]
pub(super) struct Known {
    spread: Cholesky<f64, Dyn>,
    farthest: f64,
}

impl Normal {
    pub(super) fn new(inputs: usize, outputs: usize) -> Self {
        Self {
            matrix: DMatrix::zeros(inputs, inputs),
            right: DMatrix::zeros(inputs, outputs),
            samples: 0.0,
        }
    }

    pub(super) fn add(&mut self, inputs: &DVector<f64>, told: &DVector<f64>) {
        self.matrix.ger(1.0, inputs, inputs, 1.0);
        self.right.ger(1.0, inputs, told, 1.0);
        self.samples += 1.0;
    }

    /// None without samples or for a ridge without end.
    fn spread(&self, ridge: f64) -> Option<Cholesky<f64, Dyn>> {
        if self.samples < 1.0 || ridge.is_infinite() {
            return None;
        }
        let mut matrix = &self.matrix / self.samples;
        for k in 0..matrix.nrows() {
            matrix[(k, k)] += ridge;
        }
        Cholesky::new(matrix)
    }

    /// The law with this ridge; none without samples or for a ridge without end.
    pub(super) fn law(&self, ridge: f64) -> Option<Law> {
        Some(Law { weights: self.spread(ridge)?.solve(&(&self.right / self.samples)) })
    }

    /// What such a law knows, if `inputs` are what was added up.
    pub(super) fn known<'a>(
        &self,
        ridge: f64,
        inputs: impl Iterator<Item = &'a DVector<f64>>,
    ) -> Option<Known> {
        let mut known = Known { spread: self.spread(ridge)?, farthest: 0.0 };
        known.farthest = inputs.map(|z| known.leverage(z)).fold(0.0, f64::max);
        Some(known)
    }
}

impl Law {
    pub(super) fn of(&self, inputs: &DVector<f64>) -> DVector<f64> {
        self.weights.tr_mul(inputs)
    }
}

impl Known {
    fn leverage(&self, inputs: &DVector<f64>) -> f64 {
        // z' (L L')^-1 z is the square of L^-1 z.
        let lower = self.spread.l_dirty().solve_lower_triangular(inputs);
        lower.map_or(f64::INFINITY, |z| z.norm_squared())
    }

    /// Share of what a law says of these inputs that is to be believed, 0 to 1.
    pub(super) fn trust(&self, inputs: &DVector<f64>) -> f64 {
        let leverage = self.leverage(inputs);
        if leverage > self.farthest { self.farthest / leverage } else { 1.0 }
    }
}

/// Root mean square of each input; one for an input that is always naught.
#[allow(clippy::cast_precision_loss)]
pub(super) fn scales<'a>(samples: impl Iterator<Item = &'a DVector<f64>>) -> DVector<f64> {
    let (mut sums, mut count) = (DVector::zeros(0), 0_usize);
    for sample in samples {
        if sums.is_empty() {
            sums = DVector::zeros(sample.len());
        }
        sums += sample.map(|x| x * x);
        count += 1;
    }
    sums.map(|sum: f64| if sum > 0.0 { (sum / count as f64).sqrt() } else { 1.0 })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Inputs of a line, one and x, and y = 2 + 3 x.
    fn line() -> (Vec<DVector<f64>>, Normal) {
        let inputs: Vec<DVector<f64>> =
            (0..50).map(|k| DVector::from_vec(vec![1.0, f64::from(k) / 25.0 - 1.0])).collect();
        let mut normal = Normal::new(2, 1);
        inputs.iter().for_each(|z| normal.add(z, &DVector::from_element(1, 2.0 + 3.0 * z[1])));
        (inputs, normal)
    }

    #[test]
    fn a_law_is_found_and_trusted_where_it_was_seen() {
        let (inputs, normal) = line();
        let law = normal.law(1e-9).unwrap();
        let known = normal.known(1e-9, inputs.iter()).unwrap();
        let at = |x: f64| DVector::from_vec(vec![1.0, x]);
        assert!((law.of(&at(0.4))[0] - 3.2).abs() < 1e-6);
        assert!((known.trust(&at(0.9)) - 1.0).abs() < 1e-12);
        let (near, far) = (known.trust(&at(2.0)), known.trust(&at(20.0)));
        assert!(0.2 < near && near < 0.5 && far < 0.005, "{near} {far}");
    }

    #[test]
    fn no_samples_and_no_ridge_are_no_law() {
        let (inputs, normal) = line();
        assert!(Normal::new(2, 1).law(0.1).is_none() && normal.law(f64::INFINITY).is_none());
        assert!(normal.known(f64::INFINITY, inputs.iter()).is_none());
        assert_eq!(scales(inputs.iter())[0], 1.0);
        assert_eq!(scales([DVector::zeros(1)].iter())[0], 1.0);
    }
}
