//! From what the logs say to a verdict: is there something, is it known, what is it, how sure.
//!
//! The probabilities are not raw evidence, which is over-confident wherever the simulator is not quite
//! the machine. Three questions are asked in turn, each with a scale that was set on foreign machines of
//! our own making (`docs/diagnosis.md`): is there anything beyond tolerances; is it in the catalogue;
//! which of the catalogue is it.

mod allowed;
mod beginning;
mod causes;
mod notes;
mod objection;
mod places;
mod untested;

use super::candidates::Candidate;
use super::evidence::{Echo, Left, Uneven};
use super::inquiry::{FieldRun, Inquiry};
use super::knob::Knob;
use super::scales::{Chances, Grounds, Scales};
use super::verdict::{Diagnosis, Verdict};
use beginning::is_told;
use causes::causes;
pub(super) use causes::temperature;
use notes::notes;
use places::{places, unexplained};
use untested::tell_untested;

/// What the logs say of every hypothesis.
#[derive(Clone, Debug, Default)]
pub struct Findings {
    /// What each signal leaves while nothing is believed to be wrong, tolerances where they are believed
    /// to be.
    pub unbent: Vec<Left>,
    /// The same with the tolerances where they are while nothing is believed, none further than one of its
    /// own: what parts on a machine that nobody can name the fault of.
    pub alone: Vec<Left>,
    /// The same with the tolerances where they are once the best cause or pair is believed.
    pub apart: Vec<Left>,
    /// Single causes, best first.
    pub single: Vec<Candidate>,
    /// Pairs of causes, best first; empty where one is enough.
    pub pair: Vec<[Candidate; 2]>,
    /// What may be the first of the best pair, sought anew beside its second, best first.
    pub firsts: Vec<Candidate>,
    /// What each signal leaves under the best cause or pair.
    pub after: Vec<Left>,
    /// How much of that is what they explain, moved in time.
    pub echoes: Vec<Echo>,
    /// Whether it is another share of that in one half of all runs than in the other.
    pub unevens: Vec<Uneven>,
    /// The runs that were held out.
    pub held: HeldOut,
    /// Where the tolerances go beside the best cause or pair, each by how many of its own.
    pub shifts: Vec<(Knob, f64)>,
}

/// What runs that were held out say of the best cause or pair; nothing where there are none.
#[derive(Clone, Debug, Default)]
pub struct HeldOut {
    /// [`Findings::unbent`] of them.
    pub unbent: Vec<Left>,
    /// [`Findings::after`] of them, tolerances at their best there.
    pub after: Vec<Left>,
    /// [`Findings::shifts`] of them.
    pub shifts: Vec<(Knob, f64)>,
}

impl Findings {
    /// How far the worst signal lies above what a right answer leaves, or its echo above that of one, or
    /// the tolerances, all together or the one that goes furthest, above what it takes; about one where
    /// all is explained.
    #[must_use]
    pub fn left_over(&self) -> f64 {
        self.objection().times
    }

    /// What [`Self::left_over`] is about, after `because`.
    #[must_use]
    pub fn left_over_why(&self) -> String {
        self.objection().why
    }

    /// The same of the runs held out alone, and what speaks loudest there; nothing without any.
    #[must_use]
    pub fn left_over_held(&self) -> Option<(f64, String)> {
        let loudest = self.held_left().max_by(|a, b| a.times.total_cmp(&b.times))?;
        Some((loudest.times, loudest.why))
    }

    /// What a verdict on them rests on.
    #[must_use]
    pub fn grounds(&self) -> Grounds {
        Grounds { evidence_nats: self.evidence(), left_over: self.left_over() }
    }

    /// The best pair, or the best cause where one is enough.
    fn believed(&self) -> impl Iterator<Item = &Candidate> {
        let alone = self.single.first().filter(|_| self.pair.is_empty());
        self.pair.first().into_iter().flatten().chain(alone)
    }

    /// Evidence of the best cause, nats.
    #[must_use]
    pub fn evidence(&self) -> f64 {
        self.single.first().map_or(0.0, |best| best.score().max(0.0))
    }
}

/// The verdict on `findings`.
pub(super) fn judge(inquiry: &Inquiry, findings: &Findings) -> Diagnosis {
    let grounds = findings.grounds();
    let chances = Scales::IN_USE.chances(grounds);
    let mut causes = causes(findings, chances.known);
    for cause in causes.iter_mut().filter(|cause| !is_told(inquiry, cause)) {
        cause.begins = None;
    }
    let verdict = likeliest(&chances);
    // Beside a wrong name tolerances go where that name needs them.
    let apart = if verdict == Verdict::Unknown { &findings.alone } else { &findings.apart };
    let held_speak = verdict == Verdict::Unknown && findings.objection().is_held_out;
    let (apart, after) = match &findings.held {
        held if held_speak => (&held.unbent, &held.after),
        _ => (apart, &findings.after),
    };
    let places = places(apart, after);
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

    use super::super::floor::Signal;
    use super::super::generator::Generator;
    use super::*;

    fn candidate(name: &str, score: f64) -> Candidate {
        Candidate::made_up(name, Scope::All, score)
    }

    fn left(square: f64) -> Vec<Left> {
        vec![Left::evenly(Generator::ArmStroke(Wheel::Fr), Signal::Stroke, square, 100.0)]
    }

    fn judged(before: f64, after: f64, single: Vec<Candidate>) -> Diagnosis {
        let findings = Findings {
            unbent: left(before),
            alone: left(before),
            apart: left(before),
            single,
            after: left(after),
            ..Findings::default()
        };
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
        let of = |generator, signal, squares| {
            let left = left(squares);
            left.into_iter().map(|l| Left { generator, signal, ..l }).collect::<Vec<_>>()
        };
        let both = |stroke, roll| {
            let stroke = of(Generator::ArmStroke(Wheel::Fr), Signal::Stroke, stroke);
            [stroke, of(Generator::Stance, Signal::Roll, roll)].concat()
        };
        let before = both(900.0, 100.0);
        let findings = Findings {
            unbent: before.clone(),
            alone: before.clone(),
            apart: before,
            single: vec![candidate("leakage-drift", 900.0)],
            after: both(1.0, 100.0),
            ..Findings::default()
        };
        let diagnosis = judge(&Inquiry::new(Machine::xt28(), Vec::new()), &findings);
        assert_eq!(diagnosis.places[0].spot.part, "arm");
        let spot = diagnosis.unexplained.expect("a signal speaks against it");
        assert_eq!((spot.part, spot.residual.as_str()), ("stance", "roll"));
    }

    #[test]
    fn where_nobody_knows_the_cause_a_wrong_name_does_not_move_the_place() {
        let steering = || {
            let generator = Generator::Joint(0);
            let left = left(30.0);
            left.into_iter().map(|l| Left { generator, signal: Signal::JointAngle, ..l }).collect()
        };
        let findings = |left_over| Findings {
            unbent: left(400.0),
            alone: steering(),
            apart: left(400.0),
            single: vec![candidate("leakage-drift", 300.0)],
            after: left(left_over),
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
                unbent: left(1.0),
                alone: left(1.0),
                apart: left(1.0),
                after: left(1.0),
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
            unbent: left(100.0),
            alone: left(100.0),
            apart: left(100.0),
            single: vec![a.clone(), b.clone()],
            pair: vec![[a, b]],
            after: left(1.0),
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
