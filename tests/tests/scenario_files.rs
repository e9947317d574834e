//! `docs/scenario-files.md` held to the code: its examples run, and it leaves nothing out that a file can say.

use std::fs;
use std::path::Path;

use xt28_scenarios::{Lockstep, Scenario, Setup};
use xt28_sim::Solver;

const PAGE: &str = include_str!("../../docs/scenario-files.md");

/// The page's TOML texts, in their order.
fn examples() -> Vec<&'static str> {
    let texts = PAGE.split("```toml\n").skip(1);
    texts.map(|rest| rest.split("```").next().unwrap()).collect()
}

#[test]
fn the_examples_of_the_page_run_and_pass() {
    let [sill, steps, script] = examples()[..] else { panic!("three examples") };
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    fs::write(at("sill.toml"), sill).unwrap();
    fs::write(at("steps.toml"), steps).unwrap();
    fs::write(at("steps.script.toml"), script).unwrap();
    for name in ["sill.toml", "steps.toml"] {
        let mut setup = Setup::new(Scenario::load(&at(name)).unwrap(), None).unwrap();
        setup.solver = Solver::Reduced;
        let mut run = Lockstep::new(&setup, std::io::sink()).unwrap();
        while run.tick(&mut || core::time::Duration::ZERO).unwrap().is_some() {}
        let report = run.finish().unwrap().report(&setup, "virtual");
        assert!(report.passed(), "{}", report.table());
    }
}

/// Names that a refusal lists after "expected": what the code knows.
fn known(text: &str) -> Vec<String> {
    let nothing = |_: &Path| Err(std::io::ErrorKind::NotFound.into());
    let head = "title = \"t\"\npolicy = \"hold\"\nduration_s = 9\n";
    let refused = Scenario::parse(&format!("{head}{text}"), Path::new("t.toml"), nothing);
    let refused = refused.unwrap_err().to_string();
    let (_, list) = refused.split_once("expected").unwrap_or_else(|| panic!("{refused}"));
    list.split('`').skip(1).step_by(2).map(str::to_owned).collect()
}

#[test]
fn the_page_has_every_name_that_a_file_may() {
    let places = [
        ("", 13),
        ("[[expect]]\nno-such = 1\n", 20),
        ("[[event]]\nat_s = 1\nno_such = 1\n", 6),
        ("[[fault]]\nno_such = 1\n", 5),
        ("[[fault]]\nsensor = \"no-such\"\n", 11),
        ("[terrain.no-such]\n", 10),
    ];
    for (text, least) in places {
        let text = if text.is_empty() { "no_such = 1\n" } else { text };
        let names = known(text);
        assert!(names.len() >= least, "{text}: {names:?}");
        for name in names {
            // As a key, in a list of keys, or as a value.
            let told = [format!("`{name}`"), format!("[[{name}]]"), format!("`{name} = ")];
            assert!(told.iter().any(|told| PAGE.contains(told)), "{name} of {text}");
        }
    }
}
