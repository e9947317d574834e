//! What a reader of the verdict should know beside it, a sentence each.

use super::super::agreement::axles_alike;
use super::super::candidate::Candidate;
use super::super::evidence::Left;
use super::super::floor::Signal;
use super::super::floors::Floors;
use super::super::hypothesis::Fit;
use super::super::inquiry::Inquiry;
use super::super::onset::on_the_day;
use super::super::signals::{PERIOD_S, command_periods_s};
use super::super::verdict::Verdict;
use super::objection::Objection;
use super::{Findings, SignalFindings};

/// A gap beyond this is no other machine's, but may be another wheel's.
const WHEELS_APART: f64 = 5.0;
/// Share of what there is to explain below which no cause has a name that is worth a look.
const FAIR_SHARE: f64 = 0.2;

/// The notes on `findings` that came to this verdict.
pub(super) fn notes(inquiry: &Inquiry, findings: &Findings, verdict: Verdict) -> Vec<String> {
    let mut notes = Vec::new();
    notes.extend(findings.chosen_by_held());
    notes.extend(begun_underway(inquiry));
    notes.extend(commanded_seldom(inquiry));
    notes.extend(slopes_unseen(inquiry));
    notes.extend(Floors::remark(inquiry.runs.iter().map(|run| &run.signals.floors)));
    let alike = axles_alike(inquiry.runs.iter().map(|run| &run.signals));
    if !alike.is_empty() {
        notes.push(format!(
            "the arms of one axle ({}) are never commanded apart: whether left and right are in their \
             places there is as the mapping has it",
            alike.join(", ")
        ));
    }
    if verdict == Verdict::Unknown {
        let objection = findings.objection();
        notes.extend(findings.another_order());
        notes.extend(joints_elsewhere(&objection));
        notes.extend(order_unknown(inquiry));
        notes.push(findings.why_unknown(&objection));
    }
    notes
}

/// Runs that begin while the machine moves.
fn begun_underway(inquiry: &Inquiry) -> Option<String> {
    let underway = inquiry.runs.iter().filter_map(|run| {
        let settles_s = run.signals.settles_s();
        (settles_s > 0.0).then(|| format!("{settles_s:.0} s of {}", run.file()))
    });
    let underway: Vec<String> = underway.collect();
    (!underway.is_empty()).then(|| {
        let told = underway.join(", ");
        format!(
            "the first {told} are not judged: the machine moves as the log begins, and what was before it still \
             works on; begin logs at rest"
        )
    })
}

/// Runs whose commands come less often than the wire contract has it.
fn commanded_seldom(inquiry: &Inquiry) -> Option<String> {
    let seldom = inquiry.runs.iter().filter_map(|run| {
        let [arms, drive] = command_periods_s(&run.signals).map(|period_s| 1e3 * period_s);
        let told = if (arms - drive).abs() < 0.5 {
            format!("every {arms:.0} ms")
        } else {
            format!("every {arms:.0} ms (arms) and {drive:.0} ms (drive)")
        };
        (arms.max(drive) > 1e3 * PERIOD_S).then(|| format!("{told} in {}", run.file()))
    });
    let seldom: Vec<String> = seldom.collect();
    (!seldom.is_empty()).then(|| {
        let told = seldom.join(", ");
        format!(
            "commands come {told}, and not every 10 ms: their loss and lateness are judged by that"
        )
    })
}

/// Runs on a slope without a word on which way the machine heads.
fn slopes_unseen(inquiry: &Inquiry) -> Option<String> {
    let unseen = inquiry.runs.iter().filter(|run| run.signals.heads_unknown_on_slope());
    let unseen: Vec<String> = unseen.map(|run| run.file()).collect();
    (!unseen.is_empty()).then(|| {
        let runs = unseen.join(", ");
        format!(
            "the ground of {runs} slopes and no receiver says which way the machine heads on it, so how it stands and \
             what drives it is not judged there: log the receiver's heading"
        )
    })
}

