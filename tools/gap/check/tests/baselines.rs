//! The plain rules on machines for which they were made: they are no straw men.

use xt28_gap::diagnosis::Verdict;
use xt28_gap_check::{BASELINES, Reply, Source};
use xt28_gap_plants::{Case, Cause, Manoeuvre, Scope};

/// What the rule of this name says of the first seconds of one run.
fn reply(name: &str, case: &Case, manoeuvre: Manoeuvre, seconds: f64) -> Reply {
    let source = Source::Drawn(Box::new(case.only(manoeuvre, seconds)));
    let inquiry = source.inquiry().unwrap();
    let rule = BASELINES.iter().find(|rule| rule.name == name).expect("there is this rule");
    rule.reply(&inquiry)
}

fn strong(cause: &str) -> Case {
    Case::of(5, Cause::find(cause).unwrap(), Scope::All).at_its_strongest()
}

/// What was said, short.
fn names(reply: &Reply) -> String {
    let causes = reply.causes.iter().take(4);
    let names: Vec<_> = causes.map(|c| format!("{} {}", c.effect.name, c.scope)).collect();
    format!("{:?}: {}", reply.verdict, names.join(", "))
}

#[test]
fn the_latest_block_is_named_and_a_sound_machine_is_not_late() {
    for (cause, manoeuvre) in [
        ("arm-delay", Manoeuvre::ArmStep),
        ("throttle-delay", Manoeuvre::Straight),
        ("steer-delay", Manoeuvre::STurn),
    ] {
        let said = reply("max lag", &strong(cause), manoeuvre, 14.0);
        assert_eq!(said.causes[0].effect.name, cause, "{}", names(&said));
        assert!(said.verdict == Verdict::Effect && said.causes[0].stands);
        // It may find a gain a little off, but nothing late.
        let sound = reply("max lag", &strong(cause).without_faults(), manoeuvre, 14.0);
        let late = sound.causes[0].stands && sound.causes[0].effect.name.ends_with("-delay");
        assert!(!late, "{manoeuvre:?}: {}", names(&sound));
    }
}

#[test]
fn a_rule_names_what_it_was_made_for() {
    for (rule, cause) in
        [("largest shift", "arm-gain"), ("one-step BIC", "arm-delay"), ("one-step BIC", "arm-gain")]
    {
        let said = reply(rule, &strong(cause), Manoeuvre::ArmStep, 8.0);
        // One step ahead and without allowances, a tyre that creeps may count for more than any cause, on all wheels
        // and on some.
        let mut effects: Vec<_> = said.causes.iter().map(|named| named.effect.name).collect();
        effects.dedup();
        let named = effects.iter().take(2).any(|effect| *effect == cause);
        assert!(named, "{rule}: {}", names(&said));
    }
}
