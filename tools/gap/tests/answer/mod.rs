//! A made-up answer and the logs that it is of, with a name in every text that must be escaped.

use xt28_gap::FieldLog;
use xt28_gap::diagnosis::{
    Cause, Details, Diagnosis, Drive, Estimate, FieldRun, Grounds, Inquiry, Next, NotTestable,
    Place, ShareOf, Shrink, Spot, Together, Verdict,
};
use xt28_gap::page::{Subject, html};
use xt28_machine::Machine;
use xt28_sim::effects::{Block, find};

use crate::frames::{decoder, once};
use crate::made_up::{signals, swinging};

/// A name that would be a program, if a browser took it for one.
pub(crate) const HOSTILE: &str = "<script>alert('1')</script>&\".log";

pub(crate) fn inquiry() -> Inquiry {
    let text = once("1.0") + &once("9.0");
    let log = FieldLog::read(text.as_bytes(), HOSTILE, &decoder(), false).unwrap();
    assert!(!log.faults().is_empty(), "the pause is a fault with the log's name in it");
    let [signals] = signals(&swinging());
    let run = |fit| FieldRun { log: log.clone(), signals: signals.clone(), fit, scenario: None };
    Inquiry::new(Machine::xt28(), vec![run(true), run(false)])
}

pub(crate) fn shrink() -> Shrink {
    let interval = [[0.5, 0.6], [0.7, 0.9], [0.6, 0.85]];
    Shrink { one_step: 0.55, five_s: 0.81, run: -0.2, interval }
}

pub(crate) fn diagnosis(verdict: Verdict) -> Diagnosis {
    let cause = |name: &str, probability| Cause {
        effect: find(name).unwrap(),
        scope: "front".parse().unwrap(),
        scopes: vec![("front".parse().unwrap(), 0.7), ("FR".parse().unwrap(), 0.3)],
        values: Vec::new(),
        probability,
        parameters: vec![Estimate {
            name: find(name).unwrap().parameters[0].name,
            value: [0.21, 0.19, 0.23],
        }],
        class: vec![find(name).unwrap().name, "valve-lag"],
        begins: None,
        shrink: Some(shrink()),
    };
    let place = |block, scope: &str, gap_over_noise| Place {
        spot: Spot {
            block,
            part: "stance",
            scope: scope.parse().unwrap(),
            residual: HOSTILE.to_owned(),
        },
        gap_over_noise,
        share: 0.5,
    };
    Diagnosis {
        verdict,
        places: vec![
            place(Block::Arms, "FR", 84.0),
            place(Block::Steering, "all", 2.0),
            place(Block::Payload, "all", 0.0),
        ],
        share_of: ShareOf::Machine,
        unexplained: None,
        causes: vec![cause("arm-delay", 0.93), cause("leakage-drift", 0.71)],
        probability_none: 0.01,
        probability_unknown: 0.02,
        probability_unseen: 0.0,
        grounds: Grounds { evidence_nats: 900.0, left_over: 0.7 },
        together: Some(Together {
            effects: vec!["arm-delay", "leakage-drift"],
            shrink: shrink(),
            black_box: shrink(),
            held_out_runs: vec![HOSTILE.to_owned()],
        }),
        held_out_runs: vec![HOSTILE.to_owned()],
        looked_ahead: true,
        next: Some(Next {
            manoeuvre: HOSTILE.to_owned(),
            separates: ["arm-delay", "valve-lag"].map(str::to_owned).to_vec(),
            nats: Some(3.1),
            tests: vec!["steer-lag"],
            others: vec![Drive {
                manoeuvre: HOSTILE.to_owned(),
                nats: Some(1.2),
                tests: Vec::new(),
            }],
        }),
        not_testable: vec![NotTestable {
            effect: find("steer-lag").unwrap(),
            lacks: HOSTILE.to_owned(),
            manoeuvre: "s-turn".to_owned(),
            more: None,
            fit: Vec::new(),
            in_part: false,
        }],
        notes: vec![HOSTILE.to_owned()],
        log_faults: Vec::new(),
        seconds: 41.2,
    }
}

pub(crate) fn page(verdict: Verdict) -> String {
    page_of(&diagnosis(verdict))
}

pub(crate) fn page_of(diagnosis: &Diagnosis) -> String {
    let inquiry = inquiry();
    let details = Details::new(&inquiry, diagnosis).unwrap();
    let subject = Subject { name: HOSTILE.to_owned(), date: HOSTILE.to_owned() };
    html(&subject, &inquiry.machine, diagnosis, &details)
}
