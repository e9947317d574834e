//! The next test drive must move what the rivals differ in.

mod frames;
mod made_up;
mod own_logs;

use frames::{decoder, once};
use made_up::{signals, swinging};
use xt28_gap::FieldLog;
use xt28_gap::diagnosis::{
    Cause, Diagnosis, Estimate, FieldRun, Inquiry, NotTestable, Verdict, next_drive, untested_drive,
};
use xt28_machine::Machine;
use xt28_sim::Effects;
use xt28_sim::effects::find;

fn inquiry() -> Inquiry {
    inquiry_of(&["a.log"])
}

fn inquiry_of(names: &[&str]) -> Inquiry {
    let (text, decoder) = (once("1.0"), decoder());
    let [signals] = signals(&swinging());
    let run = |name: &&str| {
        let log = FieldLog::read(text.as_bytes(), name, &decoder, false).unwrap();
        FieldRun { log, signals: signals.clone(), fit: true, scenario: None }
    };
    Inquiry::new(Machine::xt28(), names.iter().map(run).collect())
}

fn cause(name: &str, probability: f64, value: f64) -> Cause {
    let effect = find(name).unwrap();
    Cause {
        effect,
        scope: "all".parse().unwrap(),
        scopes: Vec::new(),
        values: Vec::new(),
        probability,
        parameters: vec![Estimate { name: effect.parameters[0].name, value: [value; 3] }],
        class: vec![effect.name],
        begins: None,
        shrink: None,
    }
}

fn diagnosis(causes: Vec<Cause>) -> Diagnosis {
    Diagnosis::of(Verdict::Effect, causes)
}

#[test]
fn a_late_joint_and_a_slow_one_are_told_apart_in_a_bend() {
    let rivals = vec![cause("steer-delay", 0.6, 0.3), cause("steer-lag", 0.3, 0.3)];
    let (next, manoeuvre) = next_drive(&inquiry(), &diagnosis(rivals)).unwrap().unwrap();
    assert!(["s-turn", "mixed"].contains(&next.manoeuvre.as_str()), "{}", next.manoeuvre);
    assert_eq!(
        (next.manoeuvre.as_str(), next.separates),
        (manoeuvre.name, ["steer-delay", "steer-lag"].map(str::to_owned).to_vec())
    );
    let nats = next.nats.expect("it tells apart");
    assert!(nats > 1.0, "{nats}");
    let worth: Vec<f64> = next.others.iter().filter_map(|drive| drive.nats).collect();
    assert!(worth.len() > 2 && worth.is_sorted_by(|a, b| a >= b) && worth[0] <= nats);
}

#[test]
fn without_causes_there_is_nothing_to_tell_apart() {
    assert!(next_drive(&inquiry(), &diagnosis(Vec::new())).unwrap().is_none());
}

#[test]
fn what_is_sure_needs_no_drive_nor_does_what_has_no_likely_rival() {
    let of = |causes, none| {
        let diagnosis = Diagnosis { probability_none: none, ..diagnosis(causes) };
        next_drive(&inquiry(), &diagnosis).unwrap()
    };
    let two = |a, b| vec![cause("steer-delay", a, 0.3), cause("steer-lag", b, 0.3)];
    assert!(of(two(0.97, 0.02), 0.0).is_none(), "one is sure");
    assert!(of(two(0.8, 0.005), 0.005).is_none(), "the rest is in no catalogue");
    assert!(of(two(0.005, 0.003), 0.99).is_none(), "the machine is sound");
    // Of a machine that does steer late: of one that does not, no drive takes evidence away.
    let mut late = Effects::default();
    let delay = find("steer-delay").unwrap().parameters;
    delay[0].set(&mut late, "all".parse().unwrap(), 0.3);
    let driven = vec![own_logs::run("drive", &late, true)];
    let late_or_none = Diagnosis { probability_none: 0.3, ..diagnosis(two(0.6, 0.005)) };
    let next = next_drive(&Inquiry::new(Machine::xt28(), driven), &late_or_none).unwrap();
    let (next, _) = next.expect("a cause or none");
    assert_eq!(next.separates, ["steer-delay", "none"]);
}

#[test]
fn wheels_that_one_cause_may_be_at_are_told_apart() {
    let late = cause("arm-delay", 0.98, 0.3);
    let scopes = ["all", "FR"].map(|scope| (scope.parse().unwrap(), 0.5)).to_vec();
    let late = Cause { scopes, values: vec![vec![0.3]; 2], ..late };
    let (next, _) = next_drive(&inquiry(), &diagnosis(vec![late])).unwrap().unwrap();
    assert_eq!(next.separates, ["arm-delay (all)", "arm-delay (FR)"]);
    assert!(next.nats.is_some_and(|nats| nats > 1.0), "{:?}", next.nats);
}

#[test]
fn a_drive_that_was_made_is_not_asked_for_again() {
    let rivals = vec![cause("steer-delay", 0.6, 0.3), cause("steer-lag", 0.3, 0.3)];
    let inquiry = inquiry_of(&["b/run-2-s_turn.log.gz", "b/run-3-mixed.log.gz"]);
    let next = next_drive(&inquiry, &diagnosis(rivals)).unwrap();
    if let Some((next, _)) = next {
        assert!(!["s-turn", "mixed"].contains(&next.manoeuvre.as_str()), "{}", next.manoeuvre);
    }
}

#[test]
fn what_no_log_tests_asks_for_the_drive_that_tests_most_of_it() {
    let lacking = |effect: &str, manoeuvre: &str| NotTestable {
        effect: find(effect).unwrap(),
        lacks: String::new(),
        manoeuvre: manoeuvre.to_owned(),
        more: None,
        fit: Vec::new(),
        in_part: false,
    };
    let not_testable = vec![
        lacking("valve-lag", "single-arm"),
        lacking("steer-lag", "s-turn"),
        lacking("steer-delay", "s-turn"),
    ];
    let lacks = Diagnosis { not_testable, ..diagnosis(Vec::new()) };
    let (next, manoeuvre) = untested_drive(&inquiry(), &lacks).unwrap();
    assert_eq!((next.manoeuvre.as_str(), manoeuvre.name), ("s-turn", "s-turn"));
    assert_eq!(next.tests, ["steer-lag", "steer-delay"]);
    assert!(next.separates.is_empty() && next.nats.is_none(), "it is not for that");
    let [other] = &next.others[..] else { panic!("one other tests something") };
    assert_eq!((other.manoeuvre.as_str(), &other.tests[..]), ("single-arm", &["valve-lag"][..]));
    assert!(untested_drive(&inquiry(), &diagnosis(Vec::new())).is_none(), "all is tested");
    let (next, _) = untested_drive(&inquiry_of(&["run-2-s_turn.log.gz"]), &lacks).unwrap();
    assert_eq!(next.manoeuvre, "single-arm", "the s-turn was driven, if held out");
}
