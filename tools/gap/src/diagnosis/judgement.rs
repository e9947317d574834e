//! From what the logs say to a verdict: is there something, is it known, what is it, how sure.
//!
//! The probabilities are not raw evidence, which is over-confident wherever the simulator is not quite
//! the machine. Three questions are asked in turn, each with a scale that was set on foreign machines of
//! our own making (`docs/diagnosis.md`): is there anything beyond tolerances; is it in the catalogue;
//! which of the catalogue is it.

mod allowed;
mod beginning;
mod causes;
mod findings;
mod notes;
mod objection;
mod places;
mod untested;

use super::evidence::Left;
use super::inquiry::{FieldRun, Inquiry};
use super::scales::{Chances, Scales};
use super::verdict::{Diagnosis, Verdict};
use beginning::is_told;
use causes::causes;
pub(super) use causes::temperature;
pub use findings::{Findings, HeldOut, HeldOutSignal, SignalFindings};
use notes::notes;
use places::{places, unexplained};
use untested::tell_untested;

/// The verdict on `findings`.
pub(super) fn judge(inquiry: &Inquiry, findings: &Findings) -> Diagnosis {
    let grounds = findings.grounds();
    let chances = Scales::IN_USE.chances(grounds);
    let mut causes = causes(findings, chances.known);
    let runs = || inquiry.runs.iter().map(|run| &run.signals);
    for cause in &mut causes {
        cause.begins = cause.begins.take().filter(|begins| is_told(inquiry, cause, begins.onset));
        cause.begins.iter_mut().for_each(|begins| begins.told_by(runs()));
    }
    let verdict = likeliest(&chances);
    let [before, after] = gaps(findings, verdict);
    let places = places(&before, &after);
    let objection = findings.objection().at.filter(|_| verdict == Verdict::Unknown);
    let mut diagnosis = Diagnosis {
        unexplained: objection.map(|at| unexplained(at, &places)),
        places,
        probability_none: chances.none,
        probability_unknown: chances.unknown,
        probability_unseen: chances.unseen,
        grounds,
        held_out_runs: held_out_runs(inquiry),
        log_faults: log_faults(inquiry),
        ..Diagnosis::of(verdict, causes)
    };
    tell_untested(&mut diagnosis, inquiry);
    diagnosis.notes = notes(inquiry, findings, verdict);
    diagnosis
}

/// What each signal leaves before and after the best cause or pair is believed, as places are told by.
fn gaps(findings: &Findings, verdict: Verdict) -> [Vec<Left>; 2] {
    let (signals, held_out) = (findings.signals.iter(), findings.held_out.signals.iter());
    let (before, after) = match verdict {
        Verdict::Unknown if findings.objection().is_held_out => {
            held_out.map(|of| (of.unbent, of.after)).unzip()
        }
        // Beside a wrong name tolerances go where that name needs them.
        Verdict::Unknown => signals.map(|of| (of.alone, of.after)).unzip(),
        Verdict::Effect | Verdict::None => signals.map(|of| (of.apart, of.after)).unzip(),
    };
    [before, after]
}

/// The likeliest of the three answers that a log can tell apart.
fn likeliest(chances: &Chances) -> Verdict {
    if chances.none >= chances.known.max(chances.unknown) {
        Verdict::None
    } else if chances.unknown > chances.known {
        Verdict::Unknown
    } else {
        Verdict::Effect
    }
}

/// Every fault of every log.
fn log_faults(inquiry: &Inquiry) -> Vec<String> {
    inquiry.runs.iter().flat_map(|run| run.log.each_fault()).collect()
}

/// File names of the runs that were not fitted.
fn held_out_runs(inquiry: &Inquiry) -> Vec<String> {
    let held = inquiry.runs.iter().filter(|run| !run.fit);
    held.map(FieldRun::file).collect()
}

#[cfg(test)]
mod tests {
    use xt28_machine::{Machine, Wheel};
    use xt28_sim::effects::{Block, Scope};

    use super::super::candidate::Candidate;
    use super::super::floor::Signal;
    use super::super::generator::Generator;
    use super::super::knob::Knob;
    use super::*;

    fn candidate(name: &str, score: f64) -> Candidate {
        Candidate::made_up(name, Scope::All, score)
    }

    fn left(square: f64) -> Left {
        Left::evenly(Generator::ArmStroke(Wheel::Fr), Signal::Stroke, square, 100.0)
    }

    /// One signal before and after the best cause is believed.
    fn signals(squares: [f64; 2]) -> Vec<SignalFindings> {
        vec![SignalFindings::of(squares.map(left))]
    }

    fn judged(before: f64, after: f64, single: Vec<Candidate>) -> Diagnosis {
        let signals = signals([before, after]);
        let findings = Findings { signals, single, ..Findings::default() };
        judge(&Inquiry::new(Machine::xt28(), Vec::new()), &findings)
    }

    #[test]
    fn the_likeliest_answer_is_the_verdict_even_where_none_has_half() {
        let of = |none, unknown, known| {
            likeliest(&Chances { none, unseen: 1.0 - none - unknown - known, unknown, known })
        };
        assert_eq!(of(0.41, 0.36, 0.21), Verdict::None);
        assert_eq!(of(0.30, 0.36, 0.33), Verdict::Unknown);
        assert_eq!(of(0.30, 0.33, 0.36), Verdict::Effect);
    }

