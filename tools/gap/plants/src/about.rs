//! `about.toml`: what one may know of a case.

use serde::Serialize;
use xt28_sim::Ramp;

use crate::manoeuvre::{Manoeuvre, Script};

/// File name of the database that the logs were sent with.
pub(crate) const DBC_FILE: &str = "xt28-field.dbc";

#[derive(Serialize)]
struct About<'a> {
    case: &'a str,
    machine: &'a str,
    dbc: &'a str,
    run: Vec<Run<'a>>,
}

#[derive(Serialize)]
struct Run<'a> {
    file: String,
    scenario: &'a str,
    seconds: f64,
    terrain: &'a str,
    fit: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    ramp: Option<RampLines>,
}

#[derive(Serialize)]
struct RampLines {
    x_m: [f64; 4],
    height_m: f64,
    y_min_m: f64,
    y_max_m: f64,
}

/// File name of a run's log, `number` counting from 1.
pub(crate) fn log_name(number: usize, manoeuvre: Manoeuvre) -> String {
    format!("run-{number}-{}.log.gz", manoeuvre.name())
}

/// The file's text.
///
/// # Panics
/// Never: numbers, texts and tables always serialise.
pub(crate) fn text(case: &str, runs: &[(Manoeuvre, Script)]) -> String {
    let lines = |ramp: &Ramp| RampLines {
        x_m: ramp.x_m,
        height_m: ramp.height_m,
        y_min_m: ramp.y_min_m,
        y_max_m: ramp.y_max_m,
    };
    let run = runs.iter().enumerate().map(|(i, (manoeuvre, script))| Run {
        file: log_name(i + 1, *manoeuvre),
        scenario: manoeuvre.name(),
        seconds: script.seconds,
        terrain: if script.ramp.is_some() { "ramp" } else { "flat" },
        fit: manoeuvre.is_for_fitting(),
        ramp: script.ramp.as_ref().map(lines),
    });
    let about =
        About { case, machine: "Xt28, bunk declared empty", dbc: DBC_FILE, run: run.collect() };
    toml::to_string(&about).expect("a description is plain data")
}
