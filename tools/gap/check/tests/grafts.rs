//! Faults of reading laid over a folder of logs, from the files to the score.

use std::fs;
use std::path::Path;

use xt28_gap_check::{Examination, Options, Report, Source, Truth};
use xt28_gap_plants::{Case, Kind, Manoeuvre};

/// A set of one sound machine, whose only drive is short.
fn set(folder: &Path) {
    let case = Case::draw(4, Kind::Null).only(Manoeuvre::ArmStep, 6.0);
    let own = folder.join("one");
    fs::create_dir_all(folder.join("answers")).unwrap();
    fs::create_dir(&own).unwrap();
    for (name, bytes) in case.logs().unwrap() {
        fs::write(own.join(name), bytes).unwrap();
    }
    fs::write(own.join("xt28-field.dbc"), Case::dbc()).unwrap();
    fs::write(own.join("about.toml"), case.about()).unwrap();
    fs::write(folder.join("answers/one.toml"), case.answer().text()).unwrap();
}

#[test]
fn what_is_laid_over_a_log_is_what_the_diagnosis_reads_and_what_the_seal_holds() {
    let folder = tempfile::tempdir().unwrap();
    set(folder.path());
    let sound = Source::in_folder(folder.path()).unwrap()[0].inquiry().unwrap();
    let sources = Source::grafted(folder.path(), 12, 5).unwrap();
    let (mut pressures, mut attitudes) = (0, 0);
    for source in &sources {
        let text = source.answer_text().unwrap();
        let truth = Truth::parse(&text, &source.answer_path()).unwrap();
        let seen = &source.inquiry().unwrap().runs[0].signals;
        let was = &sound.runs[0].signals;
        assert_eq!(seen.len, was.len);
        let fact = &truth.facts[0];
        match fact.name.as_str() {
            "pressure-bias" | "pressure-scale" => {
                pressures += 1;
                for wheel in xt28_machine::Wheel::ALL {
                    let [at, before] = [seen, was].map(|s| &s.cylinder_load_n[wheel]);
                    assert_eq!(at != before, fact.scope.contains(wheel), "{fact} at {wheel:?}");
                }
            }
            "imu-offset" => {
                attitudes += 1;
                let (_, roll_rad) =
                    fact.parameters.iter().find(|(p, _)| p.name == "roll_rad").unwrap();
                assert!((seen.roll_rad[9] - was.roll_rad[9] - roll_rad).abs() < 1e-9, "{fact}");
            }
            _ => {}
        }
    }
    assert!(pressures > 0 && attitudes > 0, "this seed draws both");
}

#[test]
fn grafts_are_examined_as_any_other_cases() {
    let folder = tempfile::tempdir().unwrap();
    set(folder.path());
    let examination =
        Examination::sealed(Source::grafted(folder.path(), 2, 5).unwrap(), 5).unwrap();
    let options = Options { how_far: false, baselines: false };
    let (examined, refused) = examination.examine(options, &|| 0.0, &|_| ());
    assert_eq!(refused, []);
    let report = Report::new(&examination, examination.open(examined).unwrap());
    assert!(report.score("top-1").is_some());
    assert_eq!(report.json()["cases"][0]["case"], "one-graft-1");
}
