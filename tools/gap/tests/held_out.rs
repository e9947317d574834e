//! What only runs that were held out show: neither passed over nor taken for tested.

mod own_logs;

use std::path::Path;

use xt28_gap::diagnosis::{FieldRun, Inquiry, Verdict};
use xt28_machine::Machine;
use xt28_sim::Effects;
use xt28_sim::effects::{Block, Overlay};

fn weak_steering() -> Effects {
    let text = "[[effect]]\nname = \"steer-gain\"\nkp_factor = 0.3\n";
    Overlay::parse(text, Path::new("weak.toml")).unwrap().effects(&Machine::xt28()).unwrap()
}

fn inquiry(runs: Vec<FieldRun>) -> Inquiry {
    let mut inquiry = Inquiry::new(Machine::xt28(), runs);
    inquiry.how_far = false;
    inquiry
}

/// The machine steers a third as hard as it should, but no run that is fitted steers.
#[test]
fn a_fault_that_only_a_run_held_out_shows_is_not_called_nothing() {
    let effects = weak_steering();
    let runs = [("arms", true), ("drive", false)];
    let answer = inquiry(runs.map(|(name, fit)| own_logs::run(name, &effects, fit)).into())
        .diagnose(&|_| ());
    assert_eq!(answer.verdict, Verdict::Unknown, "{:?}", answer.notes);
    assert_eq!(answer.places[0].spot.block, Block::Steering, "{:?}", answer.places);
    let untested: Vec<_> = answer.not_testable.iter().map(|one| one.effect.name).collect();
    assert!(untested.contains(&"steer-gain"), "{untested:?}");
    let told = |what: &str| answer.notes.iter().any(|note| note.contains(what));
    assert!(told("in the runs held out"), "{:?}", answer.notes);
    let steering = answer.not_testable.iter().find(|one| one.effect.name == "steer-gain").unwrap();
    assert_eq!(steering.remedy(), "fit drive", "that run steers");
    for one in &answer.not_testable {
        let sizes = answer.causes.iter().filter(|cause| cause.effect == one.effect);
        for size in sizes.flat_map(|cause| cause.parameters.iter().zip(cause.effect.parameters)) {
            let (estimate, of) = size;
            assert!(one.in_part || estimate.value[1..] == of.range, "{}", one.effect.name);
        }
    }
}

/// Nobody said what the runs are for: the one that steers is fitted, wherever it stands.
#[test]
fn the_only_run_that_steers_is_not_held_out() {
    let effects = Effects::default();
    let order = [["arms", "arms", "drive"], ["drive", "arms", "arms"]];
    for names in order {
        let mut asked = inquiry(names.map(|name| own_logs::run(name, &effects, true)).into());
        asked.hold_out_what_others_show();
        let fitted = asked.runs.iter().filter(|run| run.fit).map(FieldRun::file);
        let fitted: Vec<String> = fitted.collect();
        assert_eq!(fitted.len(), 2, "{fitted:?}");
        assert!(fitted.contains(&"drive".to_owned()), "{fitted:?}");
    }
}
