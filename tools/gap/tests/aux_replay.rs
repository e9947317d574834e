//! The nominal machine, simulated in another engine, against ours: how far two independent models
//! of the same machine lie apart.
//!
//! The logs are not part of the project. Where they are not beside the workspace, these tests say
//! so on standard error and pass.
#![allow(clippy::disallowed_macros)] // a test that is skipped must be seen to be skipped

use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

use xt28_gap::{About, Decoder, FieldLog, Mapping, Replay, Report};
use xt28_machine::Machine;
use xt28_sim::{Effects, Solver};

/// The folder of the logs, `None` (and said so) where it is not there.
fn logs() -> Option<PathBuf> {
    let folder =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/field-data/aux/nominal");
    if folder.is_dir() {
        return Some(folder);
    }
    let _ = writeln!(io::stdout(), "SKIPPED: no field logs at {}", folder.display());
    None
}

fn read(folder: &Path, file: &str) -> FieldLog {
    let decoder = Decoder::load(&folder.join("xt28-field.dbc"), &Mapping::default()).unwrap();
    FieldLog::load(&folder.join(file), &decoder, false).unwrap()
}

/// The replay of a log on both solvers.
fn replay(file: &str) -> Option<[Report; 2]> {
    Some([on(Solver::Rapier, file)?, on(Solver::Reduced, file)?])
}

fn on(solver: Solver, file: &str) -> Option<Report> {
    let folder = logs()?;
    let log = read(&folder, file);
    let terrain = About::terrain_of(&folder.join("about.toml"), Path::new(file)).unwrap();
    let replay =
        Replay::run(&log, &Machine::xt28(), &Effects::default(), solver, &terrain).unwrap();
    let report = replay.report(&log, &folder.join("xt28-field.dbc"));
    eprintln!("{}", report.table());
    assert_eq!(report.notes, Vec::<String>::new());
    Some(report)
}

/// What our machine keeps to on these logs, tighter than the bounds of a replay of any log: the
/// largest RMSE by the start of a signal's name, in its unit of the table.
const KEPT: &[(&str, f64)] = &[
    ("stroke.", 1.0),
    ("joint.", 0.35),
    ("wheel_speed.", 0.015),
    ("attitude.", 0.25),
    ("wheel_load.sum", 0.5),
];

/// Signals of `report` that are further off than what is kept to.
fn off(report: &Report) -> Vec<(&str, f64)> {
    let kept = |name: &str| KEPT.iter().find(|(start, _)| name.starts_with(start)).map(|k| k.1);
    let judged = report.rows.iter().filter(|row| row.passed.is_some());
    judged
        .filter(|row| {
            row.passed == Some(false) || row.errors.rmse > kept(&row.signal).unwrap_or(0.0)
        })
        .map(|row| (row.signal.as_str(), row.errors.rmse))
        .collect()
}

#[test]
fn every_log_is_whole_and_says_all_that_is_needed() {
    let Some(folder) = logs() else { return };
    let about = About::load(&folder.join("about.toml")).unwrap();
    assert_eq!(about.run.len(), 5);
    for run in &about.run {
        let log = read(&folder, &run.file);
        assert_eq!(log.faults(), [], "{}", run.file);
        let seconds = run.seconds.unwrap();
        assert!((log.duration_s() - seconds).abs() < 0.05, "{}: {}", run.file, log.duration_s());
    }
}

#[test]
fn arm_steps_are_in_bounds() {
    let Some(reports) = replay("run-1-arm_step.log.gz") else { return };
    for report in reports {
        assert_eq!(off(&report), []);
    }
}

#[test]
fn a_multisine_on_all_arms_is_in_bounds() {
    let Some(reports) = replay("run-2-multisine.log.gz") else { return };
    for report in reports {
        assert_eq!(off(&report), []);
    }
}

#[test]
fn an_s_turn_is_in_bounds() {
    let Some(reports) = replay("run-3-s_turn.log.gz") else { return };
    for report in reports {
        assert_eq!(off(&report), []);
    }
}

#[test]
fn driving_straight_is_in_bounds() {
    let Some(reports) = replay("run-4-straight.log.gz") else { return };
    for report in reports {
        assert_eq!(off(&report), []);
    }
}

/// Wheels that hardly carry are not: the rear one slips sooner in the log than in ours when the
/// machine brakes. `docs/second-opinion.md` has the figures.
#[test]
fn a_ramp_is_in_bounds_but_for_light_wheels() {
    let Some(reports) = replay("run-5-ramp.log.gz") else { return };
    for report in reports {
        for (signal, rmse) in off(&report) {
            let most = if signal == "wheel_speed.BR" { 0.035 } else { 0.02 };
            assert!(signal.starts_with("wheel_speed.") && rmse < most, "{signal}: {rmse}");
        }
    }
}
