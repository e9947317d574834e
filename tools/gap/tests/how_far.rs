//! How far the gap shrinks: on what our own plant does with an effect put in, and on logs of a second one.

use std::io::{self, Write as _};
use std::path::Path;

use proptest::prelude::*;
use xt28_gap::diagnosis::{
    Cause, DT_S, Diagnosis, Estimate, FieldRun, Horizon, HowFar, Inquiry, Quantity, Verdict,
    overlay,
};
use xt28_gap::{Decoder, FieldLog, Mapping, Terrain};
use xt28_machine::{Axle, Machine, Wheel};
use xt28_sim::effects::{Block, CATALOGUE, Effect, Overlay, Scope, find};

mod own_logs;

fn cause(name: &str, scope: Scope, parameters: &[(&'static str, f64)]) -> Cause {
    let estimate = |&(name, value): &(&'static str, f64)| Estimate { name, value: [value; 3] };
    cause_of(find(name).unwrap(), scope, parameters.iter().map(estimate).collect())
}

fn cause_of(effect: &'static Effect, scope: Scope, parameters: Vec<Estimate>) -> Cause {
    Cause {
        effect,
        scope,
        scopes: vec![(scope, 1.0)],
        values: Vec::new(),
        probability: 0.9,
        parameters,
        class: vec![effect.name],
        begins: None,
        shrink: None,
    }
}

/// The machine of these causes on two manoeuvres; the first is fitted, the second held out.
fn driven(causes: &[Cause]) -> HowFar {
    let effects = overlay(causes).effects(&Machine::xt28()).unwrap();
    let run = |name: &str, fit: bool| own_logs::run(name, &effects, fit);
    let runs = vec![run("arms", true), run("drive", false)];
    HowFar::new(&Inquiry::new(Machine::xt28(), runs)).unwrap()
}

#[test]
fn the_true_effect_closes_the_gap_and_a_wrong_one_does_not() {
    let truth = [cause("arm-delay", Scope::Axle(Axle::Front), &[("delay_s", 0.3)])];
    let far = driven(&truth);
    let right = far.shrink(&far.with(&truth));
    // What is left are strokes cut off to millimetres, and joints set down without their tyres' scrub.
    assert!(right.five_s > 0.7 && right.run > 0.9, "{right:?}");
    let [low, high] = right.interval[1];
    assert!(low <= right.five_s && right.five_s <= high);
    for wrong in [
        cause("arm-delay", Scope::Axle(Axle::Rear), &[("delay_s", 0.3)]),
        cause("throttle-delay", Scope::All, &[("delay_s", 0.3)]),
    ] {
        let effects = far.with(std::slice::from_ref(&wrong));
        let shrink = far.shrink(&effects);
        assert!(shrink.five_s < 0.1 && shrink.run < 0.1, "{}: {shrink:?}", wrong.effect.name);
        assert!(far.cost(&effects) > far.cost(&far.with(&truth)) + 20.0);
    }
    assert_eq!(far.shrink(&far.with(&[])).run, 0.0);
}

#[test]
fn a_refit_finds_the_size_and_is_never_worse_than_its_start() {
    let far = driven(&[cause("throttle-delay", Scope::All, &[("delay_s", 0.3)])]);
    let start = [cause("throttle-delay", Scope::All, &[("delay_s", 0.2)])];
    // Only the first run is fitted, and the arms' manoeuvre has the machine drive as well.
    let refit = far.refit(&start);
    let [delay_s, low, high] = refit.estimates[0][0].value;
    assert!((delay_s - 0.3).abs() < 0.015, "{delay_s}");
    assert!(low <= delay_s && delay_s <= high);
    assert!(refit.fit_gap[1] <= refit.fit_gap[0]);
    assert!(refit.shrink.run > far.shrink(&far.with(&start)).run);
}

#[test]
fn twice_the_same_is_the_same() {
    let truth = [cause("valve-gain", Scope::Wheel(Wheel::Fl), &[("factor", 1.3)])];
    let (a, b) = (driven(&truth), driven(&truth));
    assert_eq!(a.black_box(), b.black_box());
    assert_eq!(a.shrink(&a.with(&truth)), b.shrink(&b.with(&truth)));
    assert_eq!(a.traces(1, &truth), b.traces(1, &truth));
}

#[test]
fn a_cause_that_is_stood_by_and_shrinks_nothing_is_noted() {
    let said = |truth: &[Cause]| {
        let named = cause("throttle-delay", Scope::All, &[("delay_s", 0.3)]);
        let mut diagnosis = answer(vec![named]);
        driven(truth).complete(&mut diagnosis, &|_, _| ());
        assert_eq!(diagnosis.notes, diagnosis.unshrunk());
        diagnosis.notes
    };
    let [note] = &said(&[])[..] else { panic!("nothing is late") };
    assert!(note.starts_with("throttle-delay is named by its evidence"), "{note}");
    let truth = cause("throttle-delay", Scope::All, &[("delay_s", 0.3)]);
    assert_eq!(said(&[truth]), Vec::<String>::new());
}

/// A verdict that stands by `causes`, before it is said how far they shrink the gap.
fn answer(causes: Vec<Cause>) -> Diagnosis {
    Diagnosis { held_out_runs: vec!["drive".to_owned()], ..Diagnosis::of(Verdict::Effect, causes) }
}

/// The arms' measured strokes take away what a wrong arm does; the joints' angles do not.
#[test]
fn the_block_with_the_effect_carries_the_gap() {
    let far = driven(&[cause("valve-gain", Scope::All, &[("factor", 1.4)])]);
    let shares = far.shares();
    assert_eq!(shares[0].0, Block::Arms, "{shares:?}");
    assert!(shares[0].1 > 0.5, "{shares:?}");
    assert!((shares.iter().map(|(_, share)| share).sum::<f64>() - 1.0).abs() < 1e-9);
}

#[test]
fn traces_stand_beside_what_was_measured() {
    let far = driven(&[]);
    let traces = far.traces(1, &[]);
    let of = |name: &str| traces.channels.iter().find(|(c, ..)| c.to_string() == name).unwrap();
    let (_, measured, foretold) = of("wheel_speed.FR");
    assert_eq!(measured.len(), foretold.len());
    for at_s in [2.0, 5.0, 9.0] {
        let (m, o) = (measured.at(at_s).unwrap(), foretold.at(at_s + DT_S).unwrap());
        assert!((m - o).abs() < 0.05, "{at_s}: {m} {o}");
    }
}

proptest! {
    /// What a diagnosis writes is what a simulator reads, to the bit.
    #[test]
    fn an_overlay_reads_back_as_the_same_effects(
        picks in proptest::collection::vec((0..CATALOGUE.len(), 0..Scope::ALL.len(), 0.0..1.0_f64), 1..3)
    ) {
        let causes: Vec<Cause> = picks
            .into_iter()
            .map(|(effect, scope, share)| {
                let effect = &CATALOGUE[effect];
                let value = |[low, high]: [f64; 2]| low + share * (high - low);
                let estimate = |p: &'static xt28_sim::effects::Parameter| Estimate {
                    name: p.name,
                    value: [value(p.range); 3],
                };
                cause_of(effect, Scope::ALL[scope], effect.parameters.iter().map(estimate).collect())
            })
            .collect();
        let written = overlay(&causes);
        let read = Overlay::parse(&written.to_toml(), Path::new("overlay.toml")).unwrap();
        prop_assert_eq!(read.effects(&Machine::xt28()).unwrap(), written.effects(&Machine::xt28()).unwrap());
    }
}

/// How near a second plant's sound machine is foretold: what the floors rest on.
#[test]
fn a_sound_machine_is_foretold_to_about_a_floor() {
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/field-data/aux/nominal");
    if !data.exists() {
        #[allow(clippy::disallowed_macros)] // A test that skips says so.
        {
            let _ = writeln!(io::stdout(), "SKIPPED: {} is not there", data.display());
        }
        return;
    }
    let decoder = Decoder::load(&data.join("xt28-field.dbc"), &Mapping::default()).unwrap();
    let run = |name: &str| {
        let log = FieldLog::load(&data.join(name), &decoder, false).unwrap();
        FieldRun::new(log, Terrain::Flat, true).unwrap()
    };
    let runs = vec![run("run-1-arm_step.log.gz"), run("run-3-s_turn.log.gz")];
    let inquiry = Inquiry::new(Machine::xt28(), runs);
    let far = HowFar::new(&inquiry).unwrap();
    for horizon in [Horizon::FiveSeconds, Horizon::Run] {
        for (quantity, gap) in far.gap_by_signal(&inquiry.believed, horizon) {
            let most = if quantity == Quantity::SteerOpening { 3.0 } else { 2.5 };
            assert!(gap < most, "{quantity:?} over {horizon:?}: {gap}");
        }
    }
}
