//! Distances between one of our engines and MuJoCo over ten seconds, manoeuvre by manoeuvre.

use std::fs;

use super::SecondEngine;
use super::engine::Engine;
use super::programs::{Job, Programs};
use super::trajectory::KINDS;
use crate::workspace::Outcome;

/// Steps per second of a recording: fine enough that the step does not show.
const RECORDED_HZ: u32 = 2000;
/// MuJoCo lets a wheel creep under a side load in proportion to it. This makes the creep a thousand
/// times slower, so that what is left is dry friction, as ours is.
const STIFF_FRICTION: &str = "--impratio=1000";

/// Prints one engine's tables: against MuJoCo as it comes, and with friction that hardly creeps;
/// or, where arguments for MuJoCo are given, against that.
///
/// # Errors
/// When a side cannot be run.
pub(crate) fn print(programs: &Programs, ours: Engine, asked: &SecondEngine) -> Outcome<()> {
    if asked.mujoco.is_empty() {
        table(programs, ours, asked, &[])?;
        table(programs, ours, asked, &[STIFF_FRICTION.to_owned()])
    } else {
        table(programs, ours, asked, &asked.mujoco)
    }
}

/// A row each manoeuvre, largest distance and RMSE each kind of signal.
fn table(
    programs: &Programs,
    ours: Engine,
    asked: &SecondEngine,
    mujoco: &[String],
) -> Outcome<()> {
    let rate_hz = asked.rate;
    println!("\n{} against {} at {rate_hz} Hz, max / RMSE\n", ours.name(), mujoco_name(mujoco));
    let names: Vec<&str> = KINDS.iter().map(|kind| kind.name).collect();
    println!("| manoeuvre | {} |", names.join(" | "));
    println!("|---|{}", "---|".repeat(KINDS.len()));
    for (manoeuvre, terrain) in manoeuvres(programs)? {
        if asked.manoeuvre.as_ref().is_some_and(|only| *only != manoeuvre) {
            continue;
        }
        let job = Job { manoeuvre: &manoeuvre, terrain: &terrain, rate_hz, mujoco };
        let a = programs.run(ours, &job)?.trajectory;
        let b = programs.run(Engine::MujocoElliptic, &job)?.trajectory;
        let mut row = format!("| {manoeuvre} |");
        for kind in &KINDS {
            let d = a.distance(&b, kind)?;
            row.push_str(&format!(" {} / {} |", figure(d.max), figure(d.rmse)));
        }
        println!("{row}");
    }
    Ok(())
}

/// Writes MuJoCo's trajectories for the plant's tests.
///
/// # Errors
/// When MuJoCo cannot be run or a file not be written.
pub(crate) fn record(programs: &Programs) -> Outcome<()> {
    for (manoeuvre, terrain) in manoeuvres(programs)? {
        let (rate_hz, mujoco) = (RECORDED_HZ, &[STIFF_FRICTION.to_owned()]);
        let job = Job { manoeuvre: &manoeuvre, terrain: &terrain, rate_hz, mujoco };
        let path = programs.recorded(&manoeuvre);
        fs::write(&path, programs.run(Engine::MujocoElliptic, &job)?.text)?;
        println!("{}", path.display());
    }
    Ok(())
}

/// Names of the manoeuvres and of their terrains, in the file's order.
fn manoeuvres(programs: &Programs) -> Outcome<Vec<(String, String)>> {
    let path = programs.manoeuvres();
    let text = fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))?;
    let file: toml::Table = toml::from_str(&text)?;
    let terrain = |value: &toml::Value| Some(value.get("terrain")?.as_str()?.to_owned());
    let found = file.iter().filter_map(|(name, value)| Some((name.clone(), terrain(value)?)));
    let mut found: Vec<(String, String)> = found.collect();
    found.sort_by_key(|(name, _)| text.find(&format!("[{name}]")));
    Ok(found)
}

fn mujoco_name(arguments: &[String]) -> String {
    let mut name = Engine::MujocoElliptic.name().to_owned();
    for argument in arguments {
        name.push(' ');
        name.push_str(argument);
    }
    name
}

/// Two digits that mean something.
fn figure(value: f64) -> String {
    match value {
        v if v >= 10.0 => format!("{v:.0}"),
        v if v >= 1.0 => format!("{v:.1}"),
        v if v >= 0.1 => format!("{v:.2}"),
        v if v >= 5e-4 => format!("{v:.3}"),
        _ => "0".to_owned(),
    }
}
