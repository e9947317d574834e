//! Every test drive that a diagnosis may propose is a scenario that runs and holds.

mod short_drive;

use short_drive::{path, xt28};
use xt28_gap::diagnosis::Manoeuvre;

#[test]
fn every_manoeuvre_runs_as_a_scenario_and_leaves_the_machine_on_its_wheels() {
    let folder = tempfile::tempdir().unwrap();
    let runs = Manoeuvre::all().into_iter().map(|manoeuvre| {
        let scenario = path(folder.path(), &format!("{}.toml", manoeuvre.name));
        let script = format!("{}.script.toml", manoeuvre.name);
        std::fs::write(path(folder.path(), &script), manoeuvre.script()).unwrap();
        std::fs::write(&scenario, manoeuvre.scenario(&script, "a, b")).unwrap();
        std::thread::spawn(move || {
            (manoeuvre.name, xt28(&["run", &scenario, "--solver", "reduced"]))
        })
    });
    for run in runs.collect::<Vec<_>>() {
        let (name, output) = run.join().unwrap();
        let talk = String::from_utf8_lossy(&output.stderr);
        let table = String::from_utf8_lossy(&output.stdout);
        assert_eq!(output.status.code(), Some(0), "{name}: {talk}{table}");
    }
}
