//! What there is to say of logs, and of what was said of them, beside any answer.

use std::path::Path;

use xt28_gap::{About, Channel, Decoder, FieldLog, RunSet, Series};
use xt28_machine::Wheel;

use crate::Failure;

/// Which files a command was given, and what speaks of its logs.
pub(super) struct Given<'a> {
    pub(super) decoder: &'a Decoder,
    pub(super) about: Option<&'a Path>,
    pub(super) dbc: &'a Path,
    pub(super) machine: Option<&'a Path>,
}

/// What was taken for granted, what is wrong with the logs, what is missing; whole sentences.
pub(super) fn remarks(set: &RunSet, given: &Given<'_>) -> Result<Vec<String>, Failure> {
    let mut all = set.notes();
    if let Some(path) = given.about {
        let about = About::load(path)?;
        // One that speaks of other logs says nothing of these.
        if set.runs().iter().any(|run| run.advised.is_some()) {
            all.extend(unread(&about, path, given));
        }
    }
    let logs: Vec<(&str, &FieldLog)> =
        set.runs().iter().map(|run| (run.file.as_str(), &run.log)).collect();
    all.extend(without_pressures(&logs));
    all.extend(other_steps(given.decoder));
    Ok(all)
}

/// What `about` names and nobody reads, as the command line alone says what is read.
fn unread(about: &About, path: &Path, given: &Given<'_>) -> Vec<String> {
    let file = path.file_name().unwrap_or_default().to_string_lossy();
    let is = |named: &str, read: Option<&Path>| {
        let Some(read) = read else { return false };
        match path.with_file_name(named).canonicalize() {
            Ok(named) => read.canonicalize().is_ok_and(|read| read == named),
            // It lies elsewhere, so its name is all there is to go by.
            Err(_) => Path::new(named).file_name() == read.file_name(),
        }
    };
    let dbc = about.dbc.as_deref().filter(|dbc| !is(dbc, Some(given.dbc))).map(|dbc| {
        let read = given.dbc.display();
        format!("{file} says that the logs were sent with {dbc}; read was {read}, as --dbc says.")
    });
    let nominal = about.nominal.as_deref().filter(|nominal| !is(nominal, given.machine));
    let nominal = nominal.map(|nominal| {
        let read = given.machine.map_or_else(
            || "the built-in machine; --machine FILE takes another".to_owned(),
            |read| format!("{}, as --machine says", read.display()),
        );
        format!("{file} names {nominal} as the machine, which is not read; taken was {read}.")
    });
    dbc.into_iter().chain(nominal).collect()
}

/// Strokes that do not come as the Xt28's ECU sends them, cut off to whole millimetres.
fn other_steps(decoder: &Decoder) -> Option<String> {
    const STEP_MM: f64 = 1.0;
    let steps_mm = Wheel::ALL.into_iter().filter_map(|w| decoder.step_of(Channel::Stroke(w)));
    let mut steps_mm = steps_mm.map(|step_m| step_m * 1e3);
    let step_mm = steps_mm.find(|step_mm| (step_mm - STEP_MM).abs() > 1e-6)?;
    Some(format!(
        "{} tells strokes in steps of {step_mm} mm. They are taken for ones that were cut off to whole millimetres, as \
         the Xt28's ECU sends them, so that every arm may seem off by up to half a millimetre.",
        decoder.message_of(Channel::Stroke(Wheel::Fr)).unwrap_or("The DBC")
    ))
}

/// Logs that lack pressures of cylinders, all in one sentence.
fn without_pressures(logs: &[(&str, &FieldLog)]) -> Option<String> {
    let lacks = |log: &FieldLog| {
        let mut chambers = Wheel::ALL
            .into_iter()
            .flat_map(|wheel| [Channel::BorePressure(wheel), Channel::RodPressure(wheel)]);
        chambers.any(|channel| log.series(channel).is_none_or(Series::is_empty))
    };
    let lacking: Vec<&str> =
        logs.iter().filter(|(_, log)| lacks(log)).map(|(file, _)| *file).collect();
    (!lacking.is_empty()).then(|| {
        format!(
            "Without pressures of all cylinders' chambers, arms are judged by the loads that the ECU \
             derives, which come more slowly and say less: {}.",
            lacking.join(", ")
        )
    })
}

#[cfg(test)]
mod tests {
    use xt28_gap::Mapping;

    use super::*;

    const ABOUT: &str = "case = \"a\"\ndbc = \"a.dbc\"\nnominal = \"a.toml\"\nrun = []\n";

    const DBC: &str = include_str!("../../../../dbc/xt28.dbc");

    fn decoder(dbc: &str) -> Decoder {
        Decoder::parse(dbc, Path::new("own.dbc"), &Mapping::default()).unwrap()
    }

    #[test]
    fn strokes_in_other_steps_than_millimetres_are_told() {
        assert_eq!(other_steps(&decoder(DBC)), None);
        let whole = "SG_ FR : 0|16@1+ (1,0) [0|65535] \"mm\"";
        assert!(DBC.contains(whole));
        let told = other_steps(&decoder(&DBC.replace(whole, &whole.replace("(1,0)", "(0.1,0)"))));
        assert!(
            told.is_some_and(|told| told.starts_with("PosFront tells strokes in steps of 0.1 mm"))
        );
    }

    #[test]
    fn what_about_toml_names_and_nobody_reads_is_told() {
        let folder = tempfile::tempdir().unwrap();
        let [path, dbc, machine, other] =
            ["about.toml", "a.dbc", "a.toml", "b.toml"].map(|name| folder.path().join(name));
        for file in [&dbc, &machine, &other] {
            std::fs::write(file, "").unwrap();
        }
        let about = About::parse(ABOUT, &path).unwrap();
        let decoder = decoder(DBC);
        let of = |dbc: &Path, machine: Option<&Path>| {
            unread(&about, &path, &Given { decoder: &decoder, about: Some(&path), dbc, machine })
        };
        assert!(of(&dbc, Some(&machine)).is_empty());
        let [nominal] = &of(&dbc, None)[..] else { panic!("the machine is another") };
        assert!(
            nominal.contains("a.toml") && nominal.contains("the built-in machine"),
            "{nominal}"
        );
        let [read, named] = &of(&other, Some(&other))[..] else { panic!("both are others") };
        assert!(read.contains("sent with a.dbc") && named.contains("as --machine says"), "{read}");
    }
}
