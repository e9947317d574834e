//! The rigid parts of a foreign machine, from what is true of it.

use xt28_sim::{Effects, Part, Parts};

use crate::truth::{Logs, Truth};

/// Logs lie in this many bundles along the bunk, each a box of this length, width and height, m.
const BUNDLES: [f64; 3] = [-1.4, 0.0, 1.4];
const BUNDLE_M: [f64; 3] = [1.4, 1.7, 1.0];
/// Height of the bundles' centres over the ground, m.
const BUNDLE_Z_M: f64 = 1.75;
/// The parts of this machine.
pub(crate) fn parts(truth: &Truth) -> Parts {
    let body = &truth.body;
    let mut parts = Parts::new(&truth.machine, &Effects::default());
    for (com_m, by_m) in parts.frames[0].com_m.iter_mut().zip(body.com_shift_m) {
        *com_m += by_m;
    }
    let bunk_x_m = truth.machine.frames.rear_com_m[0];
    for bundle in bundles(&body.logs, bunk_x_m) {
        parts.frames[2] = parts.frames[2].joined(bundle);
    }
    parts
}

fn bundles(logs: &Logs, bunk_x_m: f64) -> impl Iterator<Item = Part> {
    let logs = *logs;
    BUNDLES.into_iter().map(move |x_m| {
        let com_m = [bunk_x_m + logs.ahead_m + x_m, logs.lateral_m, BUNDLE_Z_M];
        Part::solid_box(logs.mass_kg / BUNDLES.len() as f64, com_m, BUNDLE_M)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn logs_weigh_what_they_weigh_and_lie_in_the_bunk() {
        let mut truth = Truth::nominal();
        let empty = parts(&truth).frames[2];
        truth.body.logs = Logs { mass_kg: 6000.0, lateral_m: 0.2, ahead_m: 0.1 };
        let loaded = parts(&truth).frames[2];
        assert!((loaded.mass_kg - empty.mass_kg - 6000.0).abs() < 1e-9);
        let share = 6000.0 / loaded.mass_kg;
        assert!((loaded.com_m[1] - 0.2 * share).abs() < 1e-9);
        assert!(loaded.inertia_kg_m2[2] > empty.inertia_kg_m2[2] + 6000.0);
    }
}
