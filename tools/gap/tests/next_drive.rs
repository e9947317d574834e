//! The next test drive must move what the rivals differ in.

mod made_up;

use std::path::Path;

use made_up::{signals, swinging};
use xt28_gap::diagnosis::{Cause, Diagnosis, Estimate, FieldRun, Inquiry, Verdict, next_drive};
use xt28_gap::{Decoder, FieldLog, Mapping};
use xt28_machine::Machine;
use xt28_sim::effects::find;

fn inquiry() -> Inquiry {
    let decoder =
        Decoder::parse(include_str!("field.dbc"), Path::new("field.dbc"), &Mapping::default());
    let frames = [
        "0CFF4027#5555555555551299",
        "0CFF4127#00000000780201A6",
        "18FE1025#2800280028002900",
        "18FE1026#2A002B00",
        "18FE2020#F505F5050C030C03",
        "18FE202A#2C0F2C0F",
        "18FE202B#28000000FAFF0A00",
        "18FE1012#00000000640038FF",
        "0CFF5229#FE0310C0FF020080",
    ];
    let text: String = frames.iter().map(|frame| format!("(1.0) can0 {frame}\n")).collect();
    let log = FieldLog::read(text.as_bytes(), "a.log", &decoder.unwrap(), false).unwrap();
    let [signals] = signals(&swinging());
    Inquiry::new(Machine::xt28(), vec![FieldRun { log, signals, fit: true }])
}

fn cause(name: &str, probability: f64, value: f64) -> Cause {
    let effect = find(name).unwrap();
    Cause {
        effect,
        scope: "all".parse().unwrap(),
        scopes: Vec::new(),
        probability,
        parameters: vec![Estimate { name: effect.parameters[0].name, value: [value; 3] }],
        class: vec![effect.name],
        begins: None,
        shrink: None,
    }
}

fn diagnosis(causes: Vec<Cause>) -> Diagnosis {
    Diagnosis {
        verdict: Verdict::Effect,
        places: Vec::new(),
        causes,
        probability_none: 0.0,
        probability_unknown: 0.0,
        together: None,
        next: None,
        not_testable: Vec::new(),
        notes: Vec::new(),
        seconds: 0.0,
    }
}

#[test]
fn a_late_joint_and_a_slow_one_are_told_apart_in_a_bend() {
    let rivals = vec![cause("steer-delay", 0.6, 0.3), cause("steer-lag", 0.3, 0.3)];
    let (next, manoeuvre) = next_drive(&inquiry(), &diagnosis(rivals)).unwrap().unwrap();
    assert!(["s-turn", "mixed"].contains(&next.manoeuvre.as_str()), "{}", next.manoeuvre);
    assert_eq!(
        (next.manoeuvre.as_str(), next.separates),
        (manoeuvre.name, vec!["steer-delay", "steer-lag"])
    );
    assert!(next.nats > 1.0, "{}", next.nats);
}

#[test]
fn without_causes_there_is_nothing_to_tell_apart() {
    assert!(next_drive(&inquiry(), &diagnosis(Vec::new())).unwrap().is_none());
}
