//! What the pages say of gaps: which are shown, how they were told, what a small one means.

mod answer;
mod frames;
mod made_up;

use answer::{diagnosis, inquiry, page, page_of};
use xt28_gap::diagnosis::{Details, Diagnosis, Place, ShareOf, Spot, Verdict};
use xt28_gap::page::text;
use xt28_sim::effects::Block;

#[test]
fn the_place_that_the_verdict_is_about_has_the_first_curve_over_the_horizon() {
    let joint = joint_place();
    let by_error = curves(Vec::new());
    assert_ne!(by_error[0], "joint front", "another block's error is larger here");
    let first = curves(vec![joint]);
    assert_eq!(first[0], "joint front");
    let others = |names: &[String]| -> Vec<String> {
        names.iter().filter(|name| *name != "joint front").cloned().collect()
    };
    assert_eq!(others(&first), others(&by_error), "the rest by how far their errors move");
}

#[test]
fn a_second_place_without_a_gap_comes_before_none_that_has_one() {
    let first = || diagnosis(Verdict::Effect).places.swap_remove(0);
    let quiet = curves(vec![first(), joint_place()]);
    assert_eq!(quiet, curves(vec![first()]));
    let loud = curves(vec![first(), Place { gap_over_noise: 3.0, ..joint_place() }]);
    let rank = |names: &[String]| names.iter().position(|name| name == "joint front").unwrap();
    assert!(rank(&loud) < rank(&quiet), "{loud:?}, {quiet:?}");
}

/// Names of the curves over the horizon, in their order, of a verdict with these places.
fn curves(places: Vec<Place>) -> Vec<String> {
    let told = Diagnosis { places, ..diagnosis(Verdict::Effect) };
    let details = Details::new(&inquiry(), &told).unwrap();
    details.horizons.into_iter().map(|curve| curve.name).collect()
}

/// A place at the front joint whose gap is below a floor.
fn joint_place() -> Place {
    let spot = Spot {
        block: Block::Steering,
        part: "joint",
        scope: "all".parse().unwrap(),
        residual: "front joint angle".to_owned(),
    };
    Place { spot, gap_over_noise: 0.9, share: 0.1 }
}

#[test]
fn a_gap_says_how_far_tolerances_went_and_a_share_what_it_is_of() {
    let known = page(Verdict::Effect);
    assert!(known.contains("beside the cause or pair that fits best, but held to 2.5 of its own."));
    let unknown = page(Verdict::Unknown);
    assert!(unknown.contains("while no cause is believed, but held to one of its own."));
    let shares = "Below a floor a share says little.";
    assert!(known.contains(shares) && text(&diagnosis(Verdict::Effect)).contains(shares));
    let squares = Diagnosis { share_of: ShareOf::Squares, ..diagnosis(Verdict::Effect) };
    assert!(!text(&squares).contains(shares), "these go beyond floors only");
}

#[test]
fn a_cause_beside_small_gaps_alone_is_explained_on_both_pages() {
    let why = "a cause is told by the pattern over time of many samples";
    let of = |verdict, gap| {
        let mut diagnosis = diagnosis(verdict);
        diagnosis.places.iter_mut().for_each(|place| place.gap_over_noise = gap);
        (page_of(&diagnosis).matches(why).count(), text(&diagnosis).matches(why).count())
    };
    assert_eq!(of(Verdict::Effect, 1.4), (2, 1));
    assert_eq!(of(Verdict::Effect, 1.6), (0, 0));
    assert_eq!(of(Verdict::None, 1.4), (0, 0), "nothing is named");
}