/// What sets in once can be looked for only where one knows which run came first.
fn order_unknown(inquiry: &Inquiry) -> Option<String> {
    let runs: Vec<_> = inquiry.runs.iter().map(|run| &run.signals).collect();
    (runs.len() > 1 && on_the_day(runs).is_empty()).then(|| {
        "the stamps of the logs do not say which was recorded first, so nothing was looked for that set in with one \
         run and stayed: give logs with their dates"
            .to_owned()
    })
}

/// No effect of the catalogue makes a machine turn otherwise than its joints read.
fn joints_elsewhere(objection: &Objection) -> Option<String> {
    let (_, signal) = objection.at?;
    (signal == Signal::YawRate).then(|| {
        "the machine does not turn as its joints read: a joint's sensor that is late, off or of another scale \
         looks like this, so compare its reading with the joint, at rest and while it turns"
            .to_owned()
    })
}

impl Findings {
    /// Causes for which the runs held out were no judges alone.
    fn chosen_by_held(&self) -> Option<String> {
        let chosen = self.believed().filter(|cause| cause.is_chosen_by_held);
        let names: Vec<&str> = chosen.map(Candidate::name).collect();
        (!names.is_empty()).then(|| {
            format!(
                "the runs fitted leave sizes or beginning of {} open; those were taken that suit the runs held out as \
                 well, so that how much is foretold there, and how far the gap shrinks there, flatters a little",
                names.join(" and ")
            )
        })
    }

    /// Wheels that a mapping has in another order make a machine that stands as no machine does, while
    /// commands and readings agree.
    fn another_order(&self) -> Option<String> {
        let tells = |signal| {
            use Signal::{ArmOpening, Contact, DriveDifference, Roll, Stroke, WeightX, WeightY};
            matches!(
                signal,
                ArmOpening | Contact(_) | DriveDifference | Roll | Stroke | WeightX | WeightY
            )
        };
        let fitted = self.signals.iter().map(|of| &of.alone);
        let all: Vec<&Left> =
            fitted.chain(self.held_out.signals.iter().map(|of| &of.unbent)).collect();
        let worst = all.iter().max_by(|a, b| a.square.total_cmp(&b.square))?;
        let is_apart = |left: &Left| left.square > WHEELS_APART * WHEELS_APART;
        // Where wheels are exchanged, each of them is off.
        let arm = worst.generator.wheel();
        let is_one_arm = arm.is_some()
            && all.iter().all(|left| {
                left.generator.wheel().is_none_or(|wheel| Some(wheel) == arm) || !is_apart(left)
            });
        let is_another_order = tells(worst.signal) && is_apart(worst) && !is_one_arm;
        is_another_order.then(|| {
            "wheels in another order than the mapping has them look like this too: compare the names of \
             wheels in the DBC and the mapping with the machine"
                .to_owned()
        })
    }

    /// How much of the squares of all gaps beyond their floors the best cause or pair takes away, beside tolerances
    /// that are the same with it and without: where next to nothing, something fits best all the same.
    fn explained_share(&self) -> f64 {
        let beyond = |of: fn(&SignalFindings) -> &Left| -> f64 {
            let all = self.signals.iter().map(of);
            all.map(|left| (left.square - 1.0).max(0.0) * left.samples).sum()
        };
        let there = beyond(|of| &of.apart).max(f64::MIN_POSITIVE);
        1.0 - beyond(|of| &of.after) / there
    }

    fn why_unknown(&self, objection: &Objection) -> String {
        let believed = self.believed().map(|Candidate { fit: Fit { hypothesis, .. }, .. }| {
            format!("{} ({})", hypothesis.effect.name, hypothesis.scope)
        });
        let believed: Vec<String> = believed.collect();
        let share = self.explained_share();
        let best = if believed.is_empty() || share <= 0.0 {
            "nothing in the catalogue explains anything, but something is the matter".to_owned()
        } else if share < FAIR_SHARE {
            let percent = (100.0 * share).max(1.0);
            format!(
                "nothing in the catalogue explains more than {percent:.0} % of what is the matter"
            )
        } else {
            let best = believed.join(" beside ");
            format!("{best} fits best of all in the catalogue, but is not believed")
        };
        let Objection { times, why, .. } = objection;
        format!("{best}, because {why}: {times:.1} times the most that a right answer leaves")
    }
}

