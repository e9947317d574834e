//! How fast a block parts from the log: how far its error moves within a time.

use super::{Pair, STEP_S, rms};
use crate::diagnosis::generator::Generator;
use crate::diagnosis::verdict::{Diagnosis, Spot};

/// Horizons, s.
pub const HORIZONS_S: [f64; 5] = [0.1, 0.5, 1.0, 2.0, 5.0];

/// Samples of a piece of a residual: from its first to its last is the furthest horizon, 5 s.
const PIECE: usize = 51;
/// Places of the verdict that have a curve before all others. An error in floors that every machine has
/// may be larger than the one that is named: then the block that the verdict is about had none.
const PLACES: usize = 2;
/// A second place whose gap is smaller is no part of what the verdict is about, floors.
const GAP_MIN: f64 = 1.0;

/// One generator's error over the horizon.
///
/// The error at a horizon is the root mean square of how far the residual has moved in that time, within
/// pieces of 5 s.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// The generator.
    pub name: String,
    /// At each of [`HORIZONS_S`], floors.
    pub before: [Option<f64>; 5],
    /// With the causes put in.
    pub after: [Option<f64>; 5],
}

/// A curve for each generator, over all runs: those of the verdict's first places, then the largest first.
pub(super) fn curves(pairs: &[Pair], diagnosis: &Diagnosis) -> Vec<Curve> {
    let mut curves: Vec<(Generator, Curve)> =
        pairs.iter().filter(|pair| pair.run == 0).map(|pair| curve(pairs, pair)).collect();
    let last = |curve: &Curve| curve.before.iter().rev().flatten().next().copied().unwrap_or(0.0);
    curves.sort_by(|(_, a), (_, b)| last(b).total_cmp(&last(a)));
    let open = diagnosis.unexplained.iter();
    let mut first = 0;
    let places = diagnosis.places.iter().enumerate();
    let loud = places.filter(|(rank, place)| *rank == 0 || place.gap_over_noise >= GAP_MIN);
    for spot in open.chain(loud.map(|(_, place)| &place.spot)) {
        let of_spot = |(generator, _): &(Generator, Curve)| watches(pairs, *generator, spot);
        // One that is among the first already has this place shown.
        if first < PLACES
            && !curves[..first].iter().any(of_spot)
            && let Some(at) = curves.iter().position(of_spot)
        {
            curves[first..=at].rotate_right(1);
            first += 1;
        }
    }
    curves.into_iter().map(|(_, curve)| curve).collect()
}

/// Whether one of a generator's signals is what `spot` is of.
fn watches(pairs: &[Pair], generator: Generator, spot: &Spot) -> bool {
    let own = pairs.iter().filter(|pair| pair.generator == generator);
    own.flat_map(|pair| &pair.before).any(|residual| spot.is_of(generator, residual.signal))
}

/// The curve of the generator of `first`.
fn curve(pairs: &[Pair], first: &Pair) -> (Generator, Curve) {
    let same = || pairs.iter().filter(|pair| pair.generator == first.generator);
    let moved = |after: bool, horizon_s: f64| {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let by = (horizon_s / STEP_S).round() as usize;
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
    let curve = Curve {
        name: first.generator.to_string(),
        before: HORIZONS_S.map(|horizon_s| moved(false, horizon_s)),
        after: HORIZONS_S.map(|horizon_s| moved(true, horizon_s)),
    };
    (first.generator, curve)
}