    #[test]
    fn a_quiet_machine_has_nothing() {
        let diagnosis = judged(0.8, 0.7, vec![candidate("arm-delay", 2.0)]);
        assert_eq!(diagnosis.verdict, Verdict::None);
        assert!(diagnosis.causes.iter().all(|cause| cause.probability < 0.5));
        assert!(diagnosis.probability_none > 0.9);
    }

    #[test]
    fn a_gap_that_is_explained_has_its_cause() {
        let all = vec![candidate("leakage-drift", 2000.0), candidate("valve-gain", 900.0)];
        let diagnosis = judged(400.0, 1.3, all);
        assert_eq!(diagnosis.verdict, Verdict::Effect);
        assert_eq!(diagnosis.causes[0].effect.name, "leakage-drift");
        assert!(diagnosis.causes[0].probability > 0.9);
        assert_eq!(diagnosis.causes[0].class, ["leakage-drift"]);
    }

    #[test]
    fn a_gap_that_the_best_cause_leaves_open_is_unknown() {
        let diagnosis = judged(400.0, 250.0, vec![candidate("leakage-drift", 300.0)]);
        assert_eq!(diagnosis.verdict, Verdict::Unknown);
        assert!(diagnosis.causes[0].probability < 0.5);
        let [.., why] = &diagnosis.notes[..] else { panic!("it says why") };
        assert!(why.contains("15.8 floors of 20.0"), "{why}");
        assert!(why.starts_with("leakage-drift (all)"), "{why}");
        assert!(!why.contains("likeliest"), "its probability is next to nothing: {why}");
    }

    #[test]
    fn what_is_unknown_is_where_the_objection_is_and_not_where_the_gap_is_largest() {
        let of = |generator, signal, squares: [f64; 2]| {
            let left = squares.map(|square| Left { generator, signal, ..left(square) });
            SignalFindings::of(left)
        };
        let stroke = of(Generator::ArmStroke(Wheel::Fr), Signal::Stroke, [900.0, 1.0]);
        let roll = of(Generator::Stance, Signal::Roll, [100.0, 100.0]);
        let findings = Findings {
            signals: vec![stroke, roll],
            single: vec![candidate("leakage-drift", 900.0)],
            ..Findings::default()
        };
        let diagnosis = judge(&Inquiry::new(Machine::xt28(), Vec::new()), &findings);
        assert_eq!(diagnosis.places[0].spot.part, "arm");
        let spot = diagnosis.unexplained.expect("a signal speaks against it");
        assert_eq!((spot.part, spot.residual.as_str()), ("stance", "roll"));
    }

    #[test]
    fn where_nobody_knows_the_cause_a_wrong_name_does_not_move_the_place() {
        let (generator, signal) = (Generator::Joint(0), Signal::JointAngle);
        let alone = Left { generator, signal, ..left(30.0) };
        let findings = |left_over| Findings {
            signals: vec![SignalFindings {
                alone,
                ..SignalFindings::of([400.0, left_over].map(left))
            }],
            single: vec![candidate("leakage-drift", 300.0)],
            ..Findings::default()
        };
        let inquiry = Inquiry::new(Machine::xt28(), Vec::new());
        let block = |left_over| judge(&inquiry, &findings(left_over)).places[0].spot.block;
        assert_eq!([block(1.0), block(250.0)], [Block::Arms, Block::Steering]);
    }

    #[test]
    fn what_a_tolerance_has_to_hide_is_unknown() {
        let [knob, ..] = Knob::all()[..] else { panic!("there are knobs") };
        let inquiry = Inquiry::new(Machine::xt28(), Vec::new());
        let verdict = |by: f64| {
            let findings = Findings {
                signals: signals([1.0, 1.0]),
                shifts: vec![(knob, by)],
                ..Findings::default()
            };
            judge(&inquiry, &findings).verdict
        };
        assert_eq!([verdict(-3.0), verdict(-9.0)], [Verdict::None, Verdict::Unknown]);
    }

    #[test]
    fn effects_that_the_logs_cannot_part_are_a_class() {
        let all = vec![candidate("arm-delay", 80.0), candidate("valve-lag", 79.0)];
        let diagnosis = judged(30.0, 1.0, all);
        assert_eq!(diagnosis.causes[0].class, ["arm-delay", "valve-lag"]);
        assert!(diagnosis.causes[0].probability < 0.9);
    }

    #[test]
    fn both_of_a_pair_are_stood_by() {
        let [a, b] = [candidate("arm-delay", 500.0), candidate("payload", 300.0)];
        let findings = Findings {
            signals: signals([100.0, 1.0]),
            single: vec![a.clone(), b.clone()],
            pair: vec![[a, b]],
            ..Findings::default()
        };
        let diagnosis = judge(&Inquiry::new(Machine::xt28(), Vec::new()), &findings);
        let stood: Vec<&str> = diagnosis
            .causes
            .iter()
            .filter(|c| c.probability > 0.5)
            .map(|c| c.effect.name)
            .collect();
        assert_eq!(stood, ["arm-delay", "payload"]);
    }

    #[test]
    fn probabilities_make_one() {
        let all = vec![candidate("arm-delay", 30.0), candidate("payload", 25.0)];
        let d = judged(9.0, 4.0, all);
        let known: f64 = d.causes.iter().map(|cause| cause.probability).sum();
        let others = [d.probability_none, d.probability_unseen, d.probability_unknown];
        assert!((known + others.iter().sum::<f64>() - 1.0).abs() < 1e-9);
    }
}