#[cfg(test)]
mod tests {
    use xt28_machine::Wheel;
    use xt28_sim::effects::Scope;

    use super::super::super::generator::Generator;
    use super::*;

    #[test]
    fn a_cause_that_the_runs_held_out_helped_to_choose_is_told_to_be_so() {
        let told = |is_chosen_by_held| {
            let alone = Candidate::made_up("accumulator-gas", Scope::All, 90.0);
            let single = vec![Candidate { is_chosen_by_held, ..alone }];
            Findings { single, ..Findings::default() }.chosen_by_held()
        };
        assert_eq!(told(false), None);
        assert!(told(true).is_some_and(|told| told.contains("of accumulator-gas open")));
    }

    #[test]
    fn what_fits_best_is_named_only_where_it_explains_a_fair_share() {
        let of = |square: f64| {
            let left = |square| Left::evenly(Generator::Stance, Signal::Roll, square, 100.0);
            let single = vec![Candidate::made_up("soft-tyres", Scope::All, 90.0)];
            let signals = vec![SignalFindings::of([400.0, square].map(left))];
            let findings = Findings { single, signals, ..Findings::default() };
            findings.why_unknown(&findings.objection())
        };
        assert!(of(200.0).starts_with("soft-tyres (all) fits best"), "{}", of(200.0));
        let little = of(380.0);
        assert!(little.starts_with("nothing in the catalogue explains more than 5 %"), "{little}");
        assert!(
            !little.contains("soft-tyres") && little.contains("of the roll of stance"),
            "{little}"
        );
        assert!(
            of(400.0).starts_with("nothing in the catalogue explains anything"),
            "{}",
            of(400.0)
        );
    }

    #[test]
    fn a_machine_that_stands_askew_may_have_its_wheels_in_another_order() {
        let of = |signal, floors: f64| {
            let left = Left::evenly(Generator::Stance, signal, floors * floors, 30.0);
            let signals = vec![SignalFindings::of([left, left])];
            Findings { signals, ..Findings::default() }.another_order().is_some()
        };
        assert!(of(Signal::Roll, 18.0));
        assert!(!of(Signal::Roll, 3.0));
        assert!(!of(Signal::Pitch, 18.0));
    }

    #[test]
    fn an_arm_that_is_off_alone_is_not_in_another_place() {
        let of = |other: f64| {
            let arm = |wheel, floors: f64| {
                let (arm, square) = (Generator::ArmStroke(wheel), floors * floors);
                let left = Left::evenly(arm, Signal::Stroke, square, 30.0);
                SignalFindings::of([left, left])
            };
            let signals = vec![arm(Wheel::Bl, 22.0), arm(Wheel::Mr, other)];
            Findings { signals, ..Findings::default() }.another_order().is_some()
        };
        assert!(!of(1.3));
        assert!(of(12.0));
    }

    #[test]
    fn a_machine_that_turns_otherwise_has_joints_to_be_looked_at() {
        let of = |signal| {
            let left = |square| Left::evenly(Generator::Turning, signal, square, 100.0);
            let single = vec![Candidate::made_up("steer-lag", Scope::All, 90.0)];
            let signals = vec![SignalFindings::of([9.0, 8.0].map(left))];
            let findings = Findings { single, signals, ..Findings::default() };
            joints_elsewhere(&findings.objection())
        };
        assert!(of(Signal::YawRate).is_some_and(|note| note.contains("a joint's sensor")));
        assert_eq!(of(Signal::TravelSpeed), None);
    }
}
