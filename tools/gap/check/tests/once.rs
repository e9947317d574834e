//! A foreign machine that breaks between two runs of a day: what is sought once, and what is told of it.

use std::sync::LazyLock;

use xt28_gap::diagnosis::{Evidence, FieldRun, Generator, Inquiry, Knob, Onset, Verdict, search};
use xt28_gap::page;
use xt28_gap_check::Source;
use xt28_gap_plants::{Case, Cause, Scope};
use xt28_machine::{Machine, Side, Wheel};
use xt28_sim::Effects;
use xt28_sim::effects::find;

/// Runs of a machine of seed 901 as it leaves the works, and with a leak in its left arms.
static BOTH: LazyLock<[Vec<FieldRun>; 2]> = LazyLock::new(|| {
    let leak = Cause::find("leakage-drift").unwrap();
    let leaking = Case::of(901, leak, Scope::Side(Side::Left));
    let of = |case: Case| Source::Drawn(Box::new(case)).inquiry().expect("it has runs").runs;
    [of(leaking.without_faults()), of(leaking)]
});

/// Its runs, with the leak in those that `leaks` says.
fn runs(leaks: impl Fn(usize) -> bool) -> Vec<FieldRun> {
    let [sound, leaking] = BOTH.clone();
    let pick = |(k, (sound, leaking)): (usize, (FieldRun, FieldRun))| {
        let run = if leaks(k) { leaking } else { sound };
        let (terrain, name) = (run.signals.terrain.clone(), run.file());
        let again = FieldRun::new(run.log, terrain, run.fit).expect("it was read before");
        again.driven(run.scenario).called(name)
    };
    sound.into_iter().zip(leaking).enumerate().map(pick).collect()
}

/// When a leak of the left front arm is found to set in, by what that arm does.
fn found(inquiry: &Inquiry) -> (Onset, f64) {
    let signals: Vec<_> = inquiry.runs.iter().map(|run| run.signals.clone()).collect();
    let watched = vec![Generator::ArmStroke(Wheel::Fl)];
    let nothing = Effects::default();
    let evidence = Evidence::watching(watched, &signals, &inquiry.machine, nothing, &Knob::all());
    let fits = search(&evidence, &[find("leakage-drift").unwrap()]);
    (fits[0].onset, fits[0].values[0])
}

#[test]
fn a_machine_that_breaks_between_two_runs_is_told_from_one_that_always_leaked() {
    let broken = Inquiry::new(Machine::xt28(), runs(|k| k >= 2));
    let began_s = broken.runs[2].signals.began_s;
    assert!(began_s > 40.0, "runs are put one behind the other: {began_s}");
    let (onset, size_m_s) = found(&broken);
    assert_eq!(onset, Onset::once(began_s));
    let (always, as_large_m_s) = found(&Inquiry::new(Machine::xt28(), runs(|_| true)));
    assert_eq!(always, Onset::ALWAYS);
    assert!((size_m_s / as_large_m_s - 1.0).abs() < 0.1, "{size_m_s} {as_large_m_s}");
}

#[test]
fn the_run_in_which_it_broke_is_told() {
    let mut broken = Inquiry::new(Machine::xt28(), runs(|k| k >= 2));
    broken.how_far = false;
    let diagnosis = broken.diagnose(&|_| ());
    assert_eq!(diagnosis.verdict, Verdict::Effect, "{:?}", diagnosis.notes);
    let cause = &diagnosis.causes[0];
    assert_eq!((cause.effect.name, cause.scope.to_string().as_str()), ("leakage-drift", "left"));
    let begins = cause.begins.as_ref().expect("it was not there before");
    assert_eq!(begins.run, broken.runs[2].file());
    assert!(begins.at_s < 1.0 && begins.onset.is_once(), "{begins:?}");
    let text = page::text(&diagnosis);
    assert!(text.contains(&format!("{}, for good", begins.run)), "{text}");
}
