//! What the pages show of gaps.

mod answer;
mod made_up;

use answer::{diagnosis, inquiry};
use xt28_gap::diagnosis::{Details, Diagnosis, Place, Spot, Verdict};
use xt28_sim::effects::Block;

#[test]
fn the_place_that_the_verdict_is_about_has_the_first_curve_over_the_horizon() {
    let joint = Place {
        spot: Spot {
            block: Block::Steering,
            part: "joint",
            scope: "all".parse().unwrap(),
            residual: "front joint angle".to_owned(),
        },
        gap_over_noise: 0.9,
        share: 0.1,
    };
    let names = |places| {
        let details = Details::new(&inquiry(), &Diagnosis { places, ..diagnosis(Verdict::Effect) });
        details.horizons.into_iter().map(|curve| curve.name).collect::<Vec<_>>()
    };
    let by_error = names(Vec::new());
    assert_ne!(by_error[0], "joint front", "another block's error is larger here");
    let first = names(vec![joint]);
    assert_eq!(first[0], "joint front");
    let others = |names: &[String]| -> Vec<String> {
        names.iter().filter(|name| *name != "joint front").cloned().collect()
    };
    assert_eq!(others(&first), others(&by_error), "the rest by how far their errors move");
}
