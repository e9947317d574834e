//! What `about.toml` says of a log and the log itself denies: then one of the two may be another's, and its ground
//! as well.

use std::path::Path;

use crate::about::{About, Run};
use crate::diagnosis::{Manoeuvre, scripted_drive};
use crate::{Channel, FieldLog, Series};

/// A length is told in whole seconds, and loggers start and stop by hand: by how much it may be off, s ...
const OFF_S: f64 = 2.0;
/// ... and as a share of the log.
const OFF_SHARE: f64 = 0.1;
/// Share of what a scripted drive moves a target by that is too little to be that drive.
const MOVED_SHARE: f64 = 0.1;
/// A drive over what only some have built: it has no script.
const RAMP: &str = "ramp";

/// One sentence for each claim of `run` in `about`, which was read from `file`, that the whole `log` denies.
pub(super) fn denied(about: &About, file: &Path, run: &Run, log: &FieldLog) -> Vec<String> {
    let at = |key: &str| format!("{}:{}", file.display(), about.line_of(run, key));
    let (name, long_s) = (log.name(), log.duration_s());
    let near_s = 0.0..=OFF_S.max(OFF_SHARE * long_s);
    let off = |said_s: &f64| !near_s.contains(&(said_s - long_s).abs());
    let seconds = run.seconds.filter(off).map(|said_s| {
        format!(
            "{}: seconds = {said_s}, but {name} is {long_s:.1} s long; the log counts, so see whether the two \
             belong together.",
            at("seconds")
        )
    });
    let scenario = run.scenario.as_deref().and_then(|said| {
        let said_at = format!("{}: scenario = \"{said}\"", at("scenario"));
        if let Some(drives) = others(said) {
            return Some(format!(
                "{said_at} is none of {drives}, so {name} is not held against it, and it stands for no drive."
            ));
        }
        let target = not_moved(said, log)?;
        Some(format!(
            "{said_at}, but {name} never moves the target of the {target} as that drive does; a drive that is said \
             to be made is not asked for."
        ))
    });
    seconds.into_iter().chain(scenario).collect()
}

/// All drives that are known by name, where `scenario` is the name of none.
fn others(scenario: &str) -> Option<String> {
    if scripted_drive(scenario).is_some() || scenario.eq_ignore_ascii_case(RAMP) {
        return None;
    }
    let names = Manoeuvre::all().into_iter().map(|drive| drive.name);
    Some(names.chain([RAMP]).collect::<Vec<_>>().join(", "))
}

/// What a drive may move, by its name and its channels.
type Target = (&'static str, fn(&Channel) -> bool);

/// A target that the scripted drive of this name moves and `log` does not; nothing for a name that is of none.
fn not_moved(scenario: &str, log: &FieldLog) -> Option<&'static str> {
    use Channel::{TargetJoint, TargetOpening, TargetStroke, Throttle};
    let drive = scripted_drive(scenario)?;
    let most = |log: &FieldLog, is: fn(&Channel) -> bool| {
        let each = log.all_series().iter().filter(|(channel, _)| is(channel));
        each.map(|(_, series)| moved(series)).fold(0.0, f64::max)
    };
    let targets: [Target; 3] = [
        ("arms", |channel| matches!(channel, TargetStroke(_))),
        ("throttle", |channel| matches!(channel, Throttle)),
        ("front joint", |channel| matches!(channel, TargetJoint)),
    ];
    let by_valve = most(log, |channel| matches!(channel, TargetOpening(_))) > 0.0;
    let missing = targets.into_iter().find(|(target, is)| {
        let wanted = most(&drive, *is);
        let is_by_valve = *target == "arms" && by_valve;
        wanted > 0.0 && !is_by_valve && most(log, *is) < MOVED_SHARE * wanted
    });
    missing.map(|(target, _)| target)
}

/// By how much a channel goes up and down.
fn moved(series: &Series) -> f64 {
    let all = series.iter().map(|(_, value)| value);
    let [low, high] =
        all.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| [low.min(v), high.max(v)]);
    (high - low).max(0.0)
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;

    /// What is denied of a log of 32 s that commands the throttle alone.
    fn said(claims: &str) -> Vec<String> {
        let text =
            format!("case = \"a\"\n[[run]]\nfile = \"a.log\"\nterrain = \"flat\"\n{claims}\n");
        let path = Path::new("about.toml");
        let about = About::parse(&text, path).unwrap();
        let series = [(0.0, 0.0), (5.0, 0.6), (20.0, 0.0)].into_iter().collect();
        let log = FieldLog::of_series("a.log", BTreeMap::from([(Channel::Throttle, series)]), 32.0);
        denied(&about, path, &about.run[0], &log)
    }

    #[test]
    fn another_length_is_told_with_both_numbers_and_a_rounded_one_is_not() {
        for seconds in ["30", "32.0", "33.9", "35.0"] {
            assert!(said(&format!("seconds = {seconds}")).is_empty(), "{seconds}");
        }
        for seconds in ["300.0", "8.5", "nan"] {
            let [told] = &said(&format!("seconds = {seconds}"))[..] else { panic!("{seconds}") };
            assert!(told.starts_with("about.toml:5: seconds = "), "{told}");
            assert!(told.contains("a.log is 32.0 s long"), "{told}");
        }
    }

    #[test]
    fn a_scripted_drive_that_was_not_driven_is_told_and_so_is_a_name_that_is_no_drives() {
        for scenario in ["straight", "ramp"] {
            assert!(said(&format!("scenario = \"{scenario}\"")).is_empty(), "{scenario}");
        }
        for (scenario, target) in
            [("s_turn", "front joint"), ("arm_step", "arms"), ("mixed", "arms")]
        {
            let [told] = &said(&format!("scenario = \"{scenario}\""))[..] else {
                panic!("{scenario}")
            };
            assert!(told.starts_with("about.toml:5: scenario = "), "{told}");
            assert!(told.contains(&format!("never moves the target of the {target}")), "{told}");
        }
        let [told] = &said("scenario = \"hauling logs\"")[..] else {
            panic!("a name of one's own")
        };
        let none = "about.toml:5: scenario = \"hauling logs\" is none of arm-step, single-arm, ";
        assert!(told.starts_with(none), "{told}");
    }
}
