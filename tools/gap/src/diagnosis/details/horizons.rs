//! How a block's error grows with the time since it was last set to what was measured.

use super::{Pair, STEP_S, rms};

/// Horizons, s.
pub const HORIZONS_S: [f64; 5] = [0.1, 0.5, 1.0, 2.0, 5.0];

/// Samples of a residual from one instant at which a block is set to the measurement to the next.
const PIECE: usize = 50;

/// One generator's error over the horizon.
///
/// The error at a horizon is the root mean square of how far the residual has moved in that time,
/// within the pieces of 5 s at whose starts blocks are set to what was measured.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// The generator.
    pub name: String,
    /// At each of [`HORIZONS_S`], floors.
    pub before: [Option<f64>; 5],
    /// With the causes put in.
    pub after: [Option<f64>; 5],
}

/// A curve for each generator, over all runs, the largest first.
pub(super) fn curves(pairs: &[Pair]) -> Vec<Curve> {
    let curve = |first: &Pair| {
        let same = || pairs.iter().filter(|pair| pair.generator == first.generator);
        let moved = |after: bool, horizon_s: f64| {
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
            let by = ((horizon_s / STEP_S).round() as usize).min(PIECE - 1);
            rms(same().flat_map(move |pair| {
                let residuals = if after { &pair.after } else { &pair.before };
                residuals.iter().flat_map(move |residual| {
                    let moved = move |piece: &[f64]| -> Vec<f64> {
                        piece.iter().zip(piece.iter().skip(by)).map(|(a, b)| b - a).collect()
                    };
                    residual.values.chunks(PIECE).flat_map(moved)
                })
            }))
        };
        Curve {
            name: first.generator.to_string(),
            before: HORIZONS_S.map(|horizon_s| moved(false, horizon_s)),
            after: HORIZONS_S.map(|horizon_s| moved(true, horizon_s)),
        }
    };
    let mut curves: Vec<Curve> = pairs.iter().filter(|pair| pair.run == 0).map(curve).collect();
    let last = |curve: &Curve| curve.before.iter().rev().flatten().next().copied().unwrap_or(0.0);
    curves.sort_by(|a, b| last(b).total_cmp(&last(a)));
    curves
}
