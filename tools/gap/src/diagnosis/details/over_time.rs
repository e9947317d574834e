//! The gap over time: when in each run a block parts from the log.

use super::{Pair, STEP_S, rms};

/// Time that one cell of a strip stands for, s.
pub const CELL_S: f64 = 2.0;

/// One generator's gap over every run.
#[derive(Clone, Debug, PartialEq)]
pub struct Strip {
    /// The generator.
    pub name: String,
    /// For each run its gap in each [`CELL_S`], floors; `None` where nothing can be said.
    pub runs: Vec<Vec<Option<f64>>>,
}

/// A strip for each generator, in the order of the map.
pub(super) fn strips(pairs: &[Pair]) -> Vec<Strip> {
    let first = pairs.iter().filter(|pair| pair.run == 0);
    first
        .map(|first| Strip {
            name: first.generator.to_string(),
            runs: pairs
                .iter()
                .filter(|pair| pair.generator == first.generator)
                .map(cells)
                .collect(),
        })
        .collect()
}

/// The gap of one generator on one run, cell by cell.
fn cells(pair: &Pair) -> Vec<Option<f64>> {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    const SAMPLES: usize = (CELL_S / STEP_S + 0.5) as usize;
    let longest = pair.before.iter().map(|residual| residual.values.len()).max().unwrap_or(0);
    let cell = |k: usize| {
        let within = |values: &[f64]| {
            let end = (k + SAMPLES).min(values.len());
            values[k.min(end)..end].to_vec()
        };
        rms(pair.before.iter().flat_map(|residual| within(&residual.values)))
    };
    (0..longest).step_by(SAMPLES).map(cell).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnosis::floor::Signal;
    use crate::diagnosis::generator::{Generator, Residual};

    #[test]
    fn a_cell_holds_what_happened_in_it_and_no_more() {
        let mut values = vec![0.0; 50];
        values[20..40].fill(3.0);
        values[40..].fill(f64::NAN);
        let mut pair = Pair {
            run: 0,
            generator: Generator::Drive,
            before: vec![Residual {
                generator: Generator::Drive,
                signal: Signal::DriveForce,
                values,
            }],
            after: Vec::new(),
        };
        assert_eq!(cells(&pair), [Some(0.0), Some(3.0), None]);
        pair.before.clear();
        assert_eq!(cells(&pair), []);
    }
}
